#!/usr/bin/env python3
"""Tests of the configurations of rviz and of the displays in them.   rviz_test.py [RESULT.xml]"""
import glob
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
import unittest
import xml.etree.ElementTree as ElementTree

import yaml

import cases
import rviz_session

CONFIGS = sorted(glob.glob(cases.ROOT + '/rviz/*.rviz'))
OURS = cases.ROOT + '/rviz_plugins.xml'
RVIZ = [path + '/share/rviz/plugin_description.xml' for path in ('/opt/ros/noetic', '/usr')]
# What map_bag writes into a bag that is played beside rviz/line_map.rviz, and no node publishes.
OF_BAGS = ['/ground_truth/edges']


def displays(config):
    with open(config) as file:
        found = yaml.safe_load(file)['Visualization Manager']['Displays']
    assert found, config
    return found


def topics(display):
    """Topics that a display subscribes to, by the name of the property."""
    return {name: value for name, value in display.items() if re.fullmatch(r'(.* )?Topic', name)}


def classes(description):
    """Types of messages that the classes of a plugin description show, by their names."""
    return {each.get('name'): [message.text.strip() for message in each.findall('message_type')]
            for each in ElementTree.parse(description).getroot().iter('class')}


def published():
    """Types of messages by topic: what the nodelets advertise, under the names that the launch files give them."""
    found = {}
    for node, source in (('line_tracker', 'line_publisher'), ('line_tracker', 'debug_image_publisher'),
                         ('line_mapper', 'line_mapper_nodelet')):
        with open('{}/src/ros/{}.cpp'.format(cases.ROOT, source)) as file:
            text = file.read()
        for message, topic in re.findall(r'advertise<([\w:]+)>\("(\w+)"', text):
            package, _, name = message.rpartition('::')
            found['/{}/{}'.format(node, topic)] = '{}/{}'.format(package or 'tet_line_tracker', name)
        for topic in re.findall(r'ImageTransport\(\w+\)\.advertise\("(\w+)"', text):
            found['/{}/{}'.format(node, topic)] = 'sensor_msgs/Image'
        # The name of the node in the launch file.
        with open('{}/launch/{}.launch'.format(cases.ROOT, node)) as file:
            assert '"{}"'.format(node) in file.read(), node
    # What a camera publishes, under the names that the launch file has for it.
    with open(cases.ROOT + '/launch/line_tracker.launch') as file:
        names = dict(re.findall(r'<arg name="(image|camera_info)" default="(\S+)"', file.read()))
    found[names['image']] = 'sensor_msgs/Image'
    found[names['camera_info']] = 'sensor_msgs/CameraInfo'
    return found


class Configurations(unittest.TestCase):
    def test_each_topic_is_published_with_the_type_that_its_display_takes(self):
        types = published()
        self.assertEqual(types['/line_tracker/lines'], 'tet_line_tracker/LineArray')
        shown_by = classes(OURS)
        for description in filter(os.path.exists, RVIZ):
            shown_by.update(classes(description))
        count = 0
        for config in CONFIGS:
            for display in displays(config):
                for name, topic in topics(display).items():
                    count += 1
                    if topic in OF_BAGS:
                        continue
                    self.assertIn(topic, types, '{}: {}'.format(config, display['Name']))
                    if name == 'Camera Info Topic':
                        self.assertEqual(types[topic], 'sensor_msgs/CameraInfo', config)
                    elif display['Class'] in shown_by:
                        self.assertIn(types[topic], shown_by[display['Class']], '{}: {}'.format(config, display['Name']))
        self.assertGreater(count, 5)

    def test_each_class_exists(self):
        known = set(classes(OURS))
        descriptions = list(filter(os.path.exists, RVIZ))
        for description in descriptions:
            known.update(classes(description))
        for config in CONFIGS:
            with open(config) as file:
                content = yaml.safe_load(file)
            manager = content['Visualization Manager']
            named = [each['Class'] for each in manager['Displays'] + manager['Tools'] + [manager['Views']['Current']]]
            for name in named:
                # Where rviz is not installed, its own classes cannot be known.
                if descriptions or name.startswith('tet_line_tracker/'):
                    self.assertIn(name, known, config)

    def test_what_needs_the_plugin_has_markers_beside_it(self):
        for config in CONFIGS:
            shown = [display['Topic'].rsplit('/', 1)[0] for display in displays(config)
                     if display['Class'].startswith('tet_line_tracker/')]
            markers = [display['Marker Topic'] for display in displays(config) if display['Class'].startswith('rviz/Marker')]
            for node in shown:
                self.assertIn(node + '/markers', markers, config)

    def test_each_property_of_our_displays_is_one_that_they_have(self):
        for config in CONFIGS:
            for display in displays(config):
                if not display['Class'].startswith('tet_line_tracker/'):
                    continue
                text = ''
                name = {'LineArray': 'line_array', 'Line3DArray': 'line3d_array'}[display['Class'].split('/')[1]]
                for source in ('line_display.h', name + '_display.cpp'):
                    with open('{}/src/rviz/{}'.format(cases.ROOT, source)) as file:
                        text += file.read()
                for property_name in display:
                    if property_name not in ('Class', 'Name', 'Enabled', 'Value', 'Queue Size', 'Topic', 'Unreliable'):
                        self.assertIn('"{}"'.format(property_name), text, config)

    def test_each_is_opened_by_a_launch_file_or_named_in_the_docs(self):
        text = ''
        for path in glob.glob(cases.ROOT + '/launch/*.launch') + glob.glob(cases.ROOT + '/docs/*.md'):
            with open(path) as file:
                text += file.read()
        for config in CONFIGS:
            name = os.path.basename(config)
            self.assertTrue(name in text or "'{}'".format(name[:-len('.rviz')]) in text, name)

    def test_the_launch_file_opens_one_that_exists_for_each_view(self):
        launch = cases.ROOT + '/launch/rviz.launch'
        for view, frame in (('camera', 'cam7'), ('raw', 'cam7'), ('world', 'map')):
            command = subprocess.run(['roslaunch', '--args', '/line_tracker_rviz', launch, 'view:=' + view, 'fixed_frame:=cam7',
                                      'world_frame:=map', 'tracker:=mine', 'image:=/mine/image', 'camera_info:=/mine/info'], stdout=subprocess.PIPE, check=True).stdout.decode()
            self.assertRegex(command, r' -f {} '.format(frame))
            self.assertTrue(os.path.exists(re.search(r'-d (\S.*?\.rviz)', command).group(1)), command)
            for remapping in ('/line_tracker/lines:=mine/lines', '/camera/image_raw:=/mine/image', '/camera/camera_info:=/mine/info'):
                self.assertIn(remapping, command)

    def test_the_launch_file_names_the_views_that_there_are(self):
        command = subprocess.run(['roslaunch', '--args', '/line_tracker_rviz', cases.ROOT + '/launch/rviz.launch', 'view:=nonsense'],
                                 stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        self.assertNotEqual(command.returncode, 0)
        self.assertIn('view is nonsense, must be camera, raw or world', command.stdout.decode())


def plugin_is_built():
    return any(os.path.exists(prefix + '/lib/libtet_line_tracker_rviz.so') for prefix in os.environ['CMAKE_PREFIX_PATH'].split(':'))


@unittest.skipUnless(shutil.which('Xvfb'), 'Xvfb is not installed')
@unittest.skipUnless(any(map(os.path.exists, RVIZ)), 'rviz is not installed')
class Rviz(unittest.TestCase):
    def open(self, config, *options):
        """A session in which rviz shows the configuration."""
        session = rviz_session.Session()
        self.addCleanup(session.__exit__)
        session.__enter__()
        session.start_rviz(config, *options)
        wanted = {topic for display in displays(config) if display['Enabled'] for topic in topics(display).values()}
        session.wait(lambda: wanted <= session.subscribed_by_rviz(),
                     lambda: 'rviz subscribed to {} of {}, and wrote:\n{}'.format(
                         sorted(session.subscribed_by_rviz()), sorted(wanted), session.messages()), 120)
        return session

    def test_loads_every_display_of_every_configuration(self):
        for config in CONFIGS:
            if not plugin_is_built() and any(each['Class'].startswith('tet_line_tracker/') for each in displays(config)):
                continue
            session = self.open(config)
            self.assertNotRegex(session.messages(), r'(?i)failed to load|could not be loaded|\[ERROR\]', config)

    def test_lays_the_lines_over_the_raw_picture(self):
        if not plugin_is_built():
            self.skipTest('the displays are not built')
        session = self.open(self.altered('raw_picture', {'Line Width': 0.004, 'Trail': 0, 'Frustum': False}), '-f', 'cam0')
        publish = self.publisher(session)
        count = 0

        def offsets():
            """Where the line is in the green band, by columns of the screen: from the upper border, 0, to the lower one, 1."""
            nonlocal count
            count += 1
            publish('picture', str(100 + 0.1 * count), str(count))
            time.sleep(0.5)
            picture = session.picture()
            found = []
            for x in range(picture.width):
                green, blue = (picture.rows_near(x, rgb, above=500) for rgb in ((0, 200, 0), (64, 153, 255)))
                if len(green) > 8 and blue:
                    found.append((sum(blue) / len(blue) - green[0]) / (green[-1] - green[0]))
            return found

        session.wait(lambda: len(offsets()) > 500, 'no line is drawn over the picture')
        found = offsets()
        # Of 13 px: the chord leaves the band, and half a pixel is seen in the mean.
        self.assertTrue(all(0.35 < each < 0.65 for each in found), found)
        self.assertAlmostEqual(sum(found) / len(found), 0.5, delta=0.02)

    def altered(self, name, properties):
        """A copy of a configuration with other values in our displays, which are opaque."""
        with open('{}/rviz/{}.rviz'.format(cases.ROOT, name)) as file:
            content = yaml.safe_load(file)
        for each in content['Visualization Manager']['Displays']:
            if each['Class'].startswith('tet_line_tracker/'):
                each.update({'Alpha': 1}, **properties)
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        path = folder.name + '/altered.rviz'
        with open(path, 'w') as file:
            yaml.safe_dump(content, file)
        return path

    def publisher(self, session):
        """A function that publishes what rviz_publisher.py is told."""
        process = subprocess.Popen([sys.executable, '-B', os.path.join(os.path.dirname(__file__), 'rviz_publisher.py')],
                                   stdin=subprocess.PIPE, env=session.environment, universal_newlines=True)
        self.addCleanup(process.wait)
        self.addCleanup(process.stdin.close)

        def publish(*words):
            process.stdin.write(' '.join(words) + '\n')
            process.stdin.flush()
        return publish

    def test_draws_the_lines_of_the_newest_image_and_nothing_that_is_stale(self):
        if not plugin_is_built():
            self.skipTest('the displays are not built')
        with open(cases.ROOT + '/rviz/world.rviz') as file:
            content = yaml.safe_load(file)
        shown = [each for each in content['Visualization Manager']['Displays'] if each['Class'].startswith('tet_line_tracker/')]
        for each in shown:
            # Enough pixels to count, of the colours below.
            each['Line Width'] = 0.1
            each['Alpha'] = 1
        content['Visualization Manager']['Displays'] = shown
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        with open(folder.name + '/wide.rviz', 'w') as file:
            yaml.safe_dump(content, file)
        session = self.open(folder.name + '/wide.rviz', '-f', 'cam0')
        publish = self.publisher(session)

        def seen(rgb):
            return session.picture().count_near(rgb) > 1000

        def gone(rgb):
            return session.picture().count_near(rgb) < 100  # icons have a few

        young, old, certain = (255, 64, 51), (64, 153, 255), (64, 153, 255)
        self.assertTrue(gone(young) and gone(old))
        publish('lines', '100.0', '1', '1')
        session.wait(lambda: seen(young), 'no young line is drawn')
        publish('lines', '100.1', '2', '100')
        session.wait(lambda: seen(old) and gone(young), 'the old line is not drawn, or the young one remains')
        publish('lines', '100.2', '3')
        session.wait(lambda: gone(old), 'a line remains that is no longer in the image')
        # A bag that starts again.
        publish('lines', '50.0', '1', '1')
        session.wait(lambda: seen(young), 'nothing is drawn after a jump back in time')
        publish('map', '50.0')
        session.wait(lambda: seen(certain), 'no line of the map is drawn')


if __name__ == '__main__':
    cases.run(Configurations, Rviz)
