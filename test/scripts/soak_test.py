#!/usr/bin/env python3
"""Tests of the rules that soak.sh holds messages against.   soak_test.py [RESULT.xml]"""
import struct
import sys
import types
import unittest

import cases

sys.modules.setdefault('rospy', types.ModuleType('rospy'))  # only its subscriber needs ROS
import watch_node  # noqa: E402


def message(epoch, image_count, ages):
    """A serialised LineArray with these lines: [(id, age)]."""
    head = struct.pack('<III', 0, 1, 2) + struct.pack('<I', 4) + b'cam0'
    body = struct.pack('<IQIIBI', epoch, image_count, 640, 480, 0, len(ages))
    return head + body + b''.join(struct.pack('<QI', *line) + bytes(69) for line in ages)


class IdRules(unittest.TestCase):
    def check(self, *messages):
        rules = watch_node.IdRules()
        for arguments in messages:
            rules.add(message(*arguments))
        return rules

    def test_a_good_stream_is_counted_with_its_gaps_and_epochs(self):
        rules = self.check((0, 1, [(1, 1), (2, 1)]), (0, 2, [(1, 2), (3, 1)]), (0, 5, [(1, 5)]), (1, 1, [(1, 1)]))
        self.assertEqual((rules.images, rules.epochs, rules.missed), (4, 2, 2))

    def test_an_id_that_comes_back_is_a_fault(self):
        with self.assertRaisesRegex(ValueError, 'image 3 of epoch 0 has an id that was missing'):
            self.check((0, 1, [(1, 1)]), (0, 2, []), (0, 3, [(1, 3)]))

    def test_an_id_twice_is_a_fault(self):
        with self.assertRaisesRegex(ValueError, 'twice'):
            self.check((0, 1, [(1, 1), (1, 1)]))

    def test_an_age_that_does_not_fit_is_a_fault(self):
        with self.assertRaisesRegex(ValueError, 'age'):
            self.check((0, 1, [(1, 1)]), (0, 3, [(1, 2)]))

    def test_an_image_that_comes_twice_is_a_fault(self):
        with self.assertRaisesRegex(ValueError, 'came after'):
            self.check((0, 7, []), (0, 7, []))


if __name__ == '__main__':
    cases.run(IdRules)
