#!/usr/bin/env python3
"""Tests of scripts/check_docs.py.   check_docs_test.py [RESULT.xml]"""
import contextlib
import io
import os
import tempfile
import unittest

import cases
import check_docs

PAGE = """\
    roslaunch tet_line_tracker line_tracker.launch image:=/camera/image_raw \\
        manager:=there

```cpp
rosrun is(no, command);
```
```
rosrun tet_line_tracker list_parameters
image -> FrameSequence
```
"""


class Commands(unittest.TestCase):
    def test_are_those_of_blocks_without_a_language_with_their_lines_joined(self):
        self.assertEqual(list(check_docs.blocks(PAGE)),
                         ['roslaunch tet_line_tracker line_tracker.launch image:=/camera/image_raw manager:=there',
                          'rosrun tet_line_tracker list_parameters', 'image -> FrameSequence'])

    def test_of_the_pages_are_found(self):
        found = [command.text for page in check_docs.pages() for command in check_docs.commands(page, True)]
        self.assertGreater(len(found), 40)
        self.assertIn('scripts/demo.sh', found)
        self.assertIn('rosrun dynamic_reconfigure dynparam set /line_tracker min_length 40', found)

    def test_that_run_all_tests_are_left_out_as_one_of_them_starts_this_script(self):
        found = {command.text.split()[0]: command.left_out for command in check_docs.commands('CONTRIBUTING.md', True)}
        for script in ('test.sh', 'test_core.sh', 'test_arm64.sh', 'test_install.sh', 'test_distributions.sh', 'mutate.sh',
                       'coverage.sh'):
            self.assertEqual(found['scripts/' + script], 'is a run of tests of its own')

    def test_that_need_the_source_folder_are_left_out_without_a_clone(self):
        left_out = {command.text: command.left_out for command in check_docs.commands('README.md', False)}
        self.assertEqual(left_out['scripts/demo.sh'], 'only with --clone')
        self.assertIsNone(left_out['rosrun tet_line_tracker evaluate_tracks tracks.bag'])


class Errors(unittest.TestCase):
    def test_of_others_are_not_ours(self):
        def said(text):
            return check_docs.ERRORS.search(check_docs.HARMLESS.sub('', text)) is not None
        self.assertFalse(said('\x1b[31mERROR: cannot launch node of type [rviz/rviz]: rviz\n'))
        self.assertTrue(said('ERROR: cannot launch node of type [nodelet/nodelet]: nodelet\n'))
        traceback = 'Traceback (most recent call last):\n  File "pmon.py", line 116, in shutdown_process_monitor\n    if x:\n'
        self.assertFalse(said(traceback + "AttributeError: 'ProcessMonitor' object has no attribute 'isAlive'\n"))
        self.assertFalse(said(traceback + "AttributeError: 'Thread' object has no attribute 'isAlive'\n"))
        self.assertTrue(said(traceback + "AttributeError: 'Tracker' object has no attribute 'lines'\n"))


class Attempt(unittest.TestCase):
    def attempt(self, *texts):
        """What is said of these commands, and how many failed."""
        said = io.StringIO()
        with tempfile.TemporaryDirectory() as folder, contextlib.redirect_stdout(said):
            workplace = check_docs.Workplace(os.path.join(folder, 'docs'), False)
            counts = check_docs.run_all(workplace, [check_docs.Command('page.md', text, None) for text in texts])
        return said.getvalue(), counts['FAILED']

    def test_a_command_that_ends_with_an_error_fails(self):
        said, failed = self.attempt('rosrun tet_line_tracker list_parameters', 'rosrun tet_line_tracker no_such_tool')
        self.assertEqual(failed, 1, said)
        self.assertRegex(said, r'ran +page.md: rosrun tet_line_tracker list_parameters\n')
        self.assertRegex(said, r'FAILED +page.md: rosrun tet_line_tracker no_such_tool  \(ended with \d+: ')

    def test_a_command_that_fails_by_the_mistake_of_debian_11_does_not(self):
        said, failed = self.attempt('echo "!!python/object/new:dynamic_reconfigure"; exit 3', 'echo "!!python/object"; exit 3')
        self.assertEqual(failed, 1, said)
        self.assertRegex(said, r'FAILED +page.md: echo "!!python/object"; exit 3  \(ended with 3: ')

    def test_a_launch_file_must_start_and_say_no_error(self):
        check_docs.STAYS_SECONDS = 8
        said, failed = self.attempt('roslaunch tet_line_tracker line_tracker.launch',
                                    'roslaunch tet_line_tracker line_tracker.launch image_transport:=unheard_of')
        self.assertEqual(failed, 1, said)
        self.assertRegex(said, r'ran +page.md: roslaunch tet_line_tracker line_tracker.launch\n')


if __name__ == '__main__':
    cases.run(Commands, Errors, Attempt)
