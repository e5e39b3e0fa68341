#!/usr/bin/env python3
"""Plays a flight in real time as a bad day would, with a point tracker beside it; called by check_contract.sh.

    play_with_faults.py BAG SEED

Each image is dropped with a chance of 5 %, and else late with a chance of 5 %: by 10 to 300 ms, so that it mostly comes
after the next ones. Every second image, dropped or not, has a message on /feature_tracker/feature in time. The tracker
is reset after one and after two thirds of the flight. The last line says what was done; fails when a reset did not
work.
"""
import heapq
import random
import sys
import time

import rosbag
import rospy
from sensor_msgs.msg import CameraInfo, Image, PointCloud
from std_srvs.srv import Trigger

DROPPED = 0.05
LATE = 0.05
DELAY_S = (0.01, 0.3)


def await_connections(connections, seconds=30.0):
    """Waits until each of (publisher, count) has as many subscribers."""
    end = time.monotonic() + seconds
    for publisher, count in connections:
        while publisher.get_num_connections() < count:
            if time.monotonic() > end:
                sys.exit('{} has {} subscribers after {:.0f} s, needs {}'.format(
                    publisher.resolved_name, publisher.get_num_connections(), seconds, count))
            time.sleep(0.05)


def main():
    bag = rosbag.Bag(sys.argv[1])
    chance = random.Random(int(sys.argv[2]))
    rospy.init_node('play_with_faults')
    images = rospy.Publisher('/cam0/image_raw', Image, queue_size=100)
    camera_info = rospy.Publisher('/cam0/camera_info', CameraInfo, queue_size=100)
    points = rospy.Publisher('/feature_tracker/feature', PointCloud, queue_size=100)
    await_connections([(images, 1), (camera_info, 1), (points, 2)])
    time.sleep(2.0)  # bridge and checker find each other meanwhile, which cannot be seen from here

    count = bag.get_message_count('/cam0/image_raw')
    resets = [count // 3, 2 * count // 3]
    info = next(message for _, message, _ in bag.read_messages('/cam0/camera_info'))
    asked = dropped = late = 0
    waiting = []  # (time to publish, index, image), the next one first

    def publish_due(until):
        """Publishes what is due until a time of time.monotonic(), and returns then."""
        while waiting and waiting[0][0] <= until:
            due, _, image = heapq.heappop(waiting)
            time.sleep(max(0.0, due - time.monotonic()))
            info.header = image.header
            camera_info.publish(info)
            images.publish(image)
        time.sleep(max(0.0, until - time.monotonic()))

    start = first_stamp = None
    for index, (_, image, _) in enumerate(bag.read_messages('/cam0/image_raw')):
        if start is None:
            start, first_stamp = time.monotonic(), image.header.stamp
        now = start + (image.header.stamp - first_stamp).to_sec()
        publish_due(now)
        if index % 2 == 0:
            message = PointCloud()
            message.header.stamp = image.header.stamp
            points.publish(message)
            asked += 1
        if chance.random() < DROPPED:
            dropped += 1
        elif chance.random() < LATE:
            late += 1
            heapq.heappush(waiting, (now + chance.uniform(*DELAY_S), index, image))
        else:
            heapq.heappush(waiting, (now, index, image))
            publish_due(now)
        if index in resets:
            answer = rospy.ServiceProxy('/line_tracker/reset', Trigger)()
            if not answer.success:
                sys.exit('the reset of the tracker failed: ' + answer.message)
    publish_due(time.monotonic() + DELAY_S[1])
    print('{} images, {} dropped, {} late, {} resets, {} point messages'.format(
        count, dropped, late, len(resets), asked))


if __name__ == '__main__':
    main()
