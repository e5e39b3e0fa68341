#!/usr/bin/env python3
"""Runs the commands of README and docs/ as they are written, in the order of each page, and prints a line for each.

  check_docs.py [--clone] [--list] FOLDER [PAGE ...]

FOLDER: a new folder to run them in. PAGE: only these pages. --clone: README's commands begin with `git clone` and build in FOLDER
what they need (10 minutes or more); else the build of this project serves, and commands on the source folder are left out.
--list: what would be run, and what not and why.
What the commands read (flights, calibrations, a tracker that runs) is made first; where a page names a public dataset, that of
../shared/data stands for it (TET_SHARED_DATA names another place), and what is not there is skipped and said.
What stays until Ctrl-C is interrupted after a while, and must have started, said no error, and end when it is told to.
Exit status: 1 when a command fails.
"""
import argparse
import collections
import contextlib
import glob
import os
import re
import shutil
import signal
import socket
import subprocess
import sys
import time

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
DATA = os.path.realpath(os.environ.get('TET_SHARED_DATA', os.path.join(ROOT, '../shared/data')))
PROGRAMS = ('git', 'cmake', 'ninja', 'rosrun', 'roslaunch', 'rosservice', '.', '.ci/run')
STAYS_SECONDS = 12  # that a command which stays is watched for
LIMIT_SECONDS = 3600  # for a command that ends by itself
ERRORS = re.compile(r'\[ ?(?:ERROR|FATAL)\]|process has died|Traceback|^ERROR:|cannot launch|command not found', re.MULTILINE)

# What is no error of ours: launch files go on where rviz is not installed, and Debian 11's roslaunch and rospy end with a mistake.
HARMLESS = re.compile(r"ERROR: cannot launch node of type \[rviz/rviz\]|"
                      r"Traceback[^\n]*\n(?:  [^\n]*\n)*AttributeError: '(?:ProcessMonitor|Thread)' object has no attribute 'isAlive'")
# A command that fails with these does so for another's mistake: Debian 11's dynparam cannot read what it has written.
NOT_OURS = re.compile(r'!!python/object/new:dynamic_reco')

# Commands that are not run here, and why.
LEFT_OUT = (
    (r'^\.ci/run|^scripts/(?:test|mutate|coverage)(?:_\w+)?\.sh', 'is a run of tests of its own'),
    (r'rqt_reconfigure', 'Debian has no rqt'),
    (r'^scripts/vio_benchmark\.sh', 'needs a checkout of PL-VINS'),
    (r'reproduce_paper|^scripts/measure_', 'measures for an hour'),
)
# What the pages call a dataset: the folder of ../shared/data.
DATASETS = {
    'MH_01_easy': 'euroc_v1_01', 'V1_01_easy': 'euroc_v1_01', 'V1_01': 'euroc_v1_01',
    'rgbd_dataset_freiburg3_structure_notexture_far': 'tum_fr3_structure_notexture_far',
    'living_room_traj0_frei_png': 'icl_nuim_of_kt0', 'sequences/00': 'kitti_00',
}
CALIBRATION = """\
image_width: 752
image_height: 480
camera_name: camera
camera_matrix: {rows: 3, cols: 3, data: [460, 0, 375.5, 0, 460, 239.5, 0, 0, 1]}
distortion_model: plumb_bob
distortion_coefficients: {rows: 1, cols: 5, data: [0, 0, 0, 0, 0]}
"""

# The topics of docs/launch.md, for a flight of simulate_bag.
RENAME_TOPICS = """\
import rosbag, sys
names = {'/cam0/image_raw': '/camera/image_raw', '/cam0/camera_info': '/camera/camera_info', '/imu0': '/imu/data'}
with rosbag.Bag(sys.argv[1]) as source, rosbag.Bag(sys.argv[2], 'w') as renamed:
    for topic, message, stamp in source.read_messages():
        renamed.write(names.get(topic, topic), message, stamp)
"""

Command = collections.namedtuple('Command', 'page text left_out')


def pages():
    """README, CONTRIBUTING and every page below docs/, relative to the project."""
    found = glob.glob(os.path.join(ROOT, 'docs', '**', '*.md'), recursive=True)
    return ['README.md', 'CONTRIBUTING.md'] + sorted(os.path.relpath(path, ROOT) for path in found)


def blocks(text):
    """The lines of code blocks without a language, fenced or indented, with those that end in a backslash joined."""
    fence = None
    joined = ''
    for line in text.split('\n'):
        if line.startswith('```'):
            fence = None if fence is not None else line[3:]
            continue
        if fence == '' or (fence is None and line.startswith('    ')):
            joined += line.strip()
            if joined.endswith('\\'):
                joined = joined[:-1]
                continue
            yield joined
        joined = ''


def commands(page, with_clone):
    """The commands of a page, in their order."""
    with open(os.path.join(ROOT, page)) as file:
        text = file.read()
    for line in blocks(text):
        word = line.split(' ')[0]
        if word not in PROGRAMS and not word.startswith('scripts/'):
            continue
        left_out = next((why for pattern, why in LEFT_OUT if re.search(pattern, line)), None)
        if not (with_clone or word.startswith('ros')):
            left_out = left_out or 'only with --clone'
        yield Command(page, line, left_out)


class Workplace:
    """The folder in which the commands run, and what they find there."""

    def __init__(self, folder, with_clone):
        os.makedirs(folder)
        self.folder = folder
        self.with_clone = with_clone
        self.screen = Screen()
        self.inside = os.path.join(folder, 'tet_line_tracker')
        self.environment = dict(os.environ, ROS_HOSTNAME='localhost', PATH='/usr/sbin:/usr/bin:/sbin:/bin:' + os.environ['PATH'],
                                ROSCONSOLE_STDOUT_LINE_BUFFERED='1')
        # Without a display, as on a server; a launch file is given one.
        self.environment.pop('DISPLAY', None)
        self.choose_master()
        if not with_clone:
            os.makedirs(self.inside)

    def choose_master(self):
        """Another master for what is started from now on."""
        with socket.socket() as listener:
            listener.bind(('localhost', 0))
            self.environment['ROS_MASTER_URI'] = 'http://localhost:{}'.format(listener.getsockname()[1])

    def start(self, text, log):
        """Starts a command in a shell that has sourced the build, as its own process group."""
        text = re.sub(r'^roslaunch ', 'roslaunch -p ${ROS_MASTER_URI##*:} ', text)
        text = text.replace('URL_OF_THIS_REPOSITORY', ROOT).replace('PREFIX', os.path.join(self.folder, 'prefix'))
        environment = self.environment
        screen = self.screen.find() if text.startswith('roslaunch') else None
        if screen is not None:
            environment = dict(environment, DISPLAY=screen)
        is_inside = os.path.exists(self.inside)
        setup = os.path.join(self.inside if self.with_clone else ROOT, 'build/devel/setup.bash')
        sourced = '. "{}"; '.format(setup) if text.startswith(('ros', 'python3')) and os.path.exists(setup) else ''
        return subprocess.Popen(['bash', '-c', sourced + text], cwd=self.inside if is_inside else self.folder, stdin=subprocess.DEVNULL,
                                stdout=log, stderr=subprocess.STDOUT, env=environment, start_new_session=True)

    def run(self, text):
        """Runs what a page takes for granted; ends the program when that fails."""
        with open(os.path.join(self.folder, 'preparation.log'), 'ab+') as log:
            if self.start(text, log).wait() != 0:
                sys.exit('check_docs.py: could not prepare the commands: {} ({})'.format(text, log.name))

    def path(self, name):
        return os.path.join(self.inside, name)


def interrupt(process):
    """Ctrl-C to all that a command started; the exit status, or nothing when it does not end."""
    with contextlib.suppress(ProcessLookupError):
        os.killpg(process.pid, signal.SIGINT)
    try:
        return process.wait(timeout=40)
    except subprocess.TimeoutExpired:
        os.killpg(process.pid, signal.SIGKILL)
        process.wait()
        return None


class Beside:
    """Commands that go on while others are tried: started when they are first asked for, stopped when others are."""

    def __init__(self, workplace):
        self.workplace = workplace
        self.texts = []
        self.processes = []

    def keep(self, texts):
        if texts == self.texts:
            return
        for process in reversed(self.processes):
            interrupt(process)
        self.texts = texts
        self.workplace.choose_master()
        self.processes = []
        with open(os.path.join(self.workplace.folder, 'beside.log'), 'ab') as log:
            for text in texts:
                self.processes.append(self.workplace.start(text, log))
                time.sleep(8)


def flight(workplace):
    """A flight with what a recorded bag has."""
    if not os.path.exists(workplace.path('made_flight.bag')):
        workplace.run('rosrun tet_line_tracker simulate_bag made_flight.bag --seconds 5')
        workplace.run('rosrun tet_line_tracker track_bag made_flight.bag made_tracks.bag')
    return 'made_flight.bag'


def prepare(workplace, beside, text):
    """Makes what a command reads; a sentence when that cannot be had."""
    for name, folder in DATASETS.items():
        if re.search(r'[ =]{}\b'.format(re.escape(name)), text):
            source = os.path.join(DATA, folder)
            if not os.path.exists(source):
                return 'there is no {}'.format(source)
            if not os.path.exists(workplace.path(name)):
                os.makedirs(os.path.dirname(workplace.path(name)), exist_ok=True)
                # The bag that is made of a dataset is kept beside it, so the folder must be writable.
                shutil.copytree(source, workplace.path(name))
    if 'flight.mp4' in text and not os.path.exists(workplace.path('flight.mp4')):
        workplace.run('rosrun tet_line_tracker track_bag {} video_tracks.bag --video flight.mp4'.format(flight(workplace)))
        with open(workplace.path('camera.yaml'), 'w') as file:
            file.write(CALIBRATION)
    if 'recorded.bag' in text:
        workplace.run('python3 -c "{}" {} recorded.bag'.format(RENAME_TOPICS, flight(workplace)))
    if 'TRACKS.bag' in text or 'MAP.bag' in text:
        flight(workplace)
        if not os.path.exists(workplace.path('TRACKS.bag')):
            shutil.copy(workplace.path('made_tracks.bag'), workplace.path('TRACKS.bag'))
    if ' run.bag' in text:
        source = flight(workplace)
        beside.keep(['roslaunch tet_line_tracker pl_vins.launch',
                     'rosrun rosbag record -O run.bag /feature_tracker/feature /linefeature_tracker/linefeature'])
        workplace.run('python3 "{}/scripts/play_with_faults.py" {} 1'.format(ROOT, source))
        beside.keep([])
    return None


def servers(workplace, text):
    """What runs beside a command: the nodes that it talks to."""
    if 'dynparam' in text:
        return ['roslaunch tet_line_tracker demo.launch rviz:=false loop:=true bag:=$PWD/' + flight(workplace)]
    if re.search(r'check_plvins_contract(?! run)', text):
        preset, points = ('eplf_vins', 'lf_feature_tracker') if 'eplf_vins' in text else ('pl_vins', 'feature_tracker')
        return ['roslaunch tet_line_tracker pl_vins.launch preset:=' + preset,
                'rostopic pub -s -r 10 /{}/feature sensor_msgs/PointCloud "header: auto"'.format(points)]
    manager = re.search(r'manager:=/camera/(\w+)', text)
    if manager:
        return ['roscore -p ${ROS_MASTER_URI##*:}',
                'rosrun nodelet nodelet manager __ns:=/camera __name:=' + manager.group(1)]
    return []


class Screen:
    """A screen for rviz, from when Xvfb is there: a command of the pages may be what installs it."""

    def __init__(self):
        self.server = None
        self.name = None

    def find(self):
        """Its name, or None."""
        if self.server is None and shutil.which('Xvfb') is not None:
            read, write = os.pipe()
            self.server = subprocess.Popen(['Xvfb', '-displayfd', str(write), '-screen', '0', '1280x1024x24'], pass_fds=[write],
                                           stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            os.close(write)
            with os.fdopen(read) as number:
                self.name = ':' + number.readline().strip()
        return self.name

    def close(self):
        if self.server is not None:
            self.server.terminate()
            self.server.wait()


def stays(text):
    return text.startswith('roslaunch') or 'until Ctrl-C' in text


def attempt(workplace, command, log_path):
    """Nothing when the command does what the page says, else a sentence."""
    with open(log_path, 'wb') as log:
        process = workplace.start(command.text, log)
        try:
            status = process.wait(timeout=STAYS_SECONDS if stays(command.text) else LIMIT_SECONDS)
            if status != 0:
                with open(log_path, errors='replace') as said:
                    return None if NOT_OURS.search(said.read()) else 'ended with {}'.format(status)
        except subprocess.TimeoutExpired:
            status = interrupt(process)
            if not stays(command.text):
                return 'took over {} s'.format(LIMIT_SECONDS)
            if status is None:
                return 'did not end after Ctrl-C'
    with open(log_path, errors='replace') as log:
        error = ERRORS.search(HARMLESS.sub('', log.read()))
    return 'said: ' + error.group() if error else None


def run_all(workplace, chosen):
    """Tries each command and prints its line; how many ran, failed and were skipped."""
    beside = Beside(workplace)
    counts = collections.Counter()
    with contextlib.closing(workplace.screen):
        for number, command in enumerate(chosen):
            skipped = command.left_out or prepare(workplace, beside, command.text)
            log_path = os.path.join(workplace.folder, '{:03d}.log'.format(number))
            failed = None
            if not skipped:
                beside.keep(servers(workplace, command.text))
                failed = attempt(workplace, command, log_path)
            verdict = 'skipped' if skipped else 'FAILED' if failed else 'ran'
            counts[verdict] += 1
            reason = skipped or (failed and '{}: {}'.format(failed, log_path))
            print('{:8}{}: {}{}'.format(verdict, command.page, command.text, '  ({})'.format(reason) if reason else ''), flush=True)
        beside.keep([])
    return counts


def main():
    parser = argparse.ArgumentParser(usage=__doc__, add_help=False)
    parser.add_argument('--clone', action='store_true')
    parser.add_argument('--list', action='store_true')
    parser.add_argument('--help', '-h', action='store_true')
    parser.add_argument('folder', nargs='?')
    parser.add_argument('pages', nargs='*')
    arguments = parser.parse_args()
    if arguments.help:
        print(__doc__, end='')
        return 0
    chosen = [command for page in arguments.pages or pages() for command in commands(page, arguments.clone)]
    if arguments.list:
        for command in chosen:
            print('{}: {}{}'.format(command.page, command.text, '  (left out: {})'.format(command.left_out) if command.left_out else ''))
        return 0
    if arguments.folder is None or os.path.exists(arguments.folder):
        sys.exit('check_docs.py: needs a folder that does not exist yet; see --help')
    workplace = Workplace(os.path.realpath(arguments.folder), arguments.clone)
    counts = run_all(workplace, chosen)
    print('{} commands ran, {} failed, {} skipped'.format(counts['ran'] + counts['FAILED'], counts['FAILED'], counts['skipped']))
    return 1 if counts['FAILED'] else 0


if __name__ == '__main__':
    sys.exit(main())
