#!/usr/bin/env python3
"""Prints Markdown tables from what evaluate_tracks --csv wrote of the same flights with several motion priors.

    prior_table.py FOLDER/PRIOR ...

Reads FOLDER/PRIOR.csv. First auto against image: means and their standard errors over the flights of a regime (regime-SEED), each
compared with itself. Then a row for each regime and prior, means over its flights.
"""
import csv
import math
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


def spread(values, scale, digits):
    """Mean and its standard error."""
    if not values:
        return '-'
    mean_cell = '{:.{}f}'.format(scale * statistics.mean(values), digits)
    if len(values) < 2:
        return mean_cell
    error = statistics.stdev(values) / math.sqrt(len(values))
    return '{} ± {:.{}f}'.format(mean_cell, scale * error, digits)


def comparison(measured):
    """Lines of a table of what `auto` does against `image`, flight by flight."""
    lines = ['| flight | flights | images per track, ratio | survival, difference [points] |', '|---|---|---|---|']
    for regime, image in measured['image'].items():
        auto = measured['auto'][regime]
        lengths = [a / i for a, i in zip(auto['track_length'], image['track_length'])]
        survivals = [a - i for a, i in zip(auto['survival'], image['survival']) if a is not None and i is not None]
        lines.append('| {} | {} | {} | {} |'.format(regime, len(lengths), spread(lengths, 1, 3), spread(survivals, 100, 1)))
    return lines


def main():
    if len(sys.argv) < 2 or sys.argv[1].startswith('-'):
        sys.exit(__doc__)
    measured = {os.path.basename(path): read(path + '.csv') for path in sys.argv[1:]}
    if 'auto' in measured and 'image' in measured:
        print('\n'.join(comparison(measured)) + '\n')
    print('\n'.join(table(measured)))
    return 0


if __name__ == '__main__':
    sys.exit(main())
