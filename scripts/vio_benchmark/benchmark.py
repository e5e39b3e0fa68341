#!/usr/bin/env python3
"""What vio_benchmark.sh runs once PL-VINS is built: flights, trackers, estimator, tables. Needs a master."""
import argparse
import dataclasses
import datetime
import functools
import json
import os
import statistics
import subprocess
import sys

import rosgraph
import rospy

import estimator
import flights
import lines
import metrics
from nodes import Failure, Processes, wait_until

SOURCES = {'none': 'points alone', 'own': "PL-VINS's own lines", 'tet': 'ours', 'perfect': 'perfect lines'}


def parse(words):
    names = [case.name for case in flights.CASES]
    parser = argparse.ArgumentParser(prog='vio_benchmark.sh', add_help=False)
    parser.add_argument('--programs', required=True)
    parser.add_argument('--tools', required=True)
    parser.add_argument('--results', required=True)
    parser.add_argument('--seeds', default='1001 1002')
    parser.add_argument('--starts', default='0 4')
    parser.add_argument('--seconds', type=float, default=30.0)
    parser.add_argument('--sources', default=' '.join(SOURCES))
    parser.add_argument('--launch', default='')
    parser.add_argument('cases', nargs='*', metavar='CASE', default=names)
    arguments = parser.parse_args(words)
    arguments.seeds = [int(seed) for seed in arguments.seeds.split()]
    arguments.starts = [float(start) for start in arguments.starts.split()]
    arguments.sources = arguments.sources.split()
    for source in arguments.sources:
        if source not in SOURCES:
            raise Failure('there are no lines "{}"; known: {}'.format(source, ', '.join(SOURCES)))
    for name in arguments.cases:
        if name not in names and not os.path.exists(name):
            raise Failure('there is no case, bag or EuRoC folder "{}"; cases: {}'.format(name, ', '.join(names)))
    return arguments


def real_flight(path, arguments):
    """A bag, or the mav0 folder of a EuRoC sequence."""
    if os.path.isfile(path):
        return path
    bag = os.path.join(arguments.results, 'euroc-{}.bag'.format(os.path.basename(os.path.dirname(os.path.realpath(path)))))
    if not os.path.exists(bag):
        subprocess.run([os.path.join(arguments.tools, 'dataset_to_bag'), 'euroc', path, bag], check=True, stdin=subprocess.DEVNULL)
    return bag


def flights_of(name, arguments):
    """The case, and pairs of a seed and a bag."""
    case = next((each for each in flights.CASES if each.name == name), None)
    if case is None:
        return flights.Case(os.path.basename(name if os.path.isfile(name) else os.path.dirname(name)), 'a recording, all points'), [
            (0, real_flight(name, arguments))]
    return case, [(seed, flights.make_flight(case, seed, arguments.seconds, arguments.results, arguments.tools))
                  for seed in arguments.seeds]


def once(path, estimate):
    """The result that is kept in a file, so that an interrupted benchmark goes on where it was."""
    if not os.path.exists(path):
        result, poses = estimate()
        with open(path[:-5] + '.tum', 'w') as file:
            for stamp, pose in poses:
                file.write('{:.9f} {}\n'.format(stamp, ' '.join('{:.6f}'.format(x) for x in (
                    *pose[:3, 3], *metrics.quaternion(pose[:3, :3])))))
        with open(path, 'w') as file:
            json.dump(dataclasses.asdict(result), file)
    with open(path) as file:
        return estimator.Result(**json.load(file))


def measure(name, arguments):
    """Results by source, one for each flight and start, and processor times by source."""
    case, bags = flights_of(name, arguments)
    results = {source: [] for source in SOURCES}
    cpu = {'own': [], 'tet': []}
    for seed, bag in bags:
        flight = flights.Flight(bag)
        base = bag[:-4] + '-tracked'
        new_processes = functools.partial(Processes, bag[:-4] + '-logs')
        configuration = bag[:-4] + '.yaml'
        flight.write_configuration(configuration)
        messages, figures = lines.track(flight, base, configuration, arguments.programs, new_processes, arguments.launch.split())
        for source, topic in (('own', lines.OWN), ('tet', lines.OURS)):
            cpu[source].append(figures['cpu_ms'][topic])
        for source in arguments.sources:
            if source == 'perfect' and case not in flights.CASES:
                continue
            line_messages = lines.line_messages(source, messages, flight, arguments.tools)
            for start in arguments.starts:
                kept = '{}-{}-{}-{:g}.json'.format(bag[:-4], case.name, source, start)
                result = once(kept, lambda start=start, line_messages=line_messages: estimator.estimate(
                    flight, messages[lines.POINTS], line_messages, case.points, start, configuration, arguments.programs,
                    new_processes))
                results[source].append(result)
                print('{} {} {} from {:g} s: {}'.format(case.name, seed, source, start, ' '.join(
                    '{} {:.4g}'.format(key, value) for key, value in dataclasses.asdict(result).items())), flush=True)
    return case, results, cpu


def spread(values, digits):
    values = [value for value in values if value == value]
    if not values:
        return '-'
    words = ['{:.{}f}'.format(value, digits) for value in (statistics.median(values), min(values), max(values))]
    return '{} ({} to {})'.format(*words) if len(values) > 1 else words[0]


def table(case, results, cpu):
    """Rows of markdown: medians, and ranges in brackets."""
    rows = ['| lines | ATE SE(3) [m] | ATE Sim(3) [m] | RPE over 1 s [m] | RPE over 1 s [deg] | line factors per image | lines per '
            'message | CPU of the line tracker per message [ms] |', '|---|---|---|---|---|---|---|---|']
    for source, runs in results.items():
        if not runs:
            continue
        good = [run for run in runs if run.is_good()]
        name = SOURCES[source] + ('' if len(good) == len(runs) else ' ({} of {} runs lost)'.format(
            len(runs) - len(good), len(runs)))
        columns = [spread([getattr(run, key) for run in good], digits) for key, digits in (
            ('ate_se3', 3), ('ate_sim3', 3), ('rpe_m', 4), ('rpe_deg', 3))]
        columns += ['{:.0f}'.format(statistics.median(getattr(run, key) for run in good)) if good else '-'
                    for key in ('line_factors', 'lines')]
        columns.append(spread(cpu[source], 1) if source in cpu else '')
        rows.append('| {} | {} |'.format(name, ' | '.join(columns)))
    return '### {}: {}\n\n{}\n'.format(case.name, case.words, '\n'.join(rows))


def verdict(results, cpu):
    """Of what is asked of the lines of this package, what is so: name and yes or no."""
    def median(source, key):
        values = [getattr(run, key) for run in results.get(source, []) if run.is_good()]
        return statistics.median(values) if values else float('nan')
    none, own, ours, perfect = (median(source, 'ate_se3') for source in SOURCES)
    answers = {
        'at most half way from perfect lines to points alone': ours <= 0.5 * (none + perfect),
        "no worse than PL-VINS's own": ours <= own,
        "line factors at least twice PL-VINS's": median('tet', 'line_factors') >= 2.0 * median('own', 'line_factors'),
        "CPU at most a tenth of PL-VINS's": statistics.median(cpu['tet']) <= 0.1 * statistics.median(cpu['own']),
    }
    return {name: bool(answer) for name, answer in answers.items()}


def summary(measured):
    rows = ['| case | points alone | own | ours | perfect | half way to perfect | no worse than own | factors, ours / own | CPU, ours / own |',
            '|---|---|---|---|---|---|---|---|---|']
    for case, results, cpu in measured:
        def median(source, key='ate_se3'):
            values = [getattr(run, key) for run in results.get(source, []) if run.is_good()]
            return statistics.median(values) if values else float('nan')
        answers = list(verdict(results, cpu).values()) if results['perfect'] else ['-', '-']
        rows.append('| {} | {} | {} | {} | {:.1f} | {:.2f} |'.format(
            case.name, ' | '.join('{:.3f}'.format(median(source)).replace('nan', '-') for source in SOURCES),
            *['yes' if answer is True else 'no' if answer is False else answer for answer in answers[:2]],
            median('tet', 'line_factors') / median('own', 'line_factors') if median('own', 'line_factors') else float('nan'),
            statistics.median(cpu['tet']) / statistics.median(cpu['own'])))
    return 'Median ATE, SE(3) [m]:\n\n' + '\n'.join(rows) + '\n'


def report(measured, arguments):
    load = os.getloadavg()[1]
    words = '{}: seeds {}, starts {} s, flights of {:g} s; {} processors, load of the machine {:.1f}.\n'.format(
        datetime.date.today().isoformat(), ' '.join(map(str, arguments.seeds)), ' '.join('{:g}'.format(s) for s in arguments.starts),
        arguments.seconds, os.cpu_count(), load)
    return '\n'.join([words, summary(measured)] + [table(*each) for each in measured])


def main():
    arguments = parse(sys.argv[1:])
    os.makedirs(arguments.results, exist_ok=True)
    wait_until(rosgraph.is_master_online, 60.0, 'there is no ROS master')
    rospy.init_node('vio_benchmark', disable_signals=True)
    measured = []
    for name in arguments.cases:
        measured.append(measure(name, arguments))
        with open(os.path.join(arguments.results, 'vio.md'), 'w') as file:
            file.write(report(measured, arguments))
    with open(os.path.join(arguments.results, 'vio.json'), 'w') as file:
        json.dump([{'case': case.name, 'cpu_ms': cpu, 'runs': {s: [dataclasses.asdict(r) for r in runs] for s, runs in results.items()}}
                   for case, results, cpu in measured], file, indent=1)
    print(report(measured, arguments))


if __name__ == '__main__':
    try:
        main()
    except KeyboardInterrupt:
        sys.exit(130)
    except Failure as failure:
        sys.exit('vio_benchmark.sh: {}'.format(failure))
    except subprocess.CalledProcessError as error:
        sys.exit('vio_benchmark.sh: {} failed'.format(os.path.basename(error.cmd[0])))
