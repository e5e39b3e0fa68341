#!/usr/bin/env python3
"""Prints one Markdown table from what evaluate_tracks --csv wrote of the same flights with several motion priors.

    prior_table.py FOLDER/PRIOR ...

Reads FOLDER/PRIOR.csv. One row for each regime and prior, means over its seeds (regime-SEED), and how imu does against image.
"""
import csv
import os
import re
import statistics
import sys

COLUMNS = (('images per track', 'track_length', 1, 1), ('survival [%]', 'survival', 100, 1),
           ('under 2 px [%]', 'inlier_ratio_2px', 100, 2), ('under 1 px [%]', 'inlier_ratio_1px', 100, 2))


def number(text):
    """None for what is not known."""
    try:
        value = float(text)
    except ValueError:
        return None
    return None if value != value else value


def read(path):
    """{regime: {column: [values of its seeds]}}"""
    regimes = {}
    with open(path) as file:
        for row in csv.DictReader(file):
            regime = re.sub(r'-\d+$', '', row['bag'])
            for _, key, _, _ in COLUMNS:
                regimes.setdefault(regime, {}).setdefault(key, []).append(number(row[key]))
    return regimes


def mean(values):
    known = [value for value in values if value is not None]
    return statistics.mean(known) if known else None


def cell(value, scale, digits):
    return '-' if value is None else '{:.{}f}'.format(scale * value, digits)


def table(measured):
    """Lines of the table of {prior: {regime: {column: values}}}."""
    lines = ['| flight | prior | ' + ' | '.join(name for name, _, _, _ in COLUMNS) + ' |',
             '|---|---|' + '---|' * len(COLUMNS)]
    for regime in next(iter(measured.values())):
        for prior, regimes in measured.items():
            cells = [cell(mean(regimes[regime][key]), scale, digits) for _, key, scale, digits in COLUMNS]
            lines.append('| {} | {} | {} |'.format(regime, prior, ' | '.join(cells)))
    return lines


def comparison(measured):
    """Sentences that say in which flights tracks with `imu` are shorter than with `image`, flight by flight."""
    pairs = [(regime, i, imu, image) for regime in measured['imu']
             for i, (imu, image) in enumerate(zip(measured['imu'][regime]['track_length'],
                                                  measured['image'][regime]['track_length']))]
    ratios = [imu / image for _, _, imu, image in pairs]
    worst = min(range(len(pairs)), key=lambda i: ratios[i])
    return ['',
            'imu against image, images per track: {} flights, ratio {:.3f} to {:.3f}, median {:.3f}; '
            '{} shorter by over 1 %, {} longer by over 1 %; worst in {}'.format(
                len(pairs), min(ratios), max(ratios), statistics.median(ratios),
                sum(ratio < 0.99 for ratio in ratios), sum(ratio > 1.01 for ratio in ratios), pairs[worst][0])]


def main():
    if len(sys.argv) < 2 or sys.argv[1].startswith('-'):
        sys.exit(__doc__)
    measured = {os.path.basename(path): read(path + '.csv') for path in sys.argv[1:]}
    print('\n'.join(table(measured)))
    if 'imu' in measured and 'image' in measured:
        print('\n'.join(comparison(measured)))
    return 0


if __name__ == '__main__':
    sys.exit(main())
