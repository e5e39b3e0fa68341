#!/usr/bin/env python3
"""Runs a command and tells its resident memory: at each quarter of its time, and at its peak.

    run_memory.py LABEL COMMAND [ARGUMENT ...]

Prints a row of a Markdown table in MB; fails when the command does.
"""
import os
import subprocess
import sys
import time


def resident_mb(pid):
    """Resident memory of a process, 0 when it has ended."""
    try:
        with open('/proc/{}/statm'.format(pid)) as file:
            return int(file.read().split()[1]) * os.sysconf('SC_PAGE_SIZE') / 2**20
    except (OSError, IndexError):
        return 0.0


def main():
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    process = subprocess.Popen(sys.argv[2:], stdout=subprocess.DEVNULL)
    samples = []
    while process.poll() is None:
        samples.append(resident_mb(process.pid))
        time.sleep(0.01)
    samples = [sample for sample in samples if sample > 0.0]
    if process.returncode != 0 or not samples:
        sys.exit('run_memory.py: {} ended with status {}'.format(sys.argv[2], process.returncode))
    quarters = [samples[min(len(samples) - 1, len(samples) * share // 4)] for share in (1, 2, 3, 4)]
    cells = ['{:.0f}'.format(value) for value in quarters + [max(samples)]]
    print('| {} | {} |'.format(sys.argv[1], ' | '.join(cells)))
    return 0


if __name__ == '__main__':
    sys.exit(main())
