#!/usr/bin/env python3
"""Tests of the page of faults: what it names exists.   reliability_test.py [RESULT.xml]"""
import glob
import os
import re
import unittest

import cases
from cases import ROOT

PAGE = os.path.join(ROOT, 'docs', 'reliability.md')
FEWEST_ROWS = 40


def read(path):
    with open(path) as file:
        return file.read()


def tests_of_programs():
    """Name of a test program -> its tests, SUITE.CASE."""
    programs = {}
    for path in glob.glob(os.path.join(ROOT, 'test', '**', '*_test.cpp'), recursive=True):
        found = re.findall(r'^TEST(?:_F|_P)?\(\s*(\w+),\s*(\w+)\)', read(path), re.MULTILINE)
        programs[os.path.basename(path)[:-len('.cpp')]] = {'.'.join(pair) for pair in found}
    return programs


def rows():
    """Cells of each row of the tables of faults, without the heads."""
    lines = [line for line in read(PAGE).splitlines() if line.startswith('| ')]
    cells = [[cell.strip() for cell in line.strip('|').split(' | ')] for line in lines]
    return [row for row in cells if len(row) == 4 and row[0] != 'given']


def named_tests(cell):
    """Pairs (program, SUITE.CASE) of the last cell of a row."""
    pairs = []
    for program, tests in re.findall(r'`(\w+)`: ([\w., ]+)', cell):
        pairs += [(program, test.strip()) for test in tests.split(', ')]
    return pairs


class Reliability(unittest.TestCase):
    def test_the_page_has_its_tables(self):
        self.assertGreaterEqual(len(rows()), FEWEST_ROWS)

    def test_every_row_names_a_test_or_a_script_that_exists(self):
        programs = tests_of_programs()
        missing = []
        for row in rows():
            tests = named_tests(row[3])
            scripts = re.findall(r'`(scripts/\w+\.sh)', row[3])
            if not tests and not scripts:
                missing.append('no test: ' + row[0])
            missing += ['{}: {}'.format(*test) for test in tests if test[1] not in programs.get(test[0], ())]
            missing += [script for script in scripts if not os.path.exists(os.path.join(ROOT, script))]
        self.assertEqual(missing, [])

    def test_every_quoted_sentence_is_in_the_sources(self):
        sources = ''.join(read(path) for path in glob.glob(os.path.join(ROOT, 'src', '**', '*.*'), recursive=True)
                          if path.endswith(('.cpp', '.h')))
        # Parts of a string may stand on several lines.
        sources = re.sub(r'"\s*\n\s*"', '', sources)
        unknown = [sentence for row in rows() for sentence in re.findall(r'\*([^*]+)\*', row[2])
                   if not all(part.strip() in sources for part in sentence.split('…'))]
        self.assertEqual(unknown, [])

    def test_every_test_with_a_master_starts_the_program_of_its_name(self):
        for path in glob.glob(os.path.join(ROOT, 'test', 'ros', '*.test')):
            name = os.path.basename(path)[:-len('.test')]
            self.assertEqual(re.findall(r'<test [^>]*type="(\w+)"', read(path)), [name], path)


if __name__ == '__main__':
    cases.run(Reliability)
