#!/usr/bin/env python3
"""Markdown tables from the CSV files of evaluate_tracks, for pages in docs/benchmarks. A module."""
import collections
import csv

# A measure of evaluate_tracks as a column; `factor` takes it to the unit of the title.
Column = collections.namedtuple('Column', 'title measure style factor')


def rows_of(path):
    with open(path, newline='') as file:
        return list(csv.DictReader(file))


def flights_of(path):
    """{(MOTION, VARIANT): a row for each seed} of bags that are named MOTION-VARIANT-SEED-TRACKER."""
    flights = {}
    for row in rows_of(path):
        flights.setdefault(tuple(row['bag'].split('-')[:2]), []).append(row)
    return flights


def mean(rows, measure):
    """Over the rows that have the measure; None: none has."""
    values = [float(row[measure]) for row in rows if row[measure]]
    return sum(values) / len(values) if values else None


def cells(rows, columns):
    """Means over the rows, as text; '-': not known."""
    values = [(mean(rows, column.measure), column) for column in columns]
    return ['-' if value is None else column.style.format(column.factor * value) for value, column in values]


def print_table(head, rows):
    """`head`: titles; `rows`: as many texts each."""
    print('| ' + ' | '.join(head) + ' |')
    print('|' + '---|' * len(head))
    for row in rows:
        print('| ' + ' | '.join(row) + ' |')
    print()
