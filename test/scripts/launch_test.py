#!/usr/bin/env python3
"""Tests of the launch files and of the programs that rosrun finds.   launch_test.py [RESULT.xml]"""
import glob
import os
import re
import subprocess
import tempfile
import unittest
import xml.etree.ElementTree as ElementTree

import cases

LAUNCH_FILES = sorted(glob.glob(cases.ROOT + '/launch/*.launch'))


def run(*command, **options):
    """Exit status and output of a command that must not wait for anybody."""
    done = subprocess.run(command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=60,
                          **options)
    return done.returncode, done.stdout.decode()


def arguments(path):
    """The arguments that a user may give; those with a value are fixed."""
    return [arg for arg in ElementTree.parse(path).getroot().findall('arg') if 'value' not in arg.attrib]


class Arguments(unittest.TestCase):
    def test_each_has_a_sentence_and_only_the_dataset_has_to_be_given(self):
        for path in LAUNCH_FILES:
            status, output = run('roslaunch', '--ros-args', path)
            self.assertEqual(status, 0, output)
            self.assertNotIn('undocumented', output, path)
            needed = re.findall(r'^  (\w+): ', output.split('Optional Arguments')[0], re.MULTILINE)
            self.assertEqual(needed, ['dataset'] if path.endswith('/dataset.launch') else [], path)

    def test_each_is_in_the_section_of_its_file_in_the_docs(self):
        with open(cases.ROOT + '/docs/launch.md') as file:
            sections = re.split(r'^## ', file.read(), flags=re.MULTILINE)
        for path in LAUNCH_FILES:
            name = os.path.basename(path)
            section = [text for text in sections if text.startswith(name + '\n')]
            self.assertEqual(len(section), 1, name)
            for argument in arguments(path):
                self.assertIn('`{}`'.format(argument.get('name')), section[0], name)

    def test_what_pl_vins_takes_reaches_the_tracker_and_the_bridge(self):
        given = {'imu': '/gyro', 'imu_rotation': '0 0 1 0', 'config': cases.ROOT + '/config/line_tracker.yaml',
                 'max_lines': '77', 'max_wait': '0.5', 'manager': 'there', 'start_manager': 'false'}
        status, parameters = run('roslaunch', '--dump-params', cases.ROOT + '/launch/pl_vins.launch',
                                 *('{}:={}'.format(*pair) for pair in given.items()))
        self.assertEqual(status, 0, parameters)
        self.assertIn('/line_tracker/imu_rotation: 0 0 1 0', parameters)
        self.assertIn('/pl_vins_bridge/max_lines: 77', parameters)
        self.assertIn('/pl_vins_bridge/max_wait: 0.5', parameters)
        status, nodes = run('roslaunch', '--nodes', cases.ROOT + '/launch/pl_vins.launch',
                            *('{}:={}'.format(*pair) for pair in given.items()))
        self.assertEqual(nodes.split(), ['/line_tracker', '/pl_vins_bridge'])
        status, command = run('roslaunch', '--args', '/line_tracker', cases.ROOT + '/launch/pl_vins.launch',
                              *('{}:={}'.format(*pair) for pair in given.items()))
        self.assertIn('imu:=/gyro', command)
        self.assertIn('tet_line_tracker/LineTracker there', command)

    def test_without_imu_rotation_the_configuration_decides(self):
        status, parameters = run('roslaunch', '--dump-params', cases.ROOT + '/launch/line_tracker.launch')
        self.assertEqual(status, 0, parameters)
        self.assertIn("/line_tracker/imu_rotation: ''", parameters)


class Programs(unittest.TestCase):
    def test_rosrun_finds_each_python_program_once(self):
        installed = []
        for path in ('src/tools/CMakeLists.txt', 'examples/CMakeLists.txt'):
            with open(os.path.join(cases.ROOT, path)) as file:
                for block in re.findall(r'catkin_install_python\(PROGRAMS(.*?)DESTINATION', file.read(), re.DOTALL):
                    installed += [os.path.basename(word) for word in block.split()]
        self.assertIn('reproduce_paper', installed)
        for name in installed:
            # With the prefix, rosrun prints the program that it would start.
            status, output = run('rosrun', '--prefix', 'echo', 'tet_line_tracker', name)
            self.assertEqual(status, 0, output)
            self.assertNotIn('non-unique', output)
            self.assertEqual(os.path.basename(output.strip()), name)


class PlayDataset(unittest.TestCase):
    def play(self, *words, **options):
        return run('rosrun', 'tet_line_tracker', 'play_dataset', *words, **options)

    def test_says_what_is_not_there(self):
        with tempfile.TemporaryDirectory(prefix='with space ') as folder:
            for words, sentence in ((['flight.bag'], 'there is no bag {}/flight.bag'),
                                    (['seq', '--format', 'kitti'], 'there is no kitti sequence {}/seq')):
                status, output = self.play(*words, cwd=folder)
                self.assertEqual(status, 1, output)
                self.assertIn(sentence.format(folder), output)

    def test_a_sequence_that_cannot_be_converted_leaves_no_bag_and_ends_with_an_error(self):
        with tempfile.TemporaryDirectory() as folder:
            status, output = self.play(folder, '--format', 'tum', '--bag', folder + '/made.bag')
            self.assertEqual(status, 1, output)
            self.assertIn(folder + '/made.bag was not made', output)
            self.assertEqual(os.listdir(folder), [])

    def test_knows_every_format_of_dataset_to_bag(self):
        _, tool = run('rosrun', 'tet_line_tracker', 'dataset_to_bag', '--help')
        _, player = self.play('--help')
        for name in re.search(r'dataset_to_bag (\S+) PATH', tool).group(1).split('|'):
            self.assertRegex(player, r'[{,]' + name + '[,}]')


if __name__ == '__main__':
    cases.run(Arguments, Programs, PlayDataset)
