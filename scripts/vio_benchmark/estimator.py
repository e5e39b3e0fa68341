"""PL-VINS's estimator on recorded points, lines and IMU: poses, line factors."""
import os
import re
import statistics
import threading
from dataclasses import dataclass

import numpy
import rospy
from nav_msgs.msg import Odometry
from sensor_msgs.msg import Imu, PointCloud

import flights
import lines
import metrics
from nodes import Failure, wait_until

NODE = '/vins_estimator'
SETTLE = 5.0  # all points until then: the estimator wants over 20 to start; errors count from then on, or from half of a short recording [s]
AHEAD = 3  # messages that the estimator may be behind
FACTORS = re.compile(r'lineFactor: (\d+), pointFactor:\s*(\d+)')


@dataclass
class Result:
    """Of one run of the estimator."""
    ate_se3: float = float('nan')  # [m]
    ate_sim3: float = float('nan')  # [m]
    rpe_m: float = float('nan')
    rpe_deg: float = float('nan')
    line_factors: float = 0.0  # in a solve
    point_factors: float = 0.0
    lines: float = 0.0  # in a message
    unsolved: int = 0  # point messages after the start without a pose
    started: float = float('nan')  # first pose, after the first message [s]

    def is_good(self):
        return self.unsolved == 0 and self.started < SETTLE and self.ate_se3 == self.ate_se3


def settle_time(stamps):
    """Seconds after the first message of a run."""
    return min(SETTLE, 0.5 * (stamps[-1] - stamps[0]))


class Feeder:
    """Publishes in order, never far ahead: no queue overflows, whatever else the machine does."""

    def __init__(self):
        self.imu = rospy.Publisher(flights.IMU, Imu, queue_size=2000, tcp_nodelay=True)
        self.points = rospy.Publisher(lines.POINTS, PointCloud, queue_size=2000, tcp_nodelay=True)
        self.lines = rospy.Publisher(lines.OURS, PointCloud, queue_size=2000, tcp_nodelay=True)
        self.poses = []
        self.silent = False
        self.news = threading.Condition()
        self.subscriber = rospy.Subscriber(NODE + '/odometry', Odometry, self.keep, queue_size=2000, tcp_nodelay=True)

    def keep(self, message):
        with self.news:
            self.poses.append((message.header.stamp.to_sec(),
                               metrics.pose_matrix(message.pose.pose.position, message.pose.pose.orientation)))
            self.news.notify()

    def connected(self):
        return all(p.get_num_connections() > 0 for p in (self.imu, self.points, self.lines)) and \
            self.subscriber.get_num_connections() > 0

    def wait_for(self, stamp, seconds):
        """For the pose of a stamp; not for long once the estimator has fallen silent: it started anew, and may never end that."""
        with self.news:
            came = self.news.wait_for(lambda: self.poses and self.poses[-1][0] > stamp - 1e-6, 0.05 if self.silent else seconds)
            self.silent = not came

    def close(self):
        for each in (self.imu, self.points, self.lines, self.subscriber):
            each.unregister()


def estimate(flight, point_messages, line_messages, keep, start, configuration, programs, new_processes):
    """Runs the estimator from `start` seconds after the first message on. Gives the result, and poses [(stamp, 4 x 4)]."""
    first = point_messages[0].header.stamp.to_sec() + start
    pairs = [(p, l) for p, l in zip(point_messages, line_messages) if p.header.stamp.to_sec() >= first - 1e-6]
    stamps = [p.header.stamp.to_sec() for p, _ in pairs]
    thinner = lines.PointThinner(keep, stamps[0] + settle_time(stamps))
    imu = [m for m in flight.imu if m.header.stamp.to_sec() > first - 0.1]
    with new_processes() as processes:
        processes.start('estimator', [os.path.join(programs, 'estimator'), '__name:=' + NODE[1:], '_config_file:=' + configuration,
                                      '_vins_folder:=/'])
        feeder = Feeder()
        try:
            wait_until(feeder.connected, 60.0, 'the estimator does not listen; see ' + processes.log('estimator'))
            sent = 0
            for k, (points, line_message) in enumerate(pairs):
                stamp = points.header.stamp
                # With the first measurement after the image, without which the estimator waits.
                while sent < len(imu) and (sent == 0 or imu[sent - 1].header.stamp <= stamp):
                    feeder.imu.publish(imu[sent])
                    sent += 1
                feeder.points.publish(thinner.thin(points))
                feeder.lines.publish(line_message)
                if not feeder.poses:
                    rospy.sleep(0.04)
                elif k >= AHEAD:
                    feeder.wait_for(pairs[k - AHEAD][0].header.stamp.to_sec(), 3.0)
                processes.check()
            feeder.wait_for(pairs[-1][0].header.stamp.to_sec(), 5.0)
        finally:
            feeder.close()
    with open(processes.log('estimator'), errors='replace') as log:
        factors = [(int(a), int(b)) for a, b in FACTORS.findall(log.read())]
    return judge(flight, stamps, feeder.poses, factors, [len(l.points) for _, l in pairs]), feeder.poses


def judge(flight, stamps, poses, factors, line_counts):
    """Errors of poses [(stamp, 4 x 4)] that answer messages of the given stamps."""
    result = Result()
    if not poses:
        result.unsolved = len(stamps)
        return result
    result.started = poses[0][0] - stamps[0]
    result.unsolved = sum(stamp > poses[0][0] - 1e-6 for stamp in stamps) - len({stamp for stamp, _ in poses})
    settled = [(stamp, pose, flight.true_pose(stamp)) for stamp, pose in poses if stamp >= stamps[0] + settle_time(stamps)]
    settled = [each for each in settled if each[2] is not None]
    if len(settled) < 10:
        return result
    places = [numpy.array([pose[k][:3, 3] for pose in settled]) for k in (1, 2)]
    result.ate_se3 = metrics.absolute_error(places[0], places[1])
    result.ate_sim3 = metrics.absolute_error(places[0], places[1], with_scale=True)
    result.rpe_m, angle = metrics.relative_errors([s for s, _, _ in settled], [p for _, p, _ in settled],
                                                  [t for _, _, t in settled], 1.0)
    result.rpe_deg = float(numpy.degrees(angle))
    if not factors:
        raise Failure('the log of the estimator says nothing of its factors')
    factors = factors[-len(settled):]
    result.line_factors = statistics.fmean(line for line, _ in factors)
    result.point_factors = statistics.fmean(point for _, point in factors)
    result.lines = statistics.fmean(line_counts[-len(settled):])
    return result
