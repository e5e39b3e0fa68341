#!/usr/bin/env python3
"""Tests of scripts/rooms.py, by which lint.py judges the project.   rooms_test.py [RESULT.xml]"""
import unittest

import cases
import rooms


def small_project():
    """Sources of three rooms that keep the rules."""
    return {
        'CMakeLists.txt': 'find_package(catkin REQUIRED COMPONENTS\n  cv_bridge roscpp)\n',
        rooms.DRAWING: '# Architecture\n\n## Rooms of the core\n\nText.\n\n```\n'
                       'src/ros     -> src/core ROS\nsrc/core\n  tracking  -> geometry\n  geometry\n```\n',
        rooms.CORE: 'tet_room(geometry\n  SOURCES line\n  TESTS line grid)\n'
                    'tet_room(tracking\n  SOURCES tracker\n  TESTS tracker)\n',
        'include/tet_line_tracker/geometry/line.h': '#pragma once\n#include <vector>\n',
        'src/core/geometry/line.cpp': '#include "tet_line_tracker/geometry/line.h"\n#include "geometry/grid.h"\n',
        'src/core/geometry/grid.h': '#pragma once\n',
        'src/core/tracking/tracker.cpp': '#include "tet_line_tracker/geometry/line.h"\n',
        'src/ros/node.cpp': '#include <ros/ros.h>\n#include "tet_line_tracker/geometry/line.h"\n',
    }


class Rooms(unittest.TestCase):
    def setUp(self):
        self.files = small_project()

    def complaint(self):
        found = rooms.complaints(self.files)
        self.assertEqual(len(found), 1, found)
        return found[0]

    def test_a_project_that_keeps_the_rules_has_no_complaints(self):
        self.assertEqual(rooms.complaints(self.files), [])

    def test_an_include_of_a_room_above_is_refused(self):
        for line in ('#include "tracking/tracker.h"', '#include "tet_line_tracker/tracking/tracker.h"',
                     '  #  include "../tracking/tracker.h"'):
            self.files = small_project()
            self.files['src/core/tracking/tracker.h'] = ''
            self.files['include/tet_line_tracker/tracking/tracker.h'] = ''
            self.files['src/core/geometry/line.cpp'] += line + '\n'
            self.assertIn('src/core/geometry/line.cpp:3: geometry may not use tracking', self.complaint())

    def test_a_public_header_of_a_room_above_is_refused(self):
        self.files['include/tet_line_tracker/tracking/tracker.h'] = ''
        self.files['include/tet_line_tracker/geometry/line.h'] += '#include "tet_line_tracker/tracking/tracker.h"\n'
        self.assertIn('include/tet_line_tracker/geometry/line.h:3: geometry may not use tracking', self.complaint())

    def test_the_core_may_not_use_the_folders_that_use_it(self):
        self.files['src/ros/messages.h'] = ''
        for included in ('ros/messages.h', '../../ros/messages.h'):
            self.files['src/core/tracking/tracker.cpp'] = '#include "geometry/grid.h"\n#include "{}"\n'.format(included)
            self.assertIn('tracking may not use src/ros', self.complaint())

    def test_ros_headers_and_messages_stay_where_ros_is_known(self):
        for included in ('<ros/ros.h>', '<sensor_msgs/Image.h>', '<cv_bridge/cv_bridge.h>',
                         '"tet_line_tracker/LineArray.h"'):
            self.files = small_project()
            self.files['src/core/tracking/tracker.cpp'] += '#include {}\n'.format(included)
            self.assertIn('tracking may not use ROS', self.complaint())
            self.files['src/ros/node.cpp'] += self.files['src/core/tracking/tracker.cpp']
            self.files['src/core/tracking/tracker.cpp'] = small_project()['src/core/tracking/tracker.cpp']
            self.assertEqual(rooms.complaints(self.files), [])

    def test_a_row_of_the_drawing_that_is_no_longer_true_is_refused(self):
        self.files['src/core/tracking/tracker.cpp'] = ''
        self.assertIn('tracking does not use geometry', self.complaint())

    def test_a_row_that_allows_a_room_above_is_refused(self):
        self.files[rooms.DRAWING] = self.files[rooms.DRAWING].replace('  geometry\n', '  geometry  -> tracking\n')
        self.files['src/core/tracking/tracker.h'] = ''
        self.files['src/core/geometry/grid.h'] += '#include "tracking/tracker.h"\n'
        self.assertIn('geometry uses tracking, which is not below it', self.complaint())

    def test_a_room_that_is_not_drawn_is_refused(self):
        self.files['src/core/flow/flow.cpp'] = ''
        self.assertIn('the room flow is not in the drawing', self.complaint())

    def test_cmake_must_register_the_rooms_in_the_order_of_the_drawing(self):
        first, second = self.files[rooms.CORE].split('tet_room(tracking')
        self.files[rooms.CORE] = 'tet_room(tracking' + second + first
        self.assertIn('registers, from the top, geometry tracking', self.complaint())

    def test_long_files_of_the_core_are_refused(self):
        self.files['src/core/tracking/tracker.cpp'] += '\n' * 399
        self.assertEqual(rooms.complaints(self.files), [])
        self.files['src/core/tracking/tracker.cpp'] += '\n'
        self.assertIn('has 401 lines, more than 400', self.complaint())

    def test_the_line_tracker_stays_under_250_lines(self):
        self.files['src/core/tracking/line_tracker.cpp'] = '\n' * 249
        self.assertEqual(rooms.complaints(self.files), [])
        self.files['src/core/tracking/line_tracker.cpp'] += '\n'
        self.assertIn('has 250 lines, more than 249', self.complaint())

    def test_only_the_factory_asks_for_the_name_of_a_method(self):
        for line in ('if (name == "paper") return;', 'const bool joint = parameters.method != other;'):
            self.files = small_project()
            self.files['src/core/tracking/tracking_method.cpp'] = line + '\n'
            self.files['src/ros/node.cpp'] += '("method", value<std::string>()->default_value("joint"))\n'
            self.assertEqual(rooms.complaints(self.files), [])
            self.files['src/core/tracking/tracker.cpp'] += line + '\n'
            self.assertIn('asks for the name of a method', self.complaint())

    def test_the_tests_of_a_room_are_those_that_cmake_registers(self):
        self.assertEqual(list(rooms.core_tests(self.files[rooms.CORE]).items()),
                         [('geometry', ['line', 'grid']), ('tracking', ['tracker'])])


if __name__ == '__main__':
    cases.run(Rooms)
