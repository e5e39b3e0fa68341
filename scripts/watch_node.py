#!/usr/bin/env python3
"""Watches the resident memory and the ids of a node that publishes /line_tracker/lines; called by soak.sh.

    watch_node.py PID MINUTES

The first third of the time is for warming up. Fails when the peak of the last third is more than 2 MB above that of the
second (2 % and 4 MB in runs of less than 10 000 images, which may not be warm), when an id comes back after it was missing
or an age does not fit, when the process ends, or when no lines come for 20 s.
"""
import struct
import sys
import threading
import time

import rospy

SILENCE_S = 20.0
WARM_IMAGES = 10000
LINE = struct.Struct('<QI69x')  # Line.msg: id, age, and what is not looked at


def resident_mb(pid):
    with open('/proc/{}/status'.format(pid)) as status:
        for line in status:
            if line.startswith('VmRSS:'):
                return int(line.split()[1]) / 1024.0
    raise OSError('process {} has ended'.format(pid))


def parse(message):
    """Epoch, image_count and {id: age} of a serialised LineArray; an id twice is a fault of its own."""
    (frame_length,) = struct.unpack_from('<I', message, 12)
    at = 16 + frame_length
    epoch, image_count, _, _, _, lines = struct.unpack_from('<IQIIBI', message, at)
    ages = dict(LINE.iter_unpack(message[at + 25:at + 25 + lines * LINE.size]))
    if len(ages) != lines:
        raise ValueError('an id stands twice in image {} of epoch {}'.format(image_count, epoch))
    return epoch, image_count, ages


class IdRules:
    """What must hold from message to message, also where messages between them are missing."""

    def __init__(self):
        self.epoch, self.image_count, self.ages, self.gone = -1, 0, {}, set()
        self.images = self.epochs = self.missed = 0

    def add(self, message):
        epoch, image_count, ages = parse(message)
        where = 'image {} of epoch {}'.format(image_count, epoch)
        self.images += 1
        if epoch != self.epoch:
            self.epochs += 1
            self.gone = set()
        else:
            step = image_count - self.image_count
            if step < 1:
                raise ValueError(where + ' came after image {}'.format(self.image_count))
            self.missed += step - 1
            if not self.gone.isdisjoint(ages):
                raise ValueError(where + ' has an id that was missing before')
            if any(age != self.ages[track] + step for track, age in ages.items() if track in self.ages):
                raise ValueError(where + ' has an age that does not fit')
            self.gone.update(track for track in self.ages if track not in ages)
        self.epoch, self.image_count, self.ages = epoch, image_count, ages


def main():
    pid, seconds = int(sys.argv[1]), float(sys.argv[2]) * 60.0
    lock = threading.Lock()
    rules = IdRules()
    faults = []
    last = [time.monotonic()]

    def take(message):
        with lock:
            last[0] = time.monotonic()
            try:
                rules.add(message._buff)
            except ValueError as fault:
                faults.append(str(fault))

    rospy.init_node('watch_node', disable_signals=True)
    rospy.Subscriber('/line_tracker/lines', rospy.AnyMsg, take, queue_size=1000)
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
            silence = time.monotonic() - last[0]
            fault = faults[0] if faults else ''
        if fault:
            sys.exit('soak: ' + fault)
        if silence > SILENCE_S:
            sys.exit('soak: no lines for {:.0f} s'.format(silence))
    print('soak: {} images in {} epochs ({} more did not arrive here) in {:.1f} minutes, peak memory by thirds '
          '{:.1f}, {:.1f}, {:.1f} MB'.format(rules.images, rules.epochs, rules.missed, seconds / 60.0, *peaks))
    allowed_mb = 2.0 if rules.images >= WARM_IMAGES else 0.02 * peaks[1] + 4.0
    if peaks[2] > peaks[1] + allowed_mb:
        sys.exit('soak: memory grows')
    if rules.images == 0:
        sys.exit('soak: no lines came')


if __name__ == '__main__':
    main()
