#!/usr/bin/env python3
"""Tests of the plot of /diagnostics.   plot_diagnostics_test.py [RESULT.xml]"""
import os
import subprocess
import sys
import tempfile
import unittest

import cases

try:
    import matplotlib  # noqa: F401 (only whether it is there)
    import rosbag
    import rospy
    from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
except ImportError as error:
    raise SystemExit('plot_diagnostics_test.py: {}'.format(error))

SCRIPT = cases.ROOT + '/scripts/plot_diagnostics.py'


def keys():
    """All that the plot draws."""
    import plot_diagnostics
    names = []
    plot_diagnostics.shade = lambda *arguments: None

    def collect(key):
        names.append(key)
        return [0.0, 1.0]
    with tempfile.TemporaryDirectory() as folder:
        plot_diagnostics.draw([0.0, 1.0], [0, 0], collect, folder + '/plot.png')
    return names


class Plot(unittest.TestCase):
    def plot(self, names, *arguments, levels=(0, 1, 2, 0)):
        """Exit status, output and whether there is a picture, of a bag with a report per level."""
        with tempfile.TemporaryDirectory() as folder:
            with rosbag.Bag(folder + '/in.bag', 'w') as bag:
                for second, level in enumerate(levels):
                    status = DiagnosticStatus(level=level, name='tracker: line tracking',
                                              values=[KeyValue(name, str(second)) for name in names])
                    stamp = rospy.Time(1000 + second)
                    bag.write('/diagnostics', DiagnosticArray(status=[status]), stamp)
            done = subprocess.run([sys.executable, SCRIPT, folder + '/in.bag', folder + '/out.png', *arguments],
                                  stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
            return done.returncode, done.stdout.decode(), os.path.exists(folder + '/out.png')

    def test_draws_a_bag_of_reports(self):
        self.assertEqual(self.plot(keys()), (0, '', True))

    def test_names_the_key_that_no_report_has(self):
        names = [name for name in keys() if name != 'lines live']
        status, output, drawn = self.plot(names)
        self.assertEqual((status, drawn), (1, False))
        self.assertIn('have no "lines live"', output)

    def test_says_when_the_bag_has_no_such_status(self):
        status, output, drawn = self.plot(keys(), 'camera driver')
        self.assertEqual((status, drawn), (1, False))
        self.assertIn('no status on /diagnostics whose name contains "camera driver"', output)


if __name__ == '__main__':
    cases.run(Plot)
