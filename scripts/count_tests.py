#!/usr/bin/env python3
"""Counts what the result files of a test run say; called by test.sh after CTest and lint.py.

    count_tests.py BUILD_FOLDER lint|no-lint [CTest options that picked the tests]

Prints every failed and every skipped case with its reason and, last, `N passed, N failed, N skipped`; exits 1 when
a case failed. Each case counts once: rostest repeats the outcome of its gtests in a file of its own. A test program
of CTest, or lint, that left no readable result (a crash, a timeout) is a failure.
"""
import collections
import json
import os
import re
import subprocess
import sys
import xml.etree.ElementTree as ElementTree

Case = collections.namedtuple('Case', 'name outcome reason')


def cases_in(path):
    """The cases of a JUnit file as gtest, rosunit and rostest write it."""
    cases = []
    for case in ElementTree.parse(path).iter('testcase'):
        name = '.'.join(part for part in (case.get('classname'), case.get('name')) if part)
        bad = [child for child in case if child.tag in ('failure', 'error')]
        skip = case.find('skipped')
        if bad:
            cases.append(Case(name, 'failed', (bad[0].get('message') or bad[0].text or '').strip()))
        elif skip is not None or case.get('result') in ('skipped', 'suppressed') or case.get('status') == 'notrun':
            reason = (skip.get('message') or skip.text or '') if skip is not None else ''
            cases.append(Case(name, 'skipped', reason.strip() or 'no reason given'))
        else:
            cases.append(Case(name, 'passed', ''))
    return cases


def expected_results(build, options):
    """Result file of each test program that CTest knows."""
    listing = subprocess.run(['ctest', '--show-only=json-v1', *options], cwd=build, check=True, stdout=subprocess.PIPE)
    for test in json.loads(listing.stdout.decode())['tests']:
        files = [word for word in test.get('command', []) if word.endswith('.xml')]
        if files:
            yield test['name'], files[0]


def read_results(results):
    """Cases by file, a file that cannot be read being one failure."""
    found = {}
    for folder, _, names in os.walk(results):
        for name in sorted(n for n in names if n.endswith('.xml')):
            path = os.path.join(folder, name)
            try:
                found[path] = cases_in(path)
            except ElementTree.ParseError as error:
                found[path] = [Case(name, 'failed', 'the result file cannot be read: {}'.format(error))]
    return found


def without_repetitions(found):
    """Drops the cases of rostest-*.xml whose test program reported its own cases with the same outcome."""
    for path in [p for p in found if os.path.basename(p).startswith('rostest-')]:
        kept = []
        for case in found[path]:
            test_name = re.sub(r'^test', '', case.name.rsplit('.', 1)[-1])
            own = found.get(os.path.join(os.path.dirname(path), 'rosunit-{}.xml'.format(test_name)), [])
            own_failed = any(c.outcome == 'failed' for c in own)
            if not own or (case.outcome == 'failed') != own_failed:
                kept.append(case)
        found[path] = kept
    return [case for path in sorted(found) for case in found[path]]


def main():
    build, lint, options = sys.argv[1], sys.argv[2], sys.argv[3:]
    results = os.path.join(build, 'test_results')
    found = read_results(results)
    missing = []
    if lint == 'lint' and os.path.join(results, 'lint.xml') not in found:
        missing.append(Case('lint', 'failed', 'ended without a result file'))
    for name, path in expected_results(build, options):
        placeholder = os.path.join(os.path.dirname(path), 'MISSING-' + os.path.basename(path))
        if path not in found and placeholder not in found:
            missing.append(Case(name, 'failed', 'ended without a result file'))
    cases = without_repetitions(found) + missing

    for outcome in ('skipped', 'failed'):
        for case in (c for c in cases if c.outcome == outcome):
            print('{}: {}: {}'.format(outcome, case.name, ' '.join(case.reason.split())[:300]))
    count = collections.Counter(case.outcome for case in cases)
    print('{} passed, {} failed, {} skipped'.format(count['passed'], count['failed'], count['skipped']))
    return 1 if count['failed'] or not cases else 0


if __name__ == '__main__':
    sys.exit(main())
