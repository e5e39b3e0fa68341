#!/usr/bin/env python3
"""Tables of docs/benchmarks/effects.md from the CSV files of evaluate_tracks --absolute, one per tracker.

  effects_table.py TRACKER=FILE.csv ...

Bags are named MOTION-EFFECT-SEED-TRACKER; the mean over the seeds is printed."""
import sys

from measures_table import Column, cells, flights_of, print_table

COLUMNS = [Column('lines per image', 'lines_per_image', '{:.0f}', 1.0),
           Column('under 2 px [%]', 'inlier_ratio_2px', '{:.2f}', 100.0),
           Column('under 1 px [%]', 'inlier_ratio_1px', '{:.2f}', 100.0),
           Column('images per track', 'track_length', '{:.1f}', 1.0),
           Column('survival [%]', 'survival', '{:.1f}', 100.0),
           Column('median error [px]', 'error_median_px', '{:.3f}', 1.0),
           Column('worse end, median [px]', 'absolute_all_worse_end_median_px', '{:.2f}', 1.0),
           Column('worse end, 90 % [px]', 'absolute_all_worse_end_p90_px', '{:.2f}', 1.0),
           Column('normalised error', 'absolute_all_normalized_ends', '{:.2f}', 1.0)]


def main():
    for argument in sys.argv[1:]:
        tracker, path = argument.split('=', 1)
        print('## {}\n'.format(tracker))
        print_table(['motion', 'effect'] + [column.title for column in COLUMNS],
                    [[motion, effect.replace('_', ' ')] + cells(rows, COLUMNS) for (motion, effect), rows in flights_of(path).items()])


if __name__ == '__main__':
    main()
