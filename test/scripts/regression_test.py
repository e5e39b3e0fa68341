#!/usr/bin/env python3
"""Tests of the comparison of two versions on recorded sequences.   regression_test.py [RESULT.xml]"""
import os
import subprocess
import tempfile
import unittest

import cases
import check_regression

BASELINE = os.path.join(cases.ROOT, 'test/regression/real.csv')
DATA = os.environ.get('TET_SHARED_DATA', os.path.join(cases.ROOT, '../shared/data'))
EXTRACTS = {'euroc_v1_01': ('euroc', 'euroc_v1_01/mav0'), 'icl_nuim_of_kt0': ('icl_nuim', 'icl_nuim_of_kt0')}


def tool(name, *arguments):
    return subprocess.check_output(['rosrun', 'tet_line_tracker', name] + list(arguments), stdin=subprocess.DEVNULL,
                                   stderr=subprocess.STDOUT)


class Comparison(unittest.TestCase):
    def setUp(self):
        self.measures = check_regression.read(BASELINE)
        self.changed = {name: dict(values) for name, values in self.measures.items()}

    def worse(self):
        return check_regression.compare(self.measures, self.changed)[1]

    def test_a_version_is_not_worse_than_itself(self):
        self.assertEqual(self.worse(), 0)

    def test_each_measure_is_caught_beyond_its_tolerance_and_not_within(self):
        for measure in check_regression.MEASURES:
            old = self.measures['icl_nuim_of_kt0'][measure.name]
            sign = -1.0 if measure.larger_is_better else 1.0
            for factor, expected in ((1.01, 1), (0.99, 0)):
                self.changed['icl_nuim_of_kt0'][measure.name] = old + sign * factor * measure.slack(old)
                self.assertEqual(self.worse(), expected, measure.name)
            self.changed['icl_nuim_of_kt0'][measure.name] = old

    def test_what_is_better_never_fails(self):
        for measure in check_regression.MEASURES:
            old = self.measures['icl_nuim_of_kt0'][measure.name]
            self.changed['icl_nuim_of_kt0'][measure.name] = old * (1.5 if measure.larger_is_better else 0.5)
        self.assertEqual(self.worse(), 0)

    def test_a_sequence_or_a_measure_that_is_gone_is_worse(self):
        self.changed['kitti_00']['three_view_ratio_2px'] = None
        self.assertEqual(self.worse(), 1)
        del self.changed['euroc_v1_01']
        self.assertEqual(self.worse(), 2)

    def test_a_baseline_that_was_written_is_read_again(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, 'new.csv')
            check_regression.write(path, self.measures)
            self.assertEqual(check_regression.read(path), self.measures)

    def test_a_file_that_is_missing_or_empty_is_told_in_a_sentence(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, 'empty.csv')
            open(path, 'w').close()
            for name, words in ((path, 'holds no sequence'), (path + 'x', 'cannot be read')):
                done = subprocess.run([os.path.join(cases.ROOT, 'scripts/check_regression.py'), BASELINE, name],
                                      stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
                self.assertEqual(done.returncode, 1)
                self.assertIn(words, done.stdout.decode())


class Recorded(unittest.TestCase):
    """The tracker as it is against test/regression/real.csv, on the extracts."""

    def measure(self, *parameters):
        """Lines of the table, and how many measures are worse."""
        missing = [folder for _, folder in EXTRACTS.values() if not os.path.exists(os.path.join(DATA, folder))]
        if missing:
            self.skipTest('needs {} in {}'.format(' and '.join(missing), DATA))
        with tempfile.TemporaryDirectory() as folder:
            tracked = []
            for name, (form, source) in EXTRACTS.items():
                sequence = os.path.join(folder, name + '.bag')
                tracked.append(os.path.join(folder, name + '-tet.bag'))
                tool('dataset_to_bag', form, os.path.join(DATA, source), sequence)
                tool('track_bag', sequence, tracked[-1], *parameters)
            table = os.path.join(folder, 'tet.csv')
            tool('evaluate_tracks', '--csv', table, *tracked)
            new = check_regression.read(table)
        baseline = {name: values for name, values in check_regression.read(BASELINE).items() if name in EXTRACTS}
        return check_regression.compare(baseline, new)

    def test_tracks_of_recorded_images_are_no_worse_than_the_baseline(self):
        lines, worse = self.measure()
        self.assertEqual(worse, 0, '\n'.join(lines))

    def test_a_threshold_that_was_made_worse_on_purpose_is_caught(self):
        lines, worse = self.measure('--set', 'max_edge_offset=0.2')
        self.assertGreater(worse, 0, '\n'.join(lines))


if __name__ == '__main__':
    cases.run(Comparison, Recorded)
