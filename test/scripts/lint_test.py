#!/usr/bin/env python3
"""Tests of the checks of scripts/lint.py.   lint_test.py [RESULT.xml]"""
import os
import shutil
import tempfile
import unittest

import cases
import lint
import std_headers

SOURCE = '''#include <vector>

namespace project {{
namespace {{

constexpr int k{name} = {number};
struct {name}Part {{
  int value;
}};
int twice(int value) {{
  return 2 * value;
}}

}}  // namespace

int use{name}(const std::vector<int>& all) {{
{body}
}}

}}  // namespace project
'''


def source(name, number=1, body='  return twice(all.size() > 1 ? 1 : 2);'):
    return SOURCE.format(name=name, number=number, body=body)


class Batches(unittest.TestCase):
    def batches(self, contents, flags=lambda unit: ('c++',)):
        return lint.tidy_batches(sorted(contents), flags, lambda unit: contents[unit])

    def test_local_names_are_those_of_unnamed_namespaces(self):
        self.assertEqual(lint.local_names(source('One')), {'kOne', 'OnePart', 'twice'})

    def test_files_with_a_local_name_in_common_are_apart(self):
        contents = {'a.cpp': source('One'), 'b.cpp': source('Two'), 'c.cpp': source('Three').replace('twice', 'thrice')}
        self.assertEqual(self.batches(contents), [['a.cpp', 'c.cpp'], ['b.cpp']])

    def test_files_with_other_flags_are_apart(self):
        contents = {'a.cpp': '', 'b.cpp': '', 'c.cpp': ''}
        self.assertEqual(self.batches(contents, lambda unit: ('-mavx2',) if unit == 'b.cpp' else ()),
                         [['a.cpp', 'c.cpp'], ['b.cpp']])

    def test_every_file_is_in_one_batch_and_none_is_too_large(self):
        contents = {'{:02}.cpp'.format(i): '' for i in range(3 * lint.MAX_TIDY_BATCH - 1)}
        batches = self.batches(contents)
        self.assertEqual(len(batches), 3)
        self.assertEqual(sorted(unit for batch in batches for unit in batch), sorted(contents))

    def test_flags_are_the_command_without_its_files(self):
        entry = {'directory': cases.ROOT, 'file': cases.ROOT + '/src/a.cpp',
                 'command': 'ccache /usr/bin/c++ -DNAME="x" -I.. -O3 -o dir/a.o -c {}/src/a.cpp'.format(cases.ROOT)}
        self.assertEqual(lint.tidy_flags(entry), ['/usr/bin/c++', '-DNAME=x', '-I..', '-O3'])


class StdHeaders(unittest.TestCase):
    def test_a_header_that_is_used_and_not_included_is_named(self):
        found = std_headers.complaints({'src/core/a.cpp': '#include <vector>\nint b = std::max(1, 2);\n'})
        self.assertEqual(found, ['src/core/a.cpp: std::max needs <algorithm>'])

    def test_a_header_may_come_by_one_of_the_project(self):
        sources = {'src/core/room/a.cpp': '#include "room/a.h"\nint b = std::max(1, 2);  // std::iota\n',
                   'src/core/room/a.h': '#include <algorithm>\n'}
        self.assertEqual(std_headers.complaints(sources), [])


class Versions(unittest.TestCase):
    def test_a_clang_tidy_that_the_project_was_not_read_with_is_skipped(self):
        run, require = lint.run, lint.require
        lint.require = lambda tool: None
        lint.run = lambda *command: 'Debian LLVM version 19.1.7'
        try:
            with self.assertRaisesRegex(lint.Skipped, 'clang-tidy 19 is none of 10 to 14'):
                lint.check_tidy([], 'nowhere')
        finally:
            lint.run, lint.require = run, require


@unittest.skipUnless(shutil.which('clang-tidy'), 'clang-tidy is not installed')
class Tidy(unittest.TestCase):
    """A project of three files in a folder of its own."""

    def setUp(self):
        self.folder = os.path.realpath(tempfile.mkdtemp())
        os.makedirs(self.folder + '/src')
        os.makedirs(self.folder + '/build')
        shutil.copy(cases.ROOT + '/.clang-tidy', self.folder)
        os.chdir(self.folder)

    def tearDown(self):
        os.chdir(cases.ROOT)
        shutil.rmtree(self.folder)

    def complaint(self, contents):
        """What clang-tidy says of the files."""
        files = ['src/' + name for name in sorted(contents)]
        for name, content in contents.items():
            with open('src/' + name, 'w') as file:
                file.write(content)
        with open('build/compile_commands.json', 'w') as file:
            file.write('[{}]'.format(', '.join(
                '{{"directory": "{0}/build", "file": "{0}/{1}", "command": "c++ -std=c++17 -o x.o -c {0}/{1}"}}'.format(
                    self.folder, name) for name in files)))
        try:
            lint.check_tidy(files, 'build')
        except RuntimeError as error:
            return str(error).replace(self.folder + '/', '')
        return ''

    def test_finds_in_a_batch_what_it_finds_in_a_file_and_says_where(self):
        null = '  int* nothing = nullptr;\n  return all.empty() ? *nothing : 1;'
        compared = '  return all.size() == 0 ? 1 : 2;'
        contents = {'a.cpp': source('One').replace('twice', 'first'), 'b.cpp': source('Two', body=null),
                    'c.cpp': source('Three', body=compared).replace('twice', 'third')}
        read_as = []
        run = lint.run_tidy
        lint.run_tidy = lambda units, *rest: (read_as.append(len(units)), run(units, *rest))
        try:
            complaint = self.complaint(contents)
        finally:
            lint.run_tidy = run
        self.assertEqual(read_as, [3, 1, 1, 1], 'the batch must notice, and each file alone say what it is')
        self.assertRegex(complaint, r'(?m)^src/b\.cpp:18:\d+: error: Dereference of null pointer.*clang-analyzer')
        self.assertRegex(complaint, r'(?m)^src/c\.cpp:17:\d+: error: .*readability-container-size-empty')
        self.assertNotIn('src/a.cpp', complaint)

    def test_files_that_do_not_compile_as_one_are_read_one_by_one(self):
        contents = {'a.cpp': 'static int number() { return 1; }\nint first() { return number(); }\n',
                    'b.cpp': 'static int number() { return 2; }\nint second() { return number(); }\n'}
        self.assertEqual(self.complaint(contents), '')
        contents['b.cpp'] += 'int third(int* p) { p = 0; return *p; }\n'
        self.assertIn('src/b.cpp:3', self.complaint(contents))

    def test_what_passed_is_not_read_again_until_it_changes(self):
        contents = {'a.cpp': source('One'), 'b.cpp': source('Two').replace('twice', 'second')}
        self.assertEqual(self.complaint(contents), '')
        run = lint.run_tidy
        lint.run_tidy = lambda *arguments: self.fail('read again')
        try:
            self.assertEqual(self.complaint(contents), '')
        finally:
            lint.run_tidy = run
        contents['a.cpp'] = source('One', body='  return all.size() == 0 ? 1 : 2;')
        self.assertIn('src/a.cpp:17', self.complaint(contents))


if __name__ == '__main__':
    cases.run(Batches, Tidy, StdHeaders, Versions)
