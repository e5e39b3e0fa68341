#!/usr/bin/env python3
"""What an estimator does with lines, in short: keeps the views of each track, forgets tracks that ended."""
import math

import rospy
from std_msgs.msg import String
from tet_line_tracker.msg import LineArray


def weights_of_ends(line):
    """Weights of the distances of start and end across the line [1/px^2]: 0 where the tracker knows nothing.
    An estimator that can should use the whole matrix (covariance_px[1] is the covariance of both)."""
    start, _, end = line.covariance_px
    return (1.0 / start, 1.0 / end) if start > 0.0 and end > 0.0 else (0.0, 0.0)


class LineSubscriber:
    def __init__(self):
        self.epoch = 0
        self.views = {}  # lists of Line by id, newest last
        self.summary = rospy.Publisher("~summary", String, queue_size=10)
        rospy.Subscriber("/line_tracker/lines", LineArray, self.on_lines, queue_size=100, tcp_nodelay=True)

    def on_lines(self, array):
        if array.epoch != self.epoch:  # a reset: ids begin anew
            self.views = {}
        self.epoch = array.epoch
        # A line that is missing once never comes back under its id. Not finite: no calibration, or the line is
        # not in front of the camera.
        self.views = {line.id: self.views.get(line.id, []) + [line] for line in array.lines
                      if math.isfinite(line.start_normalized[0])}
        usable = sum(len(track) >= 5 and weights_of_ends(track[-1])[0] > 0.0 for track in self.views.values())
        self.summary.publish("%d lines, %d usable" % (len(self.views), usable))


if __name__ == "__main__":
    rospy.init_node("line_subscriber")
    subscriber = LineSubscriber()
    rospy.spin()
