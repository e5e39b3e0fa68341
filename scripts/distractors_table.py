#!/usr/bin/env python3
"""Tables of docs/benchmarks/distractors.md from the CSV files of evaluate_tracks --surfaces, one per tracker.

  distractors_table.py TRACKER=FILE.csv ...

Bags are named MOTION-DISTRACTORS-SEED-TRACKER; the mean over the seeds is printed, a row for each kind of surface that has lines."""
import sys

from measures_table import Column, cells, flights_of, mean, print_table

SURFACES = ['solid', 'round', 'cable', 'foliage', 'person', 'mirror', 'screen']


def columns_of(surface):
    prefix = 'surface_{}_'.format(surface)
    return [Column('share of lines [%]', prefix + 'line_share', '{:.1f}', 100.0),
            Column('tracks', prefix + 'tracks', '{:.0f}', 1.0),
            Column('images per track', prefix + 'track_length', '{:.1f}', 1.0),
            Column('under 2 px [%]', prefix + 'inlier_ratio_2px', '{:.2f}', 100.0)]


def rows_by_surface(flights):
    """`flights`: {(motion, distractors): a row of evaluate_tracks for each seed}."""
    return [[motion, distractors.replace('_', ' '), surface] + cells(rows, columns_of(surface))
            for (motion, distractors), rows in flights.items() for surface in SURFACES
            if mean(rows, 'surface_{}_tracks'.format(surface))]


def main():
    for argument in sys.argv[1:]:
        tracker, path = argument.split('=', 1)
        print('## {}\n'.format(tracker))
        print_table(['motion', 'distractors', 'lines on'] + [column.title for column in columns_of('')], rows_by_surface(flights_of(path)))


if __name__ == '__main__':
    main()
