#!/usr/bin/env python3
"""Plots of evaluate_tracks: error histogram, survival over age, lines over time.

usage: plot_evaluation.py EVALUATION.json FOLDER
"""

import json
import os
import sys

try:
    import matplotlib
except ImportError:
    sys.exit('plot_evaluation.py: plots need matplotlib (Debian and Ubuntu: apt install python3-matplotlib)')
matplotlib.use('Agg')
import matplotlib.pyplot as plt  # noqa: E402 (needs the backend first)


def plot_errors(bags, path):
    """Share of line pairs over their frame-to-frame error; no file without truth."""
    figure, axes = plt.subplots(figsize=(6, 4))
    drawn = False
    for bag in bags:
        histogram = bag['error_histogram']
        total = sum(histogram['counts'])
        if total == 0:
            continue
        edges = [i * histogram['bin_px'] for i in range(len(histogram['counts']) + 1)]
        # The last bin holds everything beyond the axis.
        axes.step(edges[:-2], [100.0 * count / total for count in histogram['counts'][:-1]], where='post', label=bag['bag'])
        drawn = True
    axes.set_yscale('log')
    axes.set_xlabel('frame-to-frame error [px]')
    axes.set_ylabel('line pairs per 0.05 px [%]')
    axes.axvline(2.0, color='gray', linestyle=':')
    finish(figure, axes, path if drawn else None)


def plot_survival(bags, path):
    """Share of the segments in view that a track still covers, over its age; no file without truth."""
    figure, axes = plt.subplots(figsize=(6, 4))
    drawn = False
    for bag in bags:
        # Few tracks are in view for very long: their share says nothing.
        points = [(age + 2, 100.0 * covered / in_view)
                  for age, (covered, in_view) in enumerate(zip(bag['survival_covered'], bag['survival_in_view']))
                  if in_view >= 10]
        if not points:
            continue
        axes.plot(*zip(*points), label=bag['bag'])
        drawn = True
    axes.set_xlabel('images since detection, the first included')
    axes.set_ylabel('segments in view with drift < 2 px [%]')
    axes.set_ylim(0, 101)
    finish(figure, axes, path if drawn else None)


def plot_lines(bags, path):
    figure, axes = plt.subplots(figsize=(6, 4))
    for bag in bags:
        axes.plot(bag['seconds'], bag['lines'], label=bag['bag'])
    axes.set_xlabel('time [s]')
    axes.set_ylabel('lines in the image')
    axes.set_ylim(bottom=0)
    finish(figure, axes, path)


def finish(figure, axes, path):
    """Saves the figure unless there is no path for it."""
    if path is not None:
        axes.grid(alpha=0.3)
        axes.legend(fontsize=7)
        figure.tight_layout()
        figure.savefig(path, dpi=100)
    plt.close(figure)


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__.strip())
    with open(sys.argv[1]) as file:
        bags = json.load(file)
    folder = sys.argv[2]
    os.makedirs(folder, exist_ok=True)
    plot_errors(bags, os.path.join(folder, 'errors.png'))
    plot_survival(bags, os.path.join(folder, 'survival.png'))
    plot_lines(bags, os.path.join(folder, 'lines.png'))


if __name__ == '__main__':
    main()
