#!/usr/bin/env python3
"""Tests of the scripts that measure, and of the tables that they print.   measuring_test.py [RESULT.xml]"""
import glob
import os
import stat
import subprocess
import tempfile
import unittest

import cases
import compare_speed
import distractors_table
import measures_table
import methods_table
import prior_table


def shell(command, folder=cases.ROOT):
    """Exit status and output of a bash command line."""
    done = subprocess.run(['bash', '-c', command], cwd=folder, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT)
    return done.returncode, done.stdout.decode()


def measuring_scripts():
    """Those of simulated flights."""
    paths = glob.glob(cases.ROOT + '/scripts/measure_*.sh')
    return sorted(os.path.relpath(path, cases.ROOT) for path in paths if not path.endswith('/measure_real.sh'))


class Seeds(unittest.TestCase):
    """Those below 1000 are for tuning, tables in docs are of those from 1000 on."""

    def test_every_measuring_script_refuses_to_make_tables_of_tuning_seeds(self):
        # measure_all.sh names its seeds itself, and takes none.
        for script in [name for name in measuring_scripts() if 'measure_all' not in name]:
            with tempfile.TemporaryDirectory() as folder:
                status, output = shell('{} {}/results 7'.format(script, folder))
                self.assertEqual(status, 1, output)
                self.assertIn('seed 7 is for --tuning', output)
                self.assertEqual(os.listdir(folder), [])

    def test_every_measuring_script_refuses_to_tune_on_the_seeds_of_tables(self):
        for script in [name for name in measuring_scripts() if 'measure_all' not in name]:
            status, output = shell('{} results --tuning 1001'.format(script))
            self.assertEqual(status, 1, output)
            self.assertIn('seed 1001 is kept for tables in docs', output)
        status, output = shell('scripts/measure_all.sh results --tuning')
        self.assertEqual(status, 1, output)

    def test_only_one_function_renders_flights_and_it_asks_for_the_seed(self):
        for script in measuring_scripts():
            with open(os.path.join(cases.ROOT, script)) as file:
                self.assertNotIn('/simulate_bag"', file.read(), script)
        status, output = shell('. scripts/measuring.sh results; simulate flight.bag 7')
        self.assertEqual(status, 1, output)
        self.assertIn('seed 7 is for --tuning', output)

    def test_reproduce_paper_refuses_tuning_seeds(self):
        status, output = shell('python3 scripts/reproduce_paper results --simulate 2 --seed 999')
        self.assertEqual(status, 2, output)
        self.assertIn('seed 999 is for tuning', output)

    def test_what_is_no_seed_is_refused(self):
        for seed in ('-1', '1.5', 'two', '99999999999999999999'):
            status, output = shell(". scripts/measuring.sh results; requireSeeds '{}'".format(seed))
            self.assertEqual(status, 1, output)
            self.assertIn('is no seed', output)

    def test_tables_of_tuning_say_so_and_others_do_not(self):
        self.assertEqual(shell('. scripts/measuring.sh results; heading joint'), (0, '== joint\n'))
        self.assertEqual(shell('. scripts/measuring.sh results --tuning; heading joint'),
                         (0, '== joint\nTUNING: seeds below 1000, not for docs\n'))


class Flights(unittest.TestCase):
    def test_a_flight_is_rendered_once_and_not_taken_for_one_of_other_options(self):
        with tempfile.TemporaryDirectory() as folder:
            program = os.path.join(folder, 'simulate_bag')
            with open(program, 'w') as file:
                file.write('#!/bin/sh\necho rendered; touch "$1"\n')
            os.chmod(program, stat.S_IRWXU)
            call = '. scripts/measuring.sh {0}; tools={0}; simulate {0}/flight.bag 1001 --seconds '.format(folder)
            self.assertEqual(shell(call + '2'), (0, 'rendered\n'))
            self.assertEqual(shell(call + '2'), (0, ''))
            status, output = shell(call + '3')
            self.assertEqual(status, 1)
            self.assertIn('was made with --seed 1001 --seconds 2, not --seed 1001 --seconds 3', output)

    def test_results_are_beside_the_caller_not_beside_the_scripts(self):
        with tempfile.TemporaryDirectory() as folder:
            status, output = shell('. {}/scripts/measuring.sh there; echo "$results"'.format(cases.ROOT), folder)
            self.assertEqual((status, output), (0, os.path.realpath(folder) + '/there\n'))


PRIORS = {
    'image': {'slow': {'track_length': [20.0, 10.0], 'survival': [0.8, 0.6], 'inlier_ratio_2px': [1.0, 1.0],
                       'inlier_ratio_1px': [0.99, 0.98]}},
    'auto': {'slow': {'track_length': [22.0, 9.0], 'survival': [0.9, None], 'inlier_ratio_2px': [None, None],
                      'inlier_ratio_1px': [0.99, 0.99]}}}


class PriorTable(unittest.TestCase):
    def test_rows_are_means_over_the_seeds_of_a_flight(self):
        self.assertEqual(prior_table.table(PRIORS)[2:],
                         ['| slow | image | 15.0 | 70.0 | 100.00 | 98.50 |',
                          '| slow | auto | 15.5 | 90.0 | - | 99.00 |'])

    def test_compares_each_flight_with_itself(self):
        self.assertEqual(prior_table.comparison(PRIORS)[2:], ['| slow | 2 | 1.000 ± 0.100 | 10.0 |'])

    def test_seeds_are_read_from_the_names_of_bags(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, 'imu.csv')
            with open(path, 'w') as file:
                file.write('bag,truth,track_length,survival,inlier_ratio_2px,inlier_ratio_1px\n'
                           'slow-1001,scene,20,0.8,1,1\nslow-1002,scene,10,nan,1,1\neuroc_v1_01,none,30,,,\n')
            read = prior_table.read(path)
        self.assertEqual(read['slow']['track_length'], [20.0, 10.0])
        self.assertEqual(read['slow']['survival'], [0.8, None])
        self.assertEqual(read['euroc_v1_01']['track_length'], [30.0])


PRINTED = """201 images, 142.0 lines per image, 392 tracks of 72.8 images on average
ms                mean    median       p99       max
pyramid          0.100     0.042    28.170    41.110
flow             0.300     0.981    39.178    76.531
refine           0.000     0.000     0.000     0.000
total            0.500     0.400    41.640   205.255
"""


class MeasuresTable(unittest.TestCase):
    COLUMN = measures_table.Column('under 2 px [%]', 'inlier_ratio_2px', '{:.1f}', 100.0)

    def test_a_cell_is_the_mean_over_the_rows_that_have_the_measure(self):
        rows = [{'inlier_ratio_2px': value} for value in ('0.5', '', '1.0')]
        self.assertEqual(measures_table.cells(rows, [self.COLUMN]), ['75.0'])

    def test_what_no_row_has_is_a_dash(self):
        self.assertEqual(measures_table.cells([{'inlier_ratio_2px': ''}], [self.COLUMN]), ['-'])


class DistractorsTable(unittest.TestCase):
    def test_has_a_row_for_each_kind_of_surface_that_has_tracks(self):
        row = {'surface_{}_{}'.format(surface, measure): ''
               for surface in distractors_table.SURFACES for measure in ('line_share', 'track_length', 'inlier_ratio_2px')}
        row.update({'surface_{}_tracks'.format(surface): '0' for surface in distractors_table.SURFACES})
        row.update(surface_solid_tracks='90', surface_solid_line_share='0.9', surface_solid_track_length='12.34',
                   surface_solid_inlier_ratio_2px='0.9999', surface_mirror_tracks='10', surface_mirror_line_share='0.1',
                   surface_mirror_track_length='5')
        self.assertEqual(distractors_table.rows_by_surface({('slow', 'glossy_floor'): [row]}),
                         [['slow', 'glossy floor', 'solid', '90.0', '90', '12.3', '99.99'],
                          ['slow', 'glossy floor', 'mirror', '10.0', '10', '5.0', '-']])


class MethodsTable(unittest.TestCase):
    MEASURES = {'lines_per_image': '120', 'inlier_ratio_2px': '0.99', 'inlier_ratio_1px': '0.98', 'track_length': '7.5',
                'line_length_px': '66', 'absolute_all_worse_end_median_px': '0.1', 'absolute_all_worse_end_p90_px': '0.4',
                'three_view_ratio_2px': '0.9', 'three_view_ratio_1px': '0.8'}
    RECORDED = dict(MEASURES, inlier_ratio_2px='', inlier_ratio_1px='', absolute_all_worse_end_median_px='',
                    absolute_all_worse_end_p90_px='')

    def test_a_row_ends_with_the_processor_time_that_track_bag_printed(self):
        self.assertEqual(methods_table.row_of(self.MEASURES, PRINTED + 'processor        1.234     1.000     2.000     3.000\n'),
                         ['120', '99.00', '98.00', '7.5', '66', '0.10', '0.40', '1.23'])

    def test_where_no_scene_is_known_three_views_judge_and_nothing_absolute_is_said(self):
        self.assertEqual(methods_table.row_of(self.RECORDED, PRINTED), ['120', '90.00', '80.00', '7.5', '66', '-', '-', '-'])


class CompareSpeed(unittest.TestCase):
    def test_reads_what_track_bag_prints(self):
        run = compare_speed.parse(PRINTED, 1.5)
        self.assertEqual(run.lines, 142.0)
        self.assertEqual(run.times['total'], {'mean': 0.5, 'median': 0.4, 'p99': 41.64, 'max': 205.255})
        self.assertNotIn('detect', run.times)
        with self.assertRaises(compare_speed.Failure):
            compare_speed.parse('track_bag: no images', 1.5)

    def test_the_ratio_is_new_over_old_pair_by_pair_so_that_a_slow_minute_does_not_count(self):
        pairs = []
        for slowness in (1.0, 1.0, 5.0, 2.0, 1.0):
            old, new = (compare_speed.parse(PRINTED, slowness * cpu_s) for cpu_s in (1.0, 1.1))
            pairs.append((old, new))
        self.assertEqual(compare_speed.ratio(pairs, lambda run: run.cpu_s), '1.100 (1.100 to 1.100)')
        self.assertEqual(compare_speed.ratio(pairs, lambda run: run.times['refine']['mean']), '-')

    def test_more_lines_do_not_count_as_slower_per_line(self):
        old = compare_speed.parse(PRINTED, 1.0)
        new = compare_speed.parse(PRINTED.replace('142.0', '284.0').replace('0.400', '0.800'), 1.0)
        rows = compare_speed.report('flight', [(old, new)])
        self.assertIn('| flight | median | 2.000 |', rows)
        self.assertIn('| flight | median, per line | 1.000 |', rows)

    def test_benchmark_refuses_what_is_no_build_or_no_number(self):
        for arguments, complaint in (('--compare scripts', 'is no build of this package'), ('--compare', 'needs a value'),
                                     ('--unheard-of', 'unknown option --unheard-of')):
            status, output = shell('scripts/benchmark.sh ' + arguments)
            self.assertEqual(status, 1, output)
            self.assertIn(complaint, output)


class MeasureAll(unittest.TestCase):
    def test_refuses_steps_that_it_does_not_know_and_results_of_another_version(self):
        with tempfile.TemporaryDirectory() as folder:
            status, output = shell('scripts/measure_all.sh {} unheard_of'.format(folder))
            self.assertEqual(status, 1, output)
            self.assertIn('there is no step unheard_of', output)
            with open(os.path.join(folder, 'version'), 'w') as file:
                file.write('another\n')
            status, output = shell('scripts/measure_all.sh ' + folder)
            self.assertEqual(status, 1, output)
            self.assertIn('has results of another, this is', output)

    def test_every_measuring_script_and_every_page_of_figures_is_a_step(self):
        with open(os.path.join(cases.ROOT, 'scripts/measure_all.sh')) as file:
            content = file.read()
        for script in measuring_scripts():
            self.assertIn(script + ' ', content)
        for page in glob.glob(cases.ROOT + '/docs/benchmarks/*.md'):
            self.assertIn(os.path.relpath(page, cases.ROOT), content)


if __name__ == '__main__':
    cases.run(Seeds, Flights, PriorTable, MeasuresTable, MethodsTable, CompareSpeed, MeasureAll)
