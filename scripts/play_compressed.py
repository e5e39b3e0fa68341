#!/usr/bin/env python3
"""Plays the images of a flight as PNG in sensor_msgs/CompressedImage, with their calibration, and the messages of a point
tracker for every second one; called by test_hosts.sh.

    play_compressed.py BAG SECONDS PLAYING

At 20 Hz, forth and back, with stamps of now. PLAYING: a file that is made when the first image goes out.
"""
import struct
import sys
import time
import zlib

import rosbag
import rospy
from sensor_msgs.msg import CameraInfo, CompressedImage, PointCloud

from play_with_faults import await_connections

RATE_HZ = 20.0
MAX_IMAGES = 60


def png(image):
    """A mono8 image as the bytes of a PNG file."""
    def chunk(kind, data):
        return struct.pack('>I', len(data)) + kind + data + struct.pack('>I', zlib.crc32(kind + data))
    rows = b''.join(b'\0' + image.data[y * image.step:y * image.step + image.width] for y in range(image.height))
    header = struct.pack('>IIBBBBB', image.width, image.height, 8, 0, 0, 0, 0)
    return b'\x89PNG\r\n\x1a\n' + chunk(b'IHDR', header) + chunk(b'IDAT', zlib.compress(rows, 1)) + chunk(b'IEND', b'')


def main():
    bag = rosbag.Bag(sys.argv[1])
    pictures = []
    for _, message, _ in bag.read_messages('/cam0/image_raw'):
        pictures.append(CompressedImage(header=message.header, format='mono8; png compressed ', data=png(message)))
        if len(pictures) == MAX_IMAGES:
            break
    info = next(message for _, message, _ in bag.read_messages('/cam0/camera_info'))
    rospy.init_node('play_compressed')
    images = rospy.Publisher('/cam0/image_raw/compressed', CompressedImage, queue_size=2, tcp_nodelay=True)
    camera_info = rospy.Publisher('/cam0/camera_info', CameraInfo, queue_size=2, tcp_nodelay=True)
    points = rospy.Publisher('/feature_tracker/feature', PointCloud, queue_size=2, tcp_nodelay=True)
    await_connections([(images, 1), (camera_info, 1), (points, 1)])
    time.sleep(2.0)  # tracker and estimator find each other meanwhile, which cannot be seen from here

    count = int(float(sys.argv[2]) * RATE_HZ)
    order = list(range(len(pictures))) + list(range(len(pictures) - 2, 0, -1))
    rate = rospy.Rate(RATE_HZ)
    open(sys.argv[3], 'w').close()
    for i in range(count):
        picture = pictures[order[i % len(order)]]
        picture.header.stamp = rospy.Time.now()
        info.header = picture.header
        camera_info.publish(info)
        images.publish(picture)
        if i % 2 == 0:
            points.publish(PointCloud(header=picture.header))
        rate.sleep()
    print('camera: {} images of {:.0f} KB each'.format(count, sum(len(p.data) for p in pictures) / len(pictures) / 1e3))


if __name__ == '__main__':
    main()
