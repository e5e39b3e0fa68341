#!/usr/bin/env python3
"""Prints what sanitizers have written about the code of this project; called by sanitize.sh.

    sanitizer_reports.py FOLDER_OF_REPORTS BUILD

Fails when there is something. Of the reports of ThreadSanitizer those count in which code of this project is at work,
itself or by the standard library, Eigen or OpenCV: roscpp is built without it, so it does not see how the messages and the
counts of their boost::shared_ptr are handed from thread to thread. Addresses in libraries that were loaded later are given
lines of the sources.
"""
import functools
import glob
import os
import re
import subprocess
import sys

OWN = re.compile(r'(^|[ /])(src/(core|ros)|include/tet_line_tracker|test)/')
TRANSPARENT = re.compile(r'libtsan\.so|/usr/include/(c\+\+|eigen3|opencv4)/|/usr/lib/gcc/')
FREEING = re.compile(r'operator delete|free ')
LOCKING = re.compile(r'pthread_mutex_')
OF_OPENCV = re.compile(r'\(libopencv_')
COUNTED = re.compile(r'(<null> )?boost::detail::sp_counted')
FRAME = re.compile(r'^ +#\d+ (.*)$')
ADDRESS = re.compile(r'<null> \((libtet_line_tracker\S+?)\+(0x[0-9a-f]+)\)')


def read(path):
    with open(path, errors='replace') as file:
        return file.read()


def reports_of_threads(text):
    return [part for part in re.split(r'^={18,}$', text, flags=re.MULTILINE) if 'WARNING: ThreadSanitizer' in part]


@functools.lru_cache(maxsize=None)
def source_line(build, library, address):
    paths = glob.glob(os.path.join(build, 'devel', 'lib', '**', library), recursive=True)
    if not paths:
        return None
    found = subprocess.run(['addr2line', '-Cfpe', paths[0], address], stdout=subprocess.PIPE, check=False)
    return found.stdout.decode(errors='replace').strip() or None


def with_lines(report, build):
    """The report with the source line of each frame that has only an address in a library of the build."""
    return ADDRESS.sub(lambda m: source_line(build, m.group(1), m.group(2)) or m.group(0), report)


def stacks(report):
    """For each access and each lock that is taken: its innermost frame, and the one that says who is at work."""
    found = []
    frames = None
    for line in report.splitlines():
        frame = FRAME.match(line)
        if frame and frames is not None:
            frames.append(frame.group(1))
        elif not frame:
            # Where threads and locks were made says nothing about who is at work.
            access = re.match(r'^  (Previous |Atomic |Write |Read |Mutex M\d+ acquired)', line, re.IGNORECASE)
            frames = [] if access else None
            if access:
                found.append(frames)
    return [(each[0], next((frame for frame in each if not TRANSPARENT.search(frame)), '')) for each in found if each]


def is_own(report):
    """Whether code of this project is at work in one of the stacks, and none frees what a boost::shared_ptr held.

    Messages are freed where the last pointer to them goes, mostly in roscpp, whose counting is not seen: the freeing looks
    like a race with whoever read the message before. AddressSanitizer sees those who would read it after. Nor does one count with
    a lock that OpenCV took: it lay on the stack of the caller, whose place is used anew when OpenCV's threads are done.
    """
    both = stacks(report)
    if any(FREEING.match(inner) and COUNTED.match(worker) for inner, worker in both):
        return False
    if any(LOCKING.match(inner) and OF_OPENCV.search(worker) for inner, worker in both):
        return False
    return any(OWN.search(worker) for _, worker in both)


def findings(folder, build):
    found = []
    for path in sorted(glob.glob(os.path.join(folder, 'thread.*'))):
        found += [each for each in (with_lines(report, build) for report in reports_of_threads(read(path))) if is_own(each)]
    for path in sorted(glob.glob(os.path.join(folder, 'address.*')) + glob.glob(os.path.join(folder, 'undefined.*'))):
        found.append(read(path))
    return found


def main():
    found = findings(sys.argv[1], sys.argv[2])
    for report in found:
        print(report)
    if found:
        sys.exit('sanitizers: {} reports'.format(len(found)))


if __name__ == '__main__':
    main()
