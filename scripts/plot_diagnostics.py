#!/usr/bin/env python3
"""Plots what a tracker reports on /diagnostics, from a bag.

usage: plot_diagnostics.py IN.bag OUT.png [NAME]

NAME: of the status, or a part of it (line tracking).
"""

import sys

try:
    import matplotlib
except ImportError:
    sys.exit('plot_diagnostics.py: plots need matplotlib (Debian and Ubuntu: apt install python3-matplotlib)')
matplotlib.use('Agg')
import matplotlib.pyplot as plt  # noqa: E402 (needs the backend first)

LEVELS = {1: ('gold', 'WARN'), 2: ('red', 'ERROR'), 3: ('red', 'STALE')}
STAGES = ('pyramid', 'prior', 'flow', 'refine', 'detect', 'undistort')
PRIORS = ('imu', 'image', 'odometry', 'none')


def read(path, name):
    """Times [s], levels, and a function that gives the values of a key (NaN where it is no number)."""
    import rosbag  # late, so that the rest can be tested without ROS
    times, levels, reports = [], [], []
    with rosbag.Bag(path) as bag:
        for _, array, stamp in bag.read_messages('/diagnostics'):
            for status in array.status:
                if name in status.name:
                    times.append(stamp.to_sec())
                    levels.append(level_of(status.level))
                    reports.append({pair.key: pair.value for pair in status.values})
    if not times:
        sys.exit('plot_diagnostics.py: {} holds no status on /diagnostics whose name contains "{}"'.format(path, name))

    def values(key):
        if not any(key in report for report in reports):
            sys.exit('plot_diagnostics.py: the reports in {} have no "{}"'.format(path, key))
        return [number(report.get(key)) for report in reports]
    return [time - times[0] for time in times], levels, values


def level_of(level):
    """genpy gives a byte."""
    return level[0] if isinstance(level, bytes) else int(level)


def number(text):
    try:
        return float(text)
    except (TypeError, ValueError):
        return float('nan')


def draw(times, levels, values, path):
    figure, axes = plt.subplots(3, 2, figsize=(12, 10), sharex=True)
    rate, time, latency, lines, change, prior = axes.flat

    rate.plot(times, values('images in [Hz]'), label='images in')
    rate.plot(times, values('messages out [Hz]'), '--', label='messages out')
    rate.set_ylabel('rate [Hz]')

    time.stackplot(times, [values('time for {}, mean [ms]'.format(stage)) for stage in STAGES], labels=STAGES, alpha=0.7)
    time.plot(times, values('time per image, max [ms]'), 'k:', label='image, max')
    time.set_ylabel('time per image [ms]')

    latency.plot(times, values('latency from stamp to publishing, mean [ms]'), label='mean')
    latency.plot(times, values('latency from stamp to publishing, max [ms]'), ':', label='max')
    latency.plot(times, values('wait for imu or odometry, mean [ms]'), label='wait for sensors')
    latency.set_ylabel('latency [ms]')

    lines.plot(times, values('lines live'), label='lines')
    lines.plot(times, values('line age, mean [images]'), label='age [images]')
    lines.plot(times, values('image covered by lines [%]'), label='coverage [%]')
    lines.set_ylabel('lines')

    change.plot(times, values('lines started per image'), label='started')
    change.plot(times, values('lines lost per image'), label='lost')
    change.set_ylabel('lines per image')

    shares = [values('images predicted by {} [%]'.format(name)) for name in PRIORS]
    prior.stackplot(times, shares, labels=PRIORS, alpha=0.7)
    prior.plot(times, values('images with a known translation [%]'), 'k:', label='translation known')
    prior.set_ylabel('images by prior [%]')

    for axis in axes.flat:
        shade(axis, times, levels)
        axis.set_xlim(times[0], max(times[-1], times[0] + 1))
        if axis is not latency:  # of clocks that differ it is below zero
            axis.set_ylim(bottom=0)
        axis.legend(fontsize='small', ncol=3, loc='lower left', bbox_to_anchor=(0, 1), frameon=False)
        axis.grid(alpha=0.3)
    for axis in axes[-1]:
        axis.set_xlabel('time [s]')
    figure.tight_layout()
    figure.savefig(path, dpi=85)


def shade(axis, times, levels):
    """A report tells of the time since the one before."""
    for i in range(1, len(times)):
        if levels[i] in LEVELS:
            axis.axvspan(times[i - 1], times[i], color=LEVELS[levels[i]][0], alpha=0.2, linewidth=0)


def main(arguments):
    if len(arguments) not in (2, 3) or arguments[0] in ('-h', '--help'):
        sys.exit(__doc__.strip())
    draw(*read(arguments[0], arguments[2] if len(arguments) > 2 else 'line tracking'), arguments[1])


if __name__ == '__main__':
    main(sys.argv[1:])
