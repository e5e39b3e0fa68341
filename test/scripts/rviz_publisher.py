#!/usr/bin/env python3
"""Publishes lines for tests of rviz, as the lines of its standard input say:

    lines STAMP IMAGE_COUNT [AGE]    an image with a line of this age, or without lines
    map STAMP                        a map with one line, which is exactly known
    picture STAMP IMAGE_COUNT        a raw picture of EuRoC's camera with a green band, and the line in its middle, which is old
"""
import sys

import rospy
from sensor_msgs.msg import CameraInfo, Image
from std_msgs.msg import Header
from tet_line_tracker.msg import Line, Line3D, Line3DArray, LineArray

WIDTH, HEIGHT = 752, 480
FX, FY, CX, CY = 458.654, 457.296, 367.215, 248.375
K1, K2, P1, P2 = -0.28340811, 0.07395907, 0.00019359, 1.76187114e-05
START, END = (-0.75, -0.42), (0.75, -0.38)
HALF_BAND = 6


def pixel(x, y):
    """Where the lens shows a point of z = 1."""
    r2 = x * x + y * y
    radial = 1 + r2 * (K1 + r2 * K2)
    return (FX * (x * radial + 2 * P1 * x * y + P2 * (r2 + 2 * x * x)) + CX,
            FY * (y * radial + P1 * (r2 + 2 * y * y) + 2 * P2 * x * y) + CY)


def picture():
    """Gray, with a green band along the image of the line."""
    data = bytearray([90]) * (3 * WIDTH * HEIGHT)
    steps = 4 * WIDTH
    for i in range(steps + 1):
        x, y = pixel(*(a + (b - a) * i / steps for a, b in zip(START, END)))
        for row in range(round(y) - HALF_BAND, round(y) + HALF_BAND + 1):
            at = 3 * (row * WIDTH + round(x))
            data[at:at + 3] = bytes((0, 200, 0))
    return Image(width=WIDTH, height=HEIGHT, encoding='rgb8', step=3 * WIDTH, data=bytes(data))


def camera_info():
    return CameraInfo(width=WIDTH, height=HEIGHT, distortion_model='plumb_bob', D=[K1, K2, P1, P2],
                      K=[FX, 0, CX, 0, FY, CY, 0, 0, 1], P=[FX, 0, CX, 0, 0, FY, CY, 0, 0, 0, 1, 0])


def main():
    rospy.init_node('publisher', disable_signals=True)
    publishers = {'lines': rospy.Publisher('/line_tracker/lines', LineArray, queue_size=10, latch=True),
                  'map': rospy.Publisher('/line_mapper/lines', Line3DArray, queue_size=10, latch=True)}
    beside = [(rospy.Publisher('/camera/image_raw', Image, queue_size=10, latch=True), picture),
              (rospy.Publisher('/camera/camera_info', CameraInfo, queue_size=10, latch=True), camera_info)]
    for text in sys.stdin:
        words = text.split()
        header = Header(stamp=rospy.Time.from_sec(float(words[1])), frame_id='cam0')
        message = Line3DArray(header=header) if words[0] == 'map' else LineArray(header=header)
        if words[0] == 'map':
            line = Line3D(id=1)
            line.start.x, line.end.x = -3.0, 3.0
            line.start.y = line.end.y = 1.0
            message.lines.append(line)
        elif words[0] == 'picture':
            message.image_count = int(words[2])
            message.width, message.height = WIDTH, HEIGHT
            message.lines.append(Line(id=1, age=100, start_normalized=START, end_normalized=END,
                                      start_px=pixel(*START), end_px=pixel(*END)))
            for publisher, make in beside:
                extra = make()
                extra.header = header
                publisher.publish(extra)
        else:
            message.image_count = int(words[2])
            for age in words[3:]:
                message.lines.append(Line(id=int(age), age=int(age), start_normalized=[-2.0, 0.5], end_normalized=[2.0, 0.5]))
        publishers['map' if words[0] == 'map' else 'lines'].publish(message)


if __name__ == '__main__':
    main()
