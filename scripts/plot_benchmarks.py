#!/usr/bin/env python3
"""Draws the figures of docs/benchmarks.md from the tables in docs/benchmarks/; called by plot_benchmarks.sh.

usage: plot_benchmarks.py FOLDER_OF_TABLES FOLDER_OF_FIGURES
"""

import os
import statistics
import sys

import matplotlib
matplotlib.use('Agg')
import matplotlib.pyplot as plt  # noqa: E402 (needs the backend first)
from matplotlib.text import Text  # noqa: E402
from matplotlib.transforms import Bbox  # noqa: E402

TRACKERS = {
    'joint': ('default (joint)', 'o', '#1565c0'),
    'lk_endpoints': ("LSD + OpenCV's LK on the endpoints", 's', '#ef6c00'),
    'lsd_lbd_knn': ('LSD + LBD + KNN', '^', '#757575'),
}
LINKS = '#d9d9d9'
# Tables give two digits: no share of errors can be told from this one.
SMALLEST_SHARE = 0.005


def table_of(path, *columns):
    """Rows, as dictionaries, of the first Markdown table whose first columns have these names."""
    head = None
    rows = []
    with open(path) as file:
        for line in file:
            if not line.startswith('|'):
                if head:
                    return rows
                continue
            cells = [cell.strip() for cell in line.strip().strip('|').split('|')]
            if head is None:
                if cells[:len(columns)] == list(columns):
                    head = cells
            elif set(cells[0]) != {'-'}:
                rows.append(dict(zip(head, cells)))
    if not rows:
        sys.exit('plot_benchmarks.py: {} holds no table with the first columns "{}"'.format(path, ', '.join(columns)))
    return rows


def number(cell):
    return float(cell.rstrip(' %'))


def place_labels(axes, labels):
    """Writes each text beside its point, where it covers no point and no other text; a thin line leads to one that is far away."""
    axes.figure.canvas.draw()
    renderer = axes.figure.canvas.get_renderer()
    taken = []
    for x, y, _, _ in labels:
        column, row = axes.transData.transform((x, y))
        taken.append(Bbox.from_extents(column - 6, row - 6, column + 6, row + 6))
    offsets = [(8, -3, 'left'), (0, 8, 'center'), (0, -14, 'center'), (-8, -3, 'right'), (10, 9, 'left'), (-10, 9, 'right'),
               (10, -15, 'left'), (-10, -15, 'right')]
    offsets += [(dx, dy, side) for dy in (18, -24, 30, -36)
                for dx, side in ((0, 'center'), (14, 'left'), (-14, 'right'))]
    for x, y, text, colour in sorted(labels):
        for dx, dy, side in offsets:
            far = abs(dy) > 15
            note = axes.annotate(text, (x, y), xytext=(dx, dy), textcoords='offset points', fontsize=8, color=colour, ha=side,
                                 arrowprops={'arrowstyle': '-', 'color': colour, 'linewidth': 0.5} if far else None)
            box = note.get_window_extent(renderer) if not far else Text.get_window_extent(note, renderer)
            if not any(box.overlaps(other) for other in taken) or (dx, dy, side) == offsets[-1]:
                break
            note.remove()
        taken.append(box)


def plot_tracks(rows, path):
    """Line pairs within 2 px of the truth over images per track: one point per flight and tracker, means over seeds."""
    values = {}
    for row in rows:
        regime = row['flight'].split(',')[0]
        values.setdefault((regime, row['tracker']), []).append(
            (number(row['images per track']), number(row['under 2 px'])))
    means = {key: tuple(statistics.mean(column) for column in zip(*pairs)) for key, pairs in values.items()}

    figure, axes = plt.subplots(figsize=(9, 4.8))
    axes.set_xscale('log')
    axes.set_yscale('log')
    axes.set_ylim(20, 0.002)
    axes.set_xlim(1, 200)
    labels = []
    for (regime, tracker), (length, inliers) in means.items():
        _, marker, colour = TRACKERS[tracker]
        outliers = max(SMALLEST_SHARE, 100.0 - inliers)
        axes.plot(length, outliers, marker, color=colour, markersize=7, zorder=3)
        labels.append((length, outliers, regime, colour))
    for tracker, (name, marker, colour) in TRACKERS.items():
        axes.plot([], [], marker, color=colour, markersize=7, label=name)
    axes.set_xlabel('mean track length [images]')
    axes.set_ylabel('line pairs within 2 px of the truth')
    axes.set_yticks([20, 10, 5, 2, 1, 0.5, 0.2, 0.1, 0.05, 0.02, 0.01, SMALLEST_SHARE])
    axes.set_yticklabels(['80 %', '90 %', '95 %', '98 %', '99 %', '99.5 %', '99.8 %', '99.9 %', '99.95 %', '99.98 %',
                          '99.99 %', '100 %'])
    axes.set_xticks([1, 2, 5, 10, 20, 50, 100, 200])
    axes.set_xticklabels(['1', '2', '5', '10', '20', '50', '100', '200'])
    axes.minorticks_off()
    axes.grid(color='#eeeeee')
    axes.set_axisbelow(True)
    axes.legend(fontsize=8, loc='lower right')
    figure.tight_layout()
    place_labels(axes, labels)
    save(figure, path)


def plot_times(rows, path):
    """Median, mean and 99th percentile of each front end; the ratio of the means beside them."""
    figure, axes = plt.subplots(figsize=(9, 3))
    slowest = max(number(row['p99']) for row in rows)
    for i, row in enumerate(rows):
        median, mean, p99 = (number(row[key]) for key in ('median', 'mean', 'p99'))
        axes.plot([median, p99], [i, i], color=LINKS, linewidth=5, solid_capstyle='butt', zorder=1)
        axes.plot(median, i, '|', color='#1565c0', markersize=12, markeredgewidth=2, zorder=3)
        axes.plot(mean, i, 'o', color='#1565c0', markersize=7, zorder=3)
        axes.plot(p99, i, '|', color='#c62828', markersize=12, markeredgewidth=2, zorder=3)
        axes.annotate('mean {:.2f} ms, {:.0f}x, {} lines'.format(mean, number(row['ratio']), row['lines per image']),
                      (1.3 * slowest, i), fontsize=8, va='center')
    axes.plot([], [], '|', color='#1565c0', markersize=12, markeredgewidth=2, label='median')
    axes.plot([], [], 'o', color='#1565c0', markersize=7, label='mean')
    axes.plot([], [], '|', color='#c62828', markersize=12, markeredgewidth=2, label='99th percentile')
    axes.set_xscale('log')
    axes.set_xlim(0.1, 18.0 * slowest)
    axes.set_xticks([0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 40])
    axes.set_xticklabels(['0.1', '0.2', '0.5', '1', '2', '5', '10', '20', '40'])
    axes.minorticks_off()
    axes.set_xlabel('time per 752x480 image on one thread [ms]')
    axes.set_yticks(range(len(rows)))
    axes.set_yticklabels([row['front end'] for row in rows])
    axes.set_ylim(len(rows) - 0.5, -0.5)
    axes.grid(axis='x', color='#eeeeee')
    axes.set_axisbelow(True)
    axes.legend(fontsize=8, loc='lower left', bbox_to_anchor=(0.01, 0.66))
    figure.tight_layout()
    save(figure, path)


def save(figure, path):
    # Without the version of matplotlib in it, the same tables give the same file.
    figure.savefig(path, dpi=100, metadata={'Software': None})
    plt.close(figure)
    print('wrote ' + path)


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__.strip())
    tables, folder = sys.argv[1:]
    os.makedirs(folder, exist_ok=True)
    plot_tracks(table_of(os.path.join(tables, 'tracking.md'), 'flight', 'tracker'), os.path.join(folder, 'tracks.png'))
    plot_times(table_of(os.path.join(tables, 'speed.md'), 'front end'), os.path.join(folder, 'times.png'))


if __name__ == '__main__':
    main()
