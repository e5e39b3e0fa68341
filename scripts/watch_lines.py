#!/usr/bin/env python3
"""Watches the lines that come to an estimator's host while the network of the tracker is cut; called by test_hosts.sh.

    watch_lines.py CUT

CUT: a file that is made when the cut has ended. At SIGINT says what came, and fails when images were lost before the cut, when no
lines came again after it, or when an id broke its promise.
"""
import os
import sys
import threading
import time

import rospy
from sensor_msgs.msg import PointCloud

from play_compressed import RATE_HZ
from watch_node import IdRules, parse

GAP_S = 2.0  # without lines: the cut


class Watch:
    def __init__(self, cut):
        self.cut = cut
        self.lock = threading.Lock()
        self.rules = IdRules()
        self.faults = []
        self.arrivals = []  # time of time.monotonic()
        self.first_image = None
        self.pairs = 0

    def take(self, message):
        with self.lock:
            self.arrivals.append(time.monotonic())
            if self.first_image is None:
                self.first_image = parse(message._buff)[1]
            try:
                self.rules.add(message._buff)
            except ValueError as fault:
                self.faults.append(str(fault))

    def take_pair(self, _):
        self.pairs += 1


def main():
    watch = Watch(sys.argv[1])
    rospy.init_node('watch_lines')
    rospy.Subscriber('/line_tracker/lines', rospy.AnyMsg, watch.take, queue_size=1000, tcp_nodelay=True)
    rospy.Subscriber('/linefeature_tracker/linefeature', PointCloud, watch.take_pair, queue_size=1000, tcp_nodelay=True)
    rospy.spin()
    with watch.lock:
        if watch.faults:
            sys.exit(watch.faults[0])
        gaps = [(b - a, i + 1) for i, (a, b) in enumerate(zip(watch.arrivals, watch.arrivals[1:])) if b - a > GAP_S]
        if not watch.arrivals or watch.first_image != 1:
            sys.exit('the first images had no lines')
        if len(gaps) != 1:
            sys.exit('{} times no lines for over {:.0f} s in {} messages, expected the cut alone'.format(
                len(gaps), GAP_S, len(watch.arrivals)))
        if not os.path.exists(watch.cut):
            sys.exit('lines came through the cut')
        gap, before = gaps[0]
        sent = (watch.arrivals[before - 1] - watch.arrivals[0]) * RATE_HZ + 1
        if before < sent - 2:  # one may be on its way when the cut comes
            sys.exit('lines of {} images before the cut, about {:.0f} were sent'.format(before, sent))
        ended = time.monotonic() - time.time() + os.path.getmtime(watch.cut)
        print('estimator: lines of {} images before the cut and of {} after it, {} messages of the bridge; none for {:.1f} s, '
              'again {:.1f} s after its end'.format(before, len(watch.arrivals) - before, watch.pairs, gap,
                                                    watch.arrivals[before] - ended))


if __name__ == '__main__':
    main()
