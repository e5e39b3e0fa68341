#!/usr/bin/env python3
"""What an estimator does with lines, in short: keeps the views of each track, forgets tracks that ended."""
import math

import rospy
from std_msgs.msg import String
from tet_line_tracker.msg import LineArray


class LineSubscriber:
    def __init__(self):
        self.epoch = 0
        self.views = {}  # lists of Line by id, newest last
        self.summary = rospy.Publisher("~summary", String, queue_size=10)
        rospy.Subscriber("/line_tracker/lines", LineArray, self.on_lines, queue_size=100)

    def on_lines(self, array):
        if array.epoch != self.epoch:  # a reset: ids begin anew
            self.views = {}
        self.epoch = array.epoch
        # A line that is missing once never comes back under its id. Not finite: no calibration, or the line is
        # not in front of the camera. Weigh a line by 1 / sigma_px where that is finite.
        self.views = {line.id: self.views.get(line.id, []) + [line] for line in array.lines
                      if math.isfinite(line.start_normalized[0])}
        usable = sum(len(track) >= 5 for track in self.views.values())
        self.summary.publish("%d lines, %d seen 5 times" % (len(self.views), usable))


if __name__ == "__main__":
    rospy.init_node("line_subscriber")
    subscriber = LineSubscriber()
    rospy.spin()
