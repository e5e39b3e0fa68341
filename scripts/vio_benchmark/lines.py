"""Points and lines of a flight: played once to the trackers, with their processor time, and kept."""
import json
import os
import subprocess

import rosbag
import rospy
from geometry_msgs.msg import Point32
from sensor_msgs.msg import ChannelFloat32, PointCloud

import flights
from nodes import Failure, cpu_seconds, listens, pid_of_node, wait_until

POINTS = '/feature_tracker/feature'
# The bridge has the topic that the estimator listens to; PL-VINS's line tracker runs beside it under another name.
OWN_NODE, BRIDGE_MANAGER = '/own_linefeature_tracker', '/line_tracker_manager'
OWN, OURS = OWN_NODE + '/linefeature', '/linefeature_tracker/linefeature'


def empty_lines(header):
    return PointCloud(header=header, channels=[ChannelFloat32() for _ in range(3)])


def perfect_lines(header, array):
    """The true lines of an image as PL-VINS wants them."""
    message = empty_lines(header)
    for line in array.lines:
        message.points.append(Point32(line.start_normalized[0], line.start_normalized[1], 1.0))
        for channel, value in zip(message.channels, (line.id + 1, line.end_normalized[0], line.end_normalized[1])):
            channel.values.append(value)
    return message


class PointThinner:
    """Passes on all points until a stamp, then the `keep` that are tracked longest; an id that was left out never returns."""

    def __init__(self, keep, from_stamp):
        self.keep, self.from_stamp = keep, from_stamp
        self.left_out = set()

    def thin(self, message):
        if self.keep == 0 or message.header.stamp.to_sec() < self.from_stamp:
            return message
        ids = [int(value + 0.5) for value in message.channels[0].values]
        # Ids count up: the smallest are the oldest.
        chosen = set(sorted(each for each in ids if each not in self.left_out)[:self.keep])
        self.left_out.update(each for each in ids if each not in chosen)
        places = [i for i, each in enumerate(ids) if each in chosen]
        return PointCloud(header=message.header, points=[message.points[i] for i in places],
                          channels=[ChannelFloat32(c.name, [c.values[i] for i in places]) for c in message.channels])


class Recorder:
    """Keeps the messages of the trackers."""

    def __init__(self):
        self.messages = {POINTS: [], OWN: [], OURS: []}
        self.subscribers = [rospy.Subscriber(topic, PointCloud, kept.append, queue_size=2000, tcp_nodelay=True)
                            for topic, kept in self.messages.items()]

    def close(self):
        for subscriber in self.subscribers:
            subscriber.unregister()


def play(flight, configuration, programs, processes, rate, launch_arguments):
    """Messages of the trackers, and processor seconds of both line trackers."""
    arguments = ['_config_file:=' + configuration, '_vins_folder:=/']
    processes.start('feature_tracker', [os.path.join(programs, 'feature_tracker')] + arguments)
    processes.start('linefeature_tracker', [os.path.join(programs, 'linefeature_tracker'), '__name:=' + OWN_NODE[1:]] + arguments)
    # max_wait: the points of a busy machine may be far ahead of the lines, and no point message is to go without.
    processes.start('bridge', ['roslaunch', '--wait', 'tet_line_tracker', 'pl_vins.launch', 'max_wait:=5'] + launch_arguments)
    recorder = Recorder()
    try:
        for node, topic in ((BRIDGE_MANAGER, flights.IMAGE), ('/feature_tracker', flights.IMAGE), (OWN_NODE, flights.IMAGE),
                            (BRIDGE_MANAGER, POINTS)):
            wait_until(lambda node=node, topic=topic: listens(node, topic), 60.0, '{} does not listen to {}; see the logs in {}'.format(
                node, topic, processes.logs))
        pids = {OURS: pid_of_node(BRIDGE_MANAGER), OWN: pid_of_node(OWN_NODE)}
        before = {topic: cpu_seconds(pid) for topic, pid in pids.items()}
        player = processes.start('player', ['rosbag', 'play', '--quiet', '-d', '3', '-r', str(rate), flight.path, '--topics',
                                            flights.IMAGE, flights.CAMERA_INFO, flights.IMU, '/tf_static'])
        while player.poll() is None:
            processes.check()
            rospy.sleep(0.2)
        rospy.sleep(2.0)
        cpu = {topic: cpu_seconds(pid) - before[topic] for topic, pid in pids.items()}
    finally:
        recorder.close()
    return recorder.messages, cpu


def published(stamps, frequency=10.0):
    """Those of the images that PL-VINS's point tracker publishes [s]."""
    first, count, chosen = stamps[0], 1, []
    for stamp in stamps[1:]:
        rate = count / (stamp - first)
        if int(rate + 0.5) <= frequency:
            chosen.append(stamp)
            if abs(rate - frequency) < 0.01 * frequency:
                first, count = stamp, 0
            count += 1
    return chosen


def missing(messages, expected):
    """How many messages of each topic are missing, where there should be one for each of the expected stamps [s]."""
    return {topic: sum(round(stamp, 6) not in kept for stamp in expected) for topic, kept in (
        (topic, {round(m.header.stamp.to_sec(), 6) for m in messages[topic]}) for topic in (POINTS, OWN, OURS))}


def track(flight, base, configuration, programs, new_processes, launch_arguments=()):
    """Plays the flight to the trackers, once; again and slower while messages are missing. Gives messages by topic and figures."""
    if not os.path.exists(base + '.json'):
        expected = published(flight.image_stamps)
        for rate in (1.0, 0.5, 0.25):
            with new_processes() as processes:
                messages, cpu = play(flight, configuration, programs, processes, rate, list(launch_arguments))
            lost = missing(messages, expected)
            if not any(lost.values()):
                break
            print('at {:g} times the speed, of {} images PL-VINS had no points for {}, no lines for {}, and we no lines for {}'.format(
                rate, len(expected), lost[POINTS], lost[OWN], lost[OURS]), flush=True)
        else:
            raise Failure('messages are missing also at a quarter of the speed: the machine is too busy')
        count = len(messages[POINTS])
        figures = {'rate': rate, 'messages': count, 'cpu_ms': {t: 1000.0 * seconds / count for t, seconds in cpu.items()}}
        with rosbag.Bag(base + '.bag', 'w') as bag:
            for topic, kept in messages.items():
                for message in kept:
                    bag.write(topic, message, message.header.stamp)
        with open(base + '.json', 'w') as file:
            json.dump(figures, file)
    with open(base + '.json') as file:
        figures = json.load(file)
    messages = {POINTS: [], OWN: [], OURS: []}
    with rosbag.Bag(base + '.bag') as bag:
        for topic, message, _ in bag.read_messages():
            messages[topic].append(message)
    return messages, figures


def line_messages(source, messages, flight, tools):
    """One line message for each point message, in their order."""
    points = messages[POINTS]
    if source == 'none':
        return [empty_lines(m.header) for m in points]
    if source in ('own', 'tet'):
        by_stamp = {m.header.stamp: m for m in messages[OWN if source == 'own' else OURS]}
        return [by_stamp[m.header.stamp] for m in points]
    truth = flight.path[:-4] + '-true.bag'
    if not os.path.exists(truth):
        subprocess.run([os.path.join(tools, 'true_lines'), flight.path, truth], check=True, stdin=subprocess.DEVNULL)
    with rosbag.Bag(truth) as bag:
        arrays = {m.header.stamp: m for _, m, _ in bag.read_messages(['/line_tracker/lines'])}
    return [perfect_lines(m.header, arrays[m.header.stamp]) for m in points]
