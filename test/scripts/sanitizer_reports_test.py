#!/usr/bin/env python3
"""Tests of what counts among the reports of sanitizers.   sanitizer_reports_test.py [RESULT.xml]"""
import os
import tempfile
import unittest

import cases
import sanitizer_reports

RACE = '''==================
WARNING: ThreadSanitizer: data race (pid=1)
  Write of size 8 at 0x7b by thread T1:
    #0 memmove <null> (libtsan.so.2+0x8b)
    #1 std::deque<int>::push_back(int) /usr/include/c++/12/bits/stl_deque.h:1 (nodelet+0x1)
    #2 {}
    #3 tet_line_tracker::LineTrackerNodelet::work() ../../src/ros/line_tracker_nodelet.cpp:3 (nodelet+0x2)
  Thread T1 (tid=1, running) created by main thread at:
    #0 main ../../src/ros/line_tracker_node.cpp:5 (line_tracker+0x1)
SUMMARY: ThreadSanitizer: data race
==================
'''


class Reports(unittest.TestCase):
    def findings(self, **files):
        with tempfile.TemporaryDirectory() as folder:
            for name, text in files.items():
                with open(os.path.join(folder, name.replace('_', '.')), 'w') as file:
                    file.write(text)
            return sanitizer_reports.findings(folder, folder)

    def test_a_race_in_which_this_project_is_at_work_counts(self):
        own = RACE.format('tet_line_tracker::NewestQueue::push() ../../src/ros/newest_queue.h:3 (nodelet+0x2)')
        found = self.findings(thread_17=own + RACE.format('ros::Publisher::publish() <null> (libroscpp.so+0x4)'))
        self.assertEqual(len(found), 1)
        self.assertIn('NewestQueue::push', found[0])

    def test_a_race_within_ros_that_this_project_calls_does_not_count(self):
        for frame in ('ros::Publisher::publish() <null> (libroscpp.so+0x4)',
                      'boost::detail::sp_counted_base::release() /usr/include/boost/smart_ptr/detail/x.hpp:1 (nodelet+0x4)'):
            self.assertEqual(self.findings(thread_1=RACE.format(frame)), [])

    def test_the_freeing_of_a_message_by_its_shared_pointer_does_not_count(self):
        freed = '''==================
WARNING: ThreadSanitizer: data race (pid=1)
  Write of size 8 at 0x7b by thread T1:
    #0 operator delete(void*) <null> (libtsan.so.2+0x8b)
    #1 {} (libroscpp.so+0x4)
  Previous read of size 8 at 0x7b by thread T2:
    #0 tet_line_tracker::toLineFrame() ../../src/ros/messages.cpp:57 (nodelet+0x2)
==================
'''
        self.assertEqual(self.findings(thread_1=freed.format('boost::detail::sp_counted_base::release() <null>')), [])
        self.assertEqual(len(self.findings(thread_1=freed.format('tet_line_tracker::drop() ../../src/ros/a.cpp:1'))), 1)

    def test_a_lock_of_opencv_that_lay_on_the_stack_does_not_count(self):
        used_anew = '''==================
WARNING: ThreadSanitizer: data race (pid=1)
  Write of size 8 at 0x7b by main thread:
    #0 memset <null> (libtsan.so.2+0x8b)
    #1 tet_line_tracker::GradientImage::levels() const ../../src/core/image/gradient_image.cpp:38 (core+0x2)
  Previous atomic read of size 1 at 0x7b by thread T1:
    #0 pthread_mutex_lock <null> (libtsan.so.2+0x8b)
    #1 {}
==================
'''
        self.assertEqual(self.findings(thread_1=used_anew.format('<null> <null> (libopencv_imgproc.so.406+0xb)')), [])
        self.assertEqual(len(self.findings(thread_1=used_anew.format('tet_line_tracker::Pool::run() ../../src/core/pool.cpp:1'))), 1)

    def test_every_report_of_addresses_and_undefined_behaviour_counts(self):
        self.assertEqual(len(self.findings(address_7='ERROR: AddressSanitizer', undefined_8='runtime error')), 2)


if __name__ == '__main__':
    cases.run(Reports)
