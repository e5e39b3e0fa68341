#!/usr/bin/env python3
"""Table of docs/benchmarks/methods.md from the folder of scripts/measure_methods.sh.

  methods_table.py RESULTS METHOD ...

RESULTS has METHOD.csv of evaluate_tracks --absolute, whose bags are named SEQUENCE-METHOD, and SEQUENCE-METHOD.txt, what track_bag
printed."""
import os
import re
import sys

from measures_table import Column, cells, print_table, rows_of

COUNTS = [Column('lines per image', 'lines_per_image', '{:.0f}', 1.0)]
PAIRS = [Column('under 2 px [%]', 'inlier_ratio_2px', '{:.2f}', 100.0), Column('under 1 px [%]', 'inlier_ratio_1px', '{:.2f}', 100.0)]
TRIPLES = [Column('', 'three_view_ratio_2px', '{:.2f}', 100.0), Column('', 'three_view_ratio_1px', '{:.2f}', 100.0)]
LENGTHS = [Column('images per track', 'track_length', '{:.1f}', 1.0), Column('length [px]', 'line_length_px', '{:.0f}', 1.0)]
ABSOLUTE = [Column('worse end, median [px]', 'absolute_all_worse_end_median_px', '{:.2f}', 1.0),
            Column('worse end, 90 % [px]', 'absolute_all_worse_end_p90_px', '{:.2f}', 1.0)]


def processor_ms(text):
    """Mean per image of what track_bag printed; '-': it printed none."""
    row = re.search(r'^processor +([\d.]+)', text, re.MULTILINE)
    return '{:.2f}'.format(float(row.group(1))) if row else '-'


def row_of(measures, printed):
    """The cells of one sequence and method. Where no scene or depth is known, pairs are judged by three views."""
    shares = PAIRS if measures['inlier_ratio_2px'] else TRIPLES
    return cells([measures], COUNTS + shares + LENGTHS + ABSOLUTE) + [processor_ms(printed)]


def main():
    folder, methods = sys.argv[1], sys.argv[2:]
    sequences = {}  # {sequence: [[method, cells...]]}
    for method in methods:
        for row in rows_of(os.path.join(folder, method + '.csv')):
            with open(os.path.join(folder, row['bag'] + '.txt')) as file:
                sequences.setdefault(row['bag'].rsplit('-', 1)[0], []).append([method] + row_of(row, file.read()))
    print_table(['sequence', 'method'] + [column.title for column in COUNTS + PAIRS + LENGTHS + ABSOLUTE] + ['ms per image'],
                [[sequence] + row for sequence, rows in sequences.items() for row in rows])


if __name__ == '__main__':
    main()
