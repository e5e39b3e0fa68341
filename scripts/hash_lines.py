#!/usr/bin/env python3
"""Prints a hash of all lines in a bag: stamps, ids, ages, endpoints, sigmas and residuals, bit by bit.

The hash does not depend on fields that were added to the messages later.
"""
import hashlib
import struct
import sys

import rosbag


def main():
    digest = hashlib.sha256()
    with rosbag.Bag(sys.argv[1]) as bag:
        for _, message, _ in bag.read_messages(topics=['/line_tracker/lines']):
            digest.update(struct.pack('<QIQI', message.header.stamp.to_nsec(), message.epoch, message.image_count,
                                      len(message.lines)))
            for line in message.lines:
                digest.update(struct.pack('<QI4f4d2f', line.id, line.age, *line.start_px, *line.end_px,
                                          *line.start_normalized, *line.end_normalized, line.sigma_px, line.residual))
    print(digest.hexdigest()[:16])


if __name__ == '__main__':
    main()
