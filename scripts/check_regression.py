#!/usr/bin/env python3
"""Compares measures of two versions of the tracker on the same sequences.

    check_regression.py BASELINE.csv NEW.csv            exit status 1 when a measure is worse by more than its tolerance
    check_regression.py --write BASELINE.csv NEW.csv    keeps the measures of NEW as the baseline

NEW.csv: of evaluate_tracks --csv. A sequence that is missing in NEW, or a measure that it no longer has, is worse.
"""
import collections
import csv
import os
import sys

Measure = collections.namedtuple('Measure', 'name title larger_is_better slack')


def share(least):
    """Tolerance of a share: a twentieth of what is missing to 1, `least` at least."""
    return lambda old: max(least, 0.05 * (1.0 - old))


def tenth(least):
    return lambda old: max(least, 0.1 * abs(old))


# What is better never fails.
MEASURES = (Measure('lines_per_image', 'lines per image', True, tenth(0.0)),
            Measure('track_length', 'images per track', True, tenth(0.0)),
            Measure('line_length_px', 'length of a line [px]', True, tenth(0.0)),
            Measure('coverage', 'coverage', True, share(0.03)),
            Measure('homography_ratio', 'agree on a homography', True, share(0.01)),
            Measure('inlier_ratio_2px', 'under 2 px by depth', True, share(0.004)),
            Measure('error_median_px', 'median error by depth [px]', False, tenth(0.02)),
            Measure('three_view_ratio_2px', 'three-view error under 2 px', True, share(0.004)),
            Measure('three_view_ratio_1px', 'three-view error under 1 px', True, share(0.01)))


def read(path):
    """{sequence: {measure: value or None}}; the sequence is the bag's name before its last '-'."""
    try:
        with open(path, newline='') as file:
            rows = list(csv.DictReader(file))
    except OSError as error:
        raise SystemExit('check_regression.py: {} cannot be read: {}'.format(path, error.strerror))
    found = {}
    for row in rows:
        name = os.path.basename(row['bag']).rsplit('-', 1)[0]
        found[name] = {m.name: float(row[m.name]) if row.get(m.name) else None for m in MEASURES}
    if not found:
        raise SystemExit('check_regression.py: {} holds no sequence'.format(path))
    return found


def allowed(measure, old):
    """The worst value that still passes."""
    return old - measure.slack(old) if measure.larger_is_better else old + measure.slack(old)


def is_worse(measure, old, new):
    if old is None:
        return False
    if new is None:
        return True
    limit = allowed(measure, old)
    return new < limit if measure.larger_is_better else new > limit


def compare(baseline, new):
    """Lines of a table, and how many measures are worse."""
    lines = ['{:34} {:30} {:>9} {:>9} {:>9}'.format('sequence', 'measure', 'was', 'is', 'limit')]
    worse = 0
    for sequence, measures in baseline.items():
        if sequence not in new:
            lines.append('{:34} is missing'.format(sequence))
            worse += 1
            continue
        for measure in MEASURES:
            old = measures[measure.name]
            if old is None:
                continue
            value = new[sequence][measure.name]
            fails = is_worse(measure, old, value)
            worse += fails
            shown = 'none' if value is None else '{:.4g}'.format(value)
            lines.append('{:34} {:30} {:9.4g} {:>9} {:9.4g}{}'.format(sequence, measure.title, old, shown, allowed(measure, old),
                                                                      '  WORSE' if fails else ''))
    return lines, worse


def write(path, measures):
    with open(path + '.part', 'w', newline='') as file:
        table = csv.writer(file, lineterminator='\n')
        table.writerow(['bag'] + [m.name for m in MEASURES])
        for sequence, values in measures.items():
            table.writerow([sequence + '-tet'] + ['' if values[m.name] is None else '{:.5g}'.format(values[m.name]) for m in MEASURES])
    os.replace(path + '.part', path)


def main(arguments):
    keep = arguments[:1] == ['--write']
    if keep:
        arguments = arguments[1:]
    if len(arguments) != 2:
        raise SystemExit(__doc__)
    new = read(arguments[1])
    if keep:
        write(arguments[0], new)
        print('{}: {} sequences'.format(arguments[0], len(new)))
        return 0
    baseline = read(arguments[0])
    here = {name: values for name, values in baseline.items() if name in new}
    for name in baseline:
        if name not in here:
            print('{}: not measured'.format(name))
    lines, worse = compare(here if here else baseline, new)
    print('\n'.join(lines))
    print('{} worse than before'.format(worse) if worse else 'nothing is worse than before')
    return 1 if worse else 0


if __name__ == '__main__':
    sys.exit(main(sys.argv[1:]))
