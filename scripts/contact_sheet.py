#!/usr/bin/env python3
"""Contact sheet of bags: one row per bag, images spread evenly over time, the file's name above each row."""

import argparse
import os
import sys

import cv2
import numpy as np
import rosbag


def images_of(path, topic, count, first, step):
    """`count` gray images: evenly spread, or every `step`-th from image number `first`."""
    with rosbag.Bag(path) as bag:
        total = bag.get_message_count(topic)
        if total == 0:
            raise RuntimeError('%s holds no %s' % (path, topic))
        if step:
            wanted = {first + i * step for i in range(count)}
        else:
            wanted = {int(n) for n in np.linspace(0, total - 1, count)}
        images = []
        for number, (_, message, _) in enumerate(bag.read_messages(topics=[topic])):
            if number in wanted:
                rows = np.frombuffer(message.data, np.uint8).reshape(message.height, message.step)
                images.append(rows[:, :message.width])
        return images


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('out', help='PNG or JPEG to write')
    parser.add_argument('bags', nargs='+')
    parser.add_argument('--topic', default='/cam0/image_raw', help='mono8 images')
    parser.add_argument('--count', type=int, default=5, help='images per row')
    parser.add_argument('--width', type=int, default=240, help='of one picture [px]')
    parser.add_argument('--first', type=int, default=0, help='number of the first image, with --step')
    parser.add_argument('--step', type=int, default=0, help='images from one to the next; 0: spread evenly')
    arguments = parser.parse_args()

    rows = []
    for path in arguments.bags:
        pictures = []
        for image in images_of(path, arguments.topic, arguments.count, arguments.first, arguments.step):
            height = round(image.shape[0] * arguments.width / image.shape[1])
            pictures.append(cv2.resize(image, (arguments.width, height), interpolation=cv2.INTER_AREA))
        pictures += [np.zeros_like(pictures[0])] * (arguments.count - len(pictures))
        row = np.hstack(pictures)
        caption = np.full((16, row.shape[1]), 255, np.uint8)
        name = os.path.splitext(os.path.basename(path))[0].replace('_', ' ')
        cv2.putText(caption, name, (4, 12), cv2.FONT_HERSHEY_SIMPLEX, 0.42, 0, 1, cv2.LINE_AA)
        rows += [caption, row]
    width = max(row.shape[1] for row in rows)
    rows = [np.pad(row, ((0, 0), (0, width - row.shape[1])), constant_values=255) for row in rows]
    if not cv2.imwrite(arguments.out, np.vstack(rows)):
        raise RuntimeError('cannot write ' + arguments.out)


if __name__ == '__main__':
    try:
        main()
    except (OSError, RuntimeError, rosbag.ROSBagException) as error:
        sys.exit('contact_sheet: %s' % error)
