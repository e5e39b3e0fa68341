#!/usr/bin/env python3
"""Watches the resident memory of a node that publishes /line_tracker/lines; called by soak.sh.

    watch_memory.py PID MINUTES

The first third of the time is for warming up. Fails when the peak of the last third is more than 2 % and 4 MB above
that of the second, when the process ends, or when no lines come for 20 s.
"""
import sys
import threading
import time

import rospy

SILENCE_S = 20.0


def resident_mb(pid):
    with open('/proc/{}/status'.format(pid)) as status:
        for line in status:
            if line.startswith('VmRSS:'):
                return int(line.split()[1]) / 1024.0
    raise OSError('process {} has ended'.format(pid))


def main():
    pid, seconds = int(sys.argv[1]), float(sys.argv[2]) * 60.0
    lock = threading.Lock()
    seen = {'messages': 0, 'last': time.monotonic()}

    def count(_):
        with lock:
            seen['messages'] += 1
            seen['last'] = time.monotonic()

    rospy.init_node('watch_memory', disable_signals=True)
    rospy.Subscriber('/line_tracker/lines', rospy.AnyMsg, count, queue_size=100)
    start = time.monotonic()
    peaks = [0.0, 0.0, 0.0]
    while time.monotonic() - start < seconds:
        time.sleep(0.5)
        try:
            third = min(2, int(3 * (time.monotonic() - start) / seconds))
            peaks[third] = max(peaks[third], resident_mb(pid))
        except OSError as error:
            sys.exit('soak: the node is gone: {}'.format(error))
        with lock:
            silence = time.monotonic() - seen['last']
        if silence > SILENCE_S:
            sys.exit('soak: no lines for {:.0f} s'.format(silence))
    print('soak: {} messages in {:.1f} minutes, peak memory by thirds {:.1f}, {:.1f}, {:.1f} MB'.format(
        seen['messages'], seconds / 60.0, *peaks))
    if peaks[2] > 1.02 * peaks[1] + 4.0:
        sys.exit('soak: memory grows')
    if seen['messages'] == 0:
        sys.exit('soak: no lines came')


if __name__ == '__main__':
    main()
