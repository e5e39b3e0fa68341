#!/usr/bin/env python3
"""Tests of vio_benchmark.sh without PL-VINS: its errors, its edits, its figures.   vio_benchmark_test.py [RESULT.xml]"""
import math
import os
import subprocess
import sys
import tempfile
import unittest

import cases
import numpy
from std_msgs.msg import Header

sys.path.insert(0, os.path.join(cases.ROOT, 'scripts/vio_benchmark'))
import benchmark  # noqa: E402
import estimator  # noqa: E402
import flights  # noqa: E402
import genpy  # noqa: E402
import lines  # noqa: E402
import metrics  # noqa: E402
from sensor_msgs.msg import ChannelFloat32, PointCloud  # noqa: E402
from geometry_msgs.msg import Point32  # noqa: E402

RNG = numpy.random.RandomState(3)


def turn(yaw):
    return metrics.rotation_matrix(0.0, 0.0, math.sin(yaw / 2), math.cos(yaw / 2))


def pose(x, yaw=0.0):
    result = numpy.eye(4)
    result[:3, :3] = turn(yaw)
    result[0, 3] = x
    return result


class Alignment(unittest.TestCase):
    def test_finds_the_scale_the_rotation_and_the_translation_that_were_applied(self):
        estimate = RNG.normal(size=(20, 3))
        rotation = metrics.rotation_matrix(0.3, -0.2, 0.5, 0.7)
        for scale, with_scale in ((1.0, False), (1.7, True)):
            truth = scale * estimate @ rotation.T + [1.0, -2.0, 3.0]
            found = metrics.align(estimate, truth, with_scale)
            self.assertAlmostEqual(found[0], scale, 12)
            numpy.testing.assert_allclose(found[1], rotation, atol=1e-12)
            numpy.testing.assert_allclose(found[2], [1.0, -2.0, 3.0], atol=1e-12)

    def test_is_never_a_reflection(self):
        estimate = RNG.normal(size=(20, 3))
        for truth in (estimate * [1.0, 1.0, -1.0], numpy.column_stack([estimate[:, :2], numpy.zeros(20)])):
            self.assertAlmostEqual(numpy.linalg.det(metrics.align(estimate, truth, True)[1]), 1.0, 12)

    def test_has_the_least_squared_distance_of_all_rotations_nearby(self):
        estimate = RNG.normal(size=(30, 3))
        truth = estimate + RNG.normal(scale=0.1, size=(30, 3))
        scale, rotation, translation = metrics.align(estimate, truth, True)

        def distance(scale, rotation):
            moved = scale * estimate @ rotation.T
            return ((moved - moved.mean(axis=0) - truth + truth.mean(axis=0)) ** 2).sum()
        least = distance(scale, rotation)
        for change in (turn(0.01), turn(-0.01)):
            self.assertGreater(distance(scale, change @ rotation), least)
        self.assertGreater(distance(1.01 * scale, rotation), least)
        self.assertGreater(distance(0.99 * scale, rotation), least)


class Errors(unittest.TestCase):
    def test_absolute_error_of_a_scale_that_is_ten_percent_off_is_seen_by_se3_alone(self):
        truth = numpy.array([[1.0, 0.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, -1.0, 0.0]])
        self.assertAlmostEqual(metrics.absolute_error(1.1 * truth, truth), 0.1, 12)
        self.assertAlmostEqual(metrics.absolute_error(1.1 * truth, truth, with_scale=True), 0.0, 12)

    def test_relative_errors_are_those_of_one_second_and_need_no_alignment(self):
        stamps = numpy.arange(0.0, 3.0, 0.1)
        truth = [pose(stamp) for stamp in stamps]
        elsewhere = pose(5.0, 2.0)
        estimate = [elsewhere @ pose(1.02 * stamp) for stamp in stamps]
        metres, radians = metrics.relative_errors(stamps, estimate, truth, 1.0)
        self.assertAlmostEqual(metres, 0.02, 9)
        self.assertAlmostEqual(radians, 0.0, 9)
        radians = metrics.relative_errors(stamps, [pose(stamp, 0.01 * stamp) for stamp in stamps], truth, 1.0)[1]
        self.assertAlmostEqual(radians, 0.01, 9)

    def test_a_gap_is_no_movement_over_a_second(self):
        stamps = numpy.array([0.0, 0.1, 1.6])
        poses = [pose(stamp) for stamp in stamps]
        self.assertTrue(math.isnan(metrics.relative_errors(stamps, poses, poses, 1.0)[0]))

    def test_quaternions_and_rotation_matrices_agree_up_to_half_a_turn(self):
        for turn_rad in (0.0, 1e-4, 1.0, 3.1, math.pi):
            axis = numpy.array([2.0, -1.0, 2.0]) / 3.0
            words = (*(math.sin(turn_rad / 2.0) * axis), math.cos(turn_rad / 2.0))
            rotation = metrics.rotation_matrix(*words)
            numpy.testing.assert_allclose(metrics.rotation_matrix(*metrics.quaternion(rotation)), rotation, atol=1e-9)

    def test_a_pose_between_two_is_interpolated_and_one_in_a_gap_or_outside_unknown(self):
        stamps, poses = numpy.array([0.0, 0.1, 1.0]), [pose(0.0), pose(1.0, 0.2), pose(2.0)]
        between = metrics.pose_at(stamps, poses, 0.025)
        numpy.testing.assert_allclose(between, pose(0.25, 0.05), atol=1e-12)
        for stamp in (0.5, -0.1, 1.1):
            self.assertIsNone(metrics.pose_at(stamps, poses, stamp))


class FakeFlight:
    """Along x at 1 m/s."""

    def true_pose(self, stamp):
        return pose(stamp)


class Judging(unittest.TestCase):
    stamps = [0.1 * k for k in range(100)]

    def judge(self, poses):
        factors = [(9, 9)] * (len(poses) - 50) + [(120, 30)] * 50
        return estimator.judge(FakeFlight(), self.stamps, poses, factors, [60] * 100)

    def test_a_run_that_answers_each_message_and_starts_in_time_is_good(self):
        result = self.judge([(stamp, pose(stamp)) for stamp in self.stamps[12:]])
        self.assertTrue(result.is_good())
        self.assertAlmostEqual(result.started, 1.2)
        self.assertLess(result.ate_se3, 1e-9)
        self.assertEqual((result.line_factors, result.lines), (120, 60))

    def test_a_message_without_a_pose_is_told(self):
        poses = [(stamp, pose(stamp)) for stamp in self.stamps[12:]]
        result = self.judge(poses[:60] + poses[61:])
        self.assertEqual(result.unsolved, 1)
        self.assertFalse(result.is_good())

    def test_an_estimator_that_never_starts_or_late_is_told(self):
        self.assertFalse(self.judge([]).is_good())
        self.assertFalse(self.judge([(stamp, pose(stamp)) for stamp in self.stamps[60:]]).is_good())

    def test_of_a_short_recording_the_second_half_counts(self):
        self.stamps = self.stamps[:40]
        wrong = [(stamp, pose(stamp if stamp >= 1.95 - 1e-9 else -stamp)) for stamp in self.stamps]
        result = estimator.judge(FakeFlight(), self.stamps, wrong, [(1, 1)] * 40, [60] * 40)
        self.assertLess(result.ate_se3, 1e-9)
        self.assertTrue(result.is_good())

    def test_what_was_before_the_points_became_few_does_not_count(self):
        wrong = [(stamp, pose(stamp if stamp >= estimator.SETTLE - 1e-9 else -stamp)) for stamp in self.stamps]
        self.assertLess(self.judge(wrong).ate_se3, 1e-9)


def points(stamp, ids):
    return PointCloud(header=Header(stamp=genpy.Time.from_sec(stamp)), points=[Point32(0.1 * each, 0.0, 1.0) for each in ids],
                      channels=[ChannelFloat32(values=[float(each) for each in ids]) for _ in range(3)])


class Thinning(unittest.TestCase):
    def ids(self, message):
        self.assertEqual([round(10 * point.x) for point in message.points], [int(v) for v in message.channels[0].values])
        return [int(value) for value in message.channels[2].values]

    def test_passes_on_all_until_the_stamp_then_the_oldest(self):
        thinner = lines.PointThinner(2, 5.0)
        self.assertEqual(self.ids(thinner.thin(points(4.9, [7, 3, 5, 1]))), [7, 3, 5, 1])
        self.assertEqual(self.ids(thinner.thin(points(5.0, [7, 3, 5, 1]))), [3, 1])

    def test_an_id_that_was_left_out_never_returns(self):
        thinner = lines.PointThinner(2, 5.0)
        thinner.thin(points(5.0, [1, 3, 5]))
        self.assertEqual(self.ids(thinner.thin(points(5.1, [3, 5]))), [3])
        self.assertEqual(self.ids(thinner.thin(points(5.2, [3, 5, 9]))), [3, 9])

    def test_zero_keeps_all(self):
        self.assertEqual(len(lines.PointThinner(0, 0.0).thin(points(5.0, [1, 3, 5])).points), 3)


class Losses(unittest.TestCase):
    def test_every_second_image_of_20_hz_is_published(self):
        stamps = [100.0 + 0.05 * k for k in range(41)]
        numpy.testing.assert_allclose(lines.published(stamps), stamps[2::2])

    def test_after_lost_images_more_are_published_until_the_rate_is_right(self):
        stamps = [100.0 + 0.05 * k for k in range(41) if k not in (10, 11, 12)]
        chosen = lines.published(stamps)
        self.assertEqual(len(chosen), 20)
        self.assertAlmostEqual(chosen[4], 100.65)  # the first after the gap
        self.assertAlmostEqual(chosen[5], 100.7)   # and the next at once

    def test_messages_that_are_missing_are_counted_by_topic(self):
        messages = {lines.POINTS: [points(1.0, []), points(2.0, [])], lines.OWN: [points(1.0, [])], lines.OURS: []}
        self.assertEqual(lines.missing(messages, [1.0, 2.0]), {lines.POINTS: 0, lines.OWN: 1, lines.OURS: 2})


class Tables(unittest.TestCase):
    def results(self, none, own, ours, perfect, factors):
        good = {'started': 1.0}  # and solved each message
        return {'none': [estimator.Result(ate_se3=none, **good)], 'own': [estimator.Result(ate_se3=own, line_factors=100, **good)],
                'tet': [estimator.Result(ate_se3=ours, line_factors=factors, **good)],
                'perfect': [estimator.Result(ate_se3=perfect, **good)]}

    def test_the_verdict_says_of_each_demand_whether_it_is_met(self):
        def answers(*values, cpu=(10.0, 1.0)):
            return list(benchmark.verdict(self.results(*values), {'own': [cpu[0]], 'tet': [cpu[1]]}).values())
        self.assertEqual(answers(0.3, 0.25, 0.2, 0.1, 200), [True, True, True, True])
        self.assertEqual(answers(0.3, 0.25, 0.21, 0.1, 200), [False, True, True, True])
        self.assertEqual(answers(0.3, 0.15, 0.2, 0.1, 199), [True, False, False, True])
        self.assertEqual(answers(0.3, 0.25, 0.2, 0.1, 200, cpu=(10.0, 1.1)), [True, True, True, False])

    def test_runs_that_are_not_good_are_told_and_left_out(self):
        results = self.results(0.3, 0.25, 0.2, 0.1, 200)
        results['tet'].append(estimator.Result(ate_se3=9.0, unsolved=3, started=1.0))
        text = benchmark.table(flights.CASES[0], results, {'own': [10.0], 'tet': [1.0]})
        self.assertIn('| ours (1 of 2 runs lost) | 0.200 |', text)


class Script(unittest.TestCase):
    def run_script(self, *words):
        done = subprocess.run([cases.ROOT + '/scripts/vio_benchmark.sh', *words], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT)
        return done.returncode, done.stdout.decode()

    def checkout(self, folder, files):
        for name in files:
            path = os.path.join(folder, name)
            os.makedirs(os.path.dirname(path), exist_ok=True)
            with open(path, 'w') as file:
                file.write('cvtColor(a, b, CV_GRAY2RGB); ofstream f("/somewhere/out.txt");\n')

    ALL = ['camera_model/src/a.cc', 'feature_tracker/src/linefeature_tracker_node.cpp', 'vins_estimator/src/estimator_node.cpp']

    def test_help_names_every_case(self):
        status, output = self.run_script('--help')
        self.assertEqual(status, 0)
        for case in flights.CASES:
            self.assertIn(case.name, output)

    def test_each_mistake_is_told_in_one_sentence_and_leaves_nothing(self):
        with tempfile.TemporaryDirectory() as folder:
            results = folder + '/results'
            self.checkout(folder + '/pl_vins', self.ALL)
            self.checkout(folder + '/vins_mono', [name for name in self.ALL if 'line' not in name] + ['feature_tracker/src/a.cpp'])
            for words, sentence in (
                    ([], 'needs PL_VINS_CHECKOUT and RESULTS'),
                    ([folder + '/nowhere', results], 'there is no folder ' + folder + '/nowhere'),
                    ([folder, results], 'is no checkout of PL-VINS: it has no folder camera_model/src'),
                    ([folder + '/vins_mono', results], 'linefeature_tracker_node.cpp or estimator_node.cpp is missing'),
                    ([folder + '/pl_vins', results, 'rooms'], 'there is no case, bag or EuRoC folder'),
                    ([folder + '/pl_vins', results, '--seeds', '7'], 'seed 7 is for --tuning'),
                    ([folder + '/pl_vins', results, '--tuning', '--seeds', '1001'], 'seed 1001 is kept for tables'),
                    ([folder + '/pl_vins', results, '--seeds'], '--seeds needs a value'),
                    ([folder + '/pl_vins', results, '--fast'], 'unknown option --fast')):
                status, output = self.run_script(*words)
                self.assertEqual(status, 1, output)
                self.assertIn(sentence, output)
                self.assertEqual(output.count('\n'), 1, output)
                self.assertFalse(os.path.exists(results))

    def test_edits_a_copy_and_never_the_checkout(self):
        with tempfile.TemporaryDirectory() as folder:
            self.checkout(folder + '/pl_vins', self.ALL)
            before = subprocess.check_output(['sh', '-c', 'find {} -type f | sort | xargs sha256sum'.format(folder + '/pl_vins')])
            subprocess.run(['bash', '-c', '. scripts/vio_benchmark/port.sh; copySources {0}/pl_vins {0}/copy'.format(folder)],
                           cwd=cases.ROOT, check=True)
            after = subprocess.check_output(['sh', '-c', 'find {} -type f | sort | xargs sha256sum'.format(folder + '/pl_vins')])
            self.assertEqual(before, after)
            with open(folder + '/copy/vins_estimator/src/estimator_node.cpp') as file:
                self.assertEqual(file.read(), 'cvtColor(a, b, cv::COLOR_GRAY2RGB); ofstream f("/dev/null");\n')

    def test_the_stamp_of_the_build_changes_with_the_checkout(self):
        def stamp(folder):
            return subprocess.check_output(['bash', '-c', '. scripts/vio_benchmark/port.sh; stampOf ' + folder], cwd=cases.ROOT)
        with tempfile.TemporaryDirectory() as folder:
            self.checkout(folder, self.ALL)
            first = stamp(folder)
            self.assertEqual(stamp(folder), first)
            with open(os.path.join(folder, self.ALL[0]), 'a') as file:
                file.write('// more\n')
            self.assertNotEqual(stamp(folder), first)


if __name__ == '__main__':
    cases.run(Alignment, Errors, Judging, Thinning, Losses, Tables, Script)
