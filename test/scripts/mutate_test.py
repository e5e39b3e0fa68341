#!/usr/bin/env python3
"""Tests of scripts/mutate.py and its table.   mutate_test.py [RESULT.xml]"""
import glob
import os
import tempfile
import unittest

import cases
import mutate


class Mutations(unittest.TestCase):
    def setUp(self):
        os.chdir(cases.ROOT)

    def test_every_mutation_still_finds_its_line(self):
        self.assertGreater(len(mutate.mutations()), 40)

    def test_a_mutation_outside_of_the_core_names_tests_that_are_there(self):
        named = [test for mutation in mutate.mutations() for test in mutation.tests]
        self.assertGreater(len(named), 20)
        for test in set(named):
            self.assertTrue(glob.glob('test/*/{}.cpp'.format(test)), test)

    def test_a_mutation_whose_line_has_moved_is_an_error(self):
        original = mutate.read
        mutate.read = lambda path: ''
        try:
            with self.assertRaisesRegex(mutate.Failure, 'mutation 1: .* is 0 times in .*, must be there once'):
                mutate.mutations()
        finally:
            mutate.read = original

    def test_the_copy_of_the_project_hides_no_launch_file_of_it(self):
        with tempfile.TemporaryDirectory() as folder:
            for _ in range(2):
                mutate.copy_source(folder)
                self.assertEqual(os.listdir(os.path.join(folder, 'launch')), [])
                self.assertTrue(os.path.exists(os.path.join(folder, 'src/core/tracking/checks.cpp')))


if __name__ == '__main__':
    cases.run(Mutations)
