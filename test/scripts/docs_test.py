#!/usr/bin/env python3
"""Tests of the pages: what they point to exists.   docs_test.py [RESULT.xml]"""
import glob
import os
import re
import unittest

import cases
from cases import ROOT


def read(path):
    with open(path) as file:
        return file.read()


def pages():
    return [os.path.join(ROOT, name) for name in ('README.md', 'CONTRIBUTING.md')] + glob.glob(
        os.path.join(ROOT, 'docs', '**', '*.md'), recursive=True)


class Pages(unittest.TestCase):
    def test_every_test_that_the_faq_names_exists(self):
        tests = set()
        for path in glob.glob(os.path.join(ROOT, 'test', '**', '*.cpp'), recursive=True):
            tests |= {'.'.join(pair) for pair in re.findall(r'^TEST(?:_F|_P)?\((\w+),\s*(\w+)\)', read(path), re.MULTILINE)}
        named = [name for line in re.findall(r'^\*(?!\*)(.+)\*$', read(os.path.join(ROOT, 'docs', 'faq.md')), re.MULTILINE)
                 for name in line.split(', ')]
        self.assertGreaterEqual(len(named), 15)
        self.assertEqual([name for name in named if name not in tests], [])

    def test_every_link_to_a_file_leads_somewhere(self):
        dead = []
        for page in pages():
            for link in re.findall(r'\]\(([^)#\s]+)', read(page)):
                if '://' not in link and not os.path.exists(os.path.join(os.path.dirname(page), link)):
                    dead.append('{}: {}'.format(os.path.relpath(page, ROOT), link))
        self.assertEqual(dead, [])


if __name__ == '__main__':
    cases.run(Pages)
