#!/usr/bin/env python3
"""Tables of docs/benchmarks/lens.md from the CSV files of evaluate_tracks --absolute, one per tracker.

  lens_table.py TRACKER=FILE.csv ...

Bags are named LENS-MOTION-TRACKER."""
import sys

from measures_table import print_table, rows_of

CLASSES = ["30_60", "60_100", "100_160", "160_250", "250_up"]
TITLES = ["30-60 px", "60-100 px", "100-160 px", "160-250 px", "over 250 px"]
LENSES = ["pinhole", "euroc", "tum_fr1", "equidistant", "mei"]
MOTIONS = ["slow", "fast", "corridor", "shake"]
FEWEST = 50  # judged lines of a cell


def read(path):
    return {tuple(row["bag"].split("-")[:2]): row for row in rows_of(path)}


def value(row, length, name):
    """A measure of a class of length, or None where too few lines were judged."""
    if int(row["absolute_%s_judged" % length]) < FEWEST:
        return None
    text = row["absolute_%s_%s" % (length, name)]
    return float(text) if text else None


def cell(median, ninety):
    return "-" if median is None else "%.2f / %.2f" % (median, ninety)


def worst_over_motions(rows, lens, length):
    values = [(value(rows[lens, motion], length, "worse_end_median_px"), value(rows[lens, motion], length, "worse_end_p90_px"))
              for motion in MOTIONS if (lens, motion) in rows]
    known = [pair for pair in values if pair[0] is not None]
    return (max(median for median, _ in known), max(ninety for _, ninety in known)) if known else (None, None)


def main():
    trackers = dict(argument.split("=", 1) for argument in sys.argv[1:])
    measured = {name: read(path) for name, path in trackers.items()}
    print("Worse end, median / 90 % [px], the largest of " + ", ".join(MOTIONS) + ":\n")
    print_table(["lens", "lines"] + TITLES,
               [[lens, name] + [cell(*worst_over_motions(rows, lens, length)) for length in CLASSES]
                for lens in LENSES for name, rows in measured.items() if any((lens, motion) in rows for motion in MOTIONS)])
    print("Worse end, median / 90 % [px]:\n")
    print_table(["lens, motion", "lines"] + TITLES + ["lines per image", "px", "lines per edge"],
               [["%s, %s" % (lens, motion), name] +
                [cell(value(rows[lens, motion], length, "worse_end_median_px"),
                      value(rows[lens, motion], length, "worse_end_p90_px")) for length in CLASSES] +
                ["%.0f" % float(rows[lens, motion]["lines_per_image"]),
                 "%.0f" % float(rows[lens, motion]["line_length_px"]),
                 "%.2f" % float(rows[lens, motion]["tracks_per_edge"])]
                for lens in LENSES for motion in MOTIONS for name, rows in measured.items() if (lens, motion) in rows])
    name, rows = next(iter(measured.items()))
    print("Normalised error of both ends, %s:\n" % name)
    print_table(["lens, motion"] + TITLES + ["all"],
               [["%s, %s" % (lens, motion)] +
                ["-" if value(rows[lens, motion], length, "normalized_ends") is None
                 else "%.2f" % value(rows[lens, motion], length, "normalized_ends") for length in CLASSES + ["all"]]
                for lens in LENSES for motion in MOTIONS if (lens, motion) in rows])


if __name__ == "__main__":
    main()
