#!/usr/bin/env python3
"""Publishes lines for tests of rviz, as the lines of its standard input say:

    lines STAMP IMAGE_COUNT [AGE]    an image with a line of this age, or without lines
    map STAMP                        a map with one line, which is exactly known
"""
import sys

import rospy
from tet_line_tracker.msg import Line, Line3D, Line3DArray, LineArray


def main():
    rospy.init_node('publisher', disable_signals=True)
    publishers = {'lines': rospy.Publisher('/line_tracker/lines', LineArray, queue_size=10, latch=True),
                  'map': rospy.Publisher('/line_mapper/lines', Line3DArray, queue_size=10, latch=True)}
    for text in sys.stdin:
        words = text.split()
        message = LineArray() if words[0] == 'lines' else Line3DArray()
        message.header.stamp = rospy.Time.from_sec(float(words[1]))
        message.header.frame_id = 'cam0'
        if words[0] == 'map':
            line = Line3D(id=1)
            line.start.x, line.end.x = -3.0, 3.0
            line.start.y = line.end.y = 1.0
            message.lines.append(line)
        else:
            message.image_count = int(words[2])
            for age in words[3:]:
                message.lines.append(Line(id=int(age), age=int(age), start_normalized=[-2.0, 0.5], end_normalized=[2.0, 0.5]))
        publishers[words[0]].publish(message)


if __name__ == '__main__':
    main()
