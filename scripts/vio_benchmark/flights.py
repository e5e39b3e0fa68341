"""Cases, and what a bag says of its flight: camera, IMU, true poses."""
import os
import random
import subprocess
from dataclasses import dataclass, field

import numpy
import rosbag

import metrics
from nodes import Failure

IMAGE, CAMERA_INFO, IMU, POSE = '/cam0/image_raw', '/cam0/camera_info', '/imu0', '/ground_truth/pose'


@dataclass
class Case:
    """A flight and what is done to it."""
    name: str
    words: str  # what it is, for the page
    points: int = 0  # that the estimator is given once it has started; 0: all
    simulate: list = field(default_factory=list)  # options of simulate_bag
    drop: float = 0.0  # share of the images that are lost
    flight: str = ''  # the case whose bag is used; empty: its own


CASES = [
    Case('room', 'room, 15 points', 15, ['--motion', 'slow']),
    Case('corridor', 'corridor, 10 points', 10, ['--motion', 'corridor']),
    Case('fast', 'room, turning at up to 1.5 rad/s, 15 points', 15, ['--motion', 'fast']),
    Case('low_light', 'room in low light, 15 points', 15, ['--motion', 'slow', '--light', 'low']),
    Case('drops', 'room, 5 % of the images lost, 15 points', 15, ['--motion', 'slow'], 0.05, 'room'),
    Case('all_points', 'room, all points of the tracker (150)', 0, ['--motion', 'slow'], 0.0, 'room'),
]


def make_flight(case, seed, seconds, folder, tools):
    """Bag of a simulated flight, rendered once."""
    path = os.path.join(folder, '{}-{}.bag'.format(case.flight or case.name, seed))
    made, options = path[:-4] + '.options', case.simulate + ['--hand-sway', '--seconds', '{:g}'.format(seconds), '--seed', str(seed)]
    if os.path.exists(path) and os.path.exists(made):
        with open(made) as file:
            earlier = file.read().split()
        if earlier != options:
            raise Failure('{} was made with {}, not {}: take another RESULTS'.format(path, ' '.join(earlier), ' '.join(options)))
    else:
        subprocess.run([os.path.join(tools, 'simulate_bag'), path] + options, check=True, stdin=subprocess.DEVNULL)
        with open(made, 'w') as file:
            file.write(' '.join(options) + '\n')
    return path if case.drop == 0.0 else without_images(path, case.drop, seed)


def without_images(path, share, seed):
    """A copy of a bag in which images are missing."""
    out = '{}-without_{:g}.bag'.format(path[:-4], share)
    if not os.path.exists(out):
        chance = random.Random(seed)
        with rosbag.Bag(path) as bag, rosbag.Bag(out + '.part', 'w') as copy:
            for topic, message, stamp, connection in bag.read_messages(raw=True, return_connection_header=True):
                if topic != IMAGE or chance.random() >= share:
                    copy.write(topic, message, stamp, raw=True, connection_header=connection)
        os.rename(out + '.part', out)
    return out


class Flight:
    """What is constant in a bag, and its true poses of the IMU."""

    def __init__(self, path):
        self.path = path
        with rosbag.Bag(path) as bag:
            self.camera = next((m for _, m, _ in bag.read_messages([CAMERA_INFO])), None)
            self.imu = [m for _, m, _ in bag.read_messages([IMU])]
            self.image_stamps = [stamp.to_sec() for _, _, stamp in bag.read_messages([IMAGE], raw=True)]
            transforms = [t for _, m, _ in bag.read_messages(['/tf_static']) for t in m.transforms]
            poses = [m for _, m, _ in bag.read_messages([POSE])]
        if self.camera is None or not self.imu or not poses:
            raise Failure('{} lacks a camera_info, an IMU or true poses'.format(path))
        if self.camera.distortion_model != 'plumb_bob':
            raise Failure('{}: PL-VINS is set up here for plumb_bob cameras, not {}'.format(path, self.camera.distortion_model))
        self.camera_from_imu = self.extrinsic(transforms)
        self.stamps = numpy.array([m.header.stamp.to_sec() for m in poses])
        self.truth = [metrics.pose_matrix(m.pose.position, m.pose.orientation) @ self.camera_from_imu for m in poses]

    def extrinsic(self, transforms):
        for t in transforms:
            pose = metrics.pose_matrix(t.transform.translation, t.transform.rotation)
            ends = t.header.frame_id, t.child_frame_id
            if ends == ('cam0', 'imu0'):
                return pose
            if ends == ('imu0', 'cam0'):
                return numpy.linalg.inv(pose)
        raise Failure('{} does not say on /tf_static how imu0 lies to cam0'.format(self.path))

    def true_pose(self, stamp):
        return metrics.pose_at(self.stamps, self.truth, stamp)

    def write_configuration(self, path):
        """The settings file of PL-VINS's nodes: this camera and IMU, else the values it has for EuRoC."""
        camera, imu_from_camera = self.camera, numpy.linalg.inv(self.camera_from_imu)

        def matrix(name, values):
            return '{}: !!opencv-matrix\n   rows: 3\n   cols: {}\n   dt: d\n   data: [{}]\n'.format(
                name, values.size // 3, ', '.join('{:.17g}'.format(x) for x in values.flatten()))
        k1, k2, p1, p2 = (list(camera.D) + [0.0] * 4)[:4]
        text = '''%YAML:1.0
imu_topic: "{imu}"
image_topic: "{image}"
output_path: "/"
model_type: PINHOLE
camera_name: camera
image_width: {width}
image_height: {height}
distortion_parameters:
   k1: {k1}
   k2: {k2}
   p1: {p1}
   p2: {p2}
projection_parameters:
   fx: {fx}
   fy: {fy}
   cx: {cx}
   cy: {cy}
estimate_extrinsic: 0
{rotation}{translation}max_cnt: 150
min_dist: 30
freq: 10
F_threshold: 1.0
show_track: 0
equalize: 1
fisheye: 0
max_solver_time: 1000.0
max_num_iterations: 10
keyframe_parallax: 10.0
acc_n: 0.08
gyr_n: 0.004
acc_w: 0.00004
gyr_w: 2.0e-6
g_norm: 9.81
loop_closure: 0
'''.format(imu=IMU, image=IMAGE, width=camera.width, height=camera.height, k1=k1, k2=k2, p1=p1, p2=p2, fx=camera.K[0],
           fy=camera.K[4], cx=camera.K[2], cy=camera.K[5], rotation=matrix('extrinsicRotation', imu_from_camera[:3, :3]),
           translation=matrix('extrinsicTranslation', imu_from_camera[:3, 3]))
        with open(path, 'w') as file:
            file.write(text)
