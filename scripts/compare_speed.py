#!/usr/bin/env python3
"""Compares the speed of track_bag of two builds on the same bags, in turn; called by benchmark.sh --compare.

    compare_speed.py OLD_BUILD NEW_BUILD PAIRS BAG ...

Every pair is one run of each build, the first one by turns. Prints new / old: the median of the ratios of the pairs, between
their quartiles. A ratio within a pair is not disturbed by what slows both runs down; the spread tells how much the rest is.
"""
import collections
import os
import re
import statistics
import subprocess
import sys
import tempfile

STAGES = ('pyramid', 'prior', 'flow', 'refine', 'detect', 'undistort', 'total')
COLUMNS = ('mean', 'median', 'p99', 'max')

Run = collections.namedtuple('Run', 'lines times cpu_s')  # lines per image, {stage: {column: ms}}, of the process


class Failure(Exception):
    pass


def parse(text, cpu_s):
    """A Run from what track_bag prints at its end."""
    lines = re.search(r'([\d.]+) lines per image', text)
    times = {}
    for stage in STAGES:
        row = re.search(r'^{}((?: +[\d.]+){{4}})$'.format(stage), text, re.MULTILINE)
        if row:
            times[stage] = dict(zip(COLUMNS, map(float, row.group(1).split())))
    if lines is None or 'total' not in times:
        raise Failure('track_bag printed no times:\n' + text)
    return Run(float(lines.group(1)), times, cpu_s)


def track(build, bag, lines):
    """Runs track_bag of a build with the libraries of that build."""
    environment = dict(os.environ)
    environment['LD_LIBRARY_PATH'] = '{}/devel/lib:{}'.format(build, environment.get('LD_LIBRARY_PATH', ''))
    program = os.path.join(build, 'devel/lib/tet_line_tracker/track_bag')
    with tempfile.TemporaryFile('w+') as output:
        process = subprocess.Popen([program, bag, lines, '--threads', '1'], env=environment, stdin=subprocess.DEVNULL,
                                   stdout=output, stderr=subprocess.STDOUT)
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = status
        output.seek(0)
        text = output.read()
    if status != 0:
        raise Failure('{} failed: {}'.format(program, text.strip().rpartition('\n')[2]))
    return parse(text, usage.ru_utime + usage.ru_stime)


def ratio(pairs, value):
    """'median (lower quartile to upper quartile)' of new / old, '-' where the old takes no time."""
    ratios = [value(new) / value(old) for old, new in pairs if value(old) > 0.0]
    if not ratios:
        return '-'
    if len(ratios) == 1:
        return '{:.3f}'.format(ratios[0])
    low, middle, high = statistics.quantiles(ratios, n=4, method='inclusive')
    return '{:.3f} ({:.3f} to {:.3f})'.format(middle, low, high)


def report(name, pairs):
    """Rows of one bag."""
    old, new = (statistics.median(run.lines for run in runs) for runs in zip(*pairs))
    rows = [('lines per image', '{:.1f}, before {:.1f}'.format(new, old)),
            ('mean', ratio(pairs, lambda run: run.times['total']['mean'])),
            ('mean, per line', ratio(pairs, lambda run: run.times['total']['mean'] / run.lines)),
            ('median', ratio(pairs, lambda run: run.times['total']['median'])),
            ('median, per line', ratio(pairs, lambda run: run.times['total']['median'] / run.lines)),
            ('99th percentile', ratio(pairs, lambda run: run.times['total']['p99']))]
    rows += [('mean of ' + stage, ratio(pairs, lambda run, stage=stage: run.times.get(stage, {}).get('mean', 0.0)))
             for stage in STAGES[:-1]]
    rows.append(('processor time of track_bag', ratio(pairs, lambda run: run.cpu_s)))
    return ['| {} | {} | {} |'.format(name, *row) for row in rows]


def main():
    if len(sys.argv) < 5 or not sys.argv[3].isdigit() or int(sys.argv[3]) < 1:
        sys.exit(__doc__)
    builds = [os.path.abspath(build) for build in sys.argv[1:3]]
    count = int(sys.argv[3])
    print('\n## New build against old, {} pairs of runs, one thread\n\n| bag | | new / old, median (quartiles) |\n|---|---|---|'
          .format(count), flush=True)
    with tempfile.TemporaryDirectory() as folder:
        for bag in sys.argv[4:]:
            pairs = []
            for i in range(count + 1):
                runs = {build: track(builds[build], bag, os.path.join(folder, 'lines.bag'))
                        for build in ((0, 1) if i % 2 == 0 else (1, 0))}
                if i > 0:  # the first pair reads the bag and the libraries from the disk
                    pairs.append((runs[0], runs[1]))
            print('\n'.join(report(os.path.splitext(os.path.basename(bag))[0], pairs)), flush=True)
    return 0


if __name__ == '__main__':
    try:
        sys.exit(main())
    except (Failure, OSError) as failure:
        sys.exit('compare_speed.py: {}'.format(failure))
