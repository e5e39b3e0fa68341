#!/usr/bin/env python3
"""Table of docs/benchmarks/real.md from the CSV files of evaluate_tracks, one per tracker.

  real_table.py TRACKER=FILE.csv ...

Bags are named SEQUENCE-TRACKER."""
import sys

from measures_table import Column, cells, print_table, rows_of

COLUMNS = [Column('images', 'images', '{:.0f}', 1.0), Column('lines per image', 'lines_per_image', '{:.0f}', 1.0),
           Column('length [px]', 'line_length_px', '{:.0f}', 1.0), Column('images per track', 'track_length', '{:.1f}', 1.0),
           Column('agree on a homography [%]', 'homography_ratio', '{:.1f}', 100.0),
           Column('under 2 px by depth [%]', 'inlier_ratio_2px', '{:.2f}', 100.0),
           Column('3 views under 2 px [%]', 'three_view_ratio_2px', '{:.2f}', 100.0),
           Column('3 views under 1 px [%]', 'three_view_ratio_1px', '{:.2f}', 100.0),
           Column('refuted [%]', 'three_view_refuted_ratio', '{:.2f}', 100.0)]


def main():
    sequences = {}  # {sequence: {tracker: row}}
    for argument in sys.argv[1:]:
        tracker, path = argument.split('=', 1)
        for row in rows_of(path):
            sequences.setdefault(row['bag'].rsplit('-', 1)[0], {})[tracker] = row
    print_table(['sequence', 'tracker'] + [column.title for column in COLUMNS],
                [[sequence, tracker] + cells([row], COLUMNS)
                 for sequence, trackers in sequences.items() for tracker, row in trackers.items()])


if __name__ == '__main__':
    main()
