"""Which room of the sources may use which: the drawing in docs/architecture.md against the includes.

A room is a folder of src/, and within the core a folder of src/core/ with the one of the same name in
include/tet_line_tracker/. Everything here takes the sources as a dictionary of contents by file name.
"""
import collections
import posixpath
import re

DRAWING = 'docs/architecture.md'
CORE = 'src/core/CMakeLists.txt'
PUBLIC = 'include/tet_line_tracker/'
ROS = 'ROS'

MAX_LINES_IN_CORE = 400
MAX_LINES = {'src/core/tracking/line_tracker.cpp': 249}

# Only the factory, the parameter's own definition, and defaults of options may know the name of a method.
METHOD_NAME = re.compile(r'"(?:paper|joint)"|\bmethod\s*[=!]=')
KNOWS_METHODS = ('src/core/tracking/tracking_method.cpp', 'src/core/parameters/parameters.cpp',
                 PUBLIC + 'parameters/parameters.h')
OPTION_DEFAULT = 'default_value('

INCLUDE = re.compile(r'^\s*#\s*include\s*(["<])([^">]+)[">]', re.MULTILINE)


def core_tests(cmake):
    """Names of the tests of each room of the core, from the ground up, as its CMakeLists.txt registers them."""
    tests = collections.OrderedDict()
    for room, words in re.findall(r'^tet_room\((\w+)([^)]*)\)', cmake, re.MULTILINE):
        tests[room] = words.partition('TESTS')[2].split()
    return tests


def drawn_rooms(page):
    """Rooms from top to bottom, each with those it may use, from the first code block under "Rooms of the core"."""
    match = re.search(r'^## Rooms of the core\n.*?^```\n(.*?)^```', page, re.MULTILINE | re.DOTALL)
    if match is None:
        raise RuntimeError('{}: no drawing under "Rooms of the core"'.format(DRAWING))
    rooms = collections.OrderedDict()
    for line in match.group(1).splitlines():
        room, _, used = line.partition('->')
        rooms[room.strip()] = used.split()
    return rooms


def is_source(name):
    return name.endswith(('.cpp', '.h')) and name.startswith(('src/', PUBLIC))


def is_core(name):
    return name.startswith(('src/core/', PUBLIC))


def room_of(name):
    """The room of a file: src/ROOM, or the name of the room within the core."""
    if name.startswith(PUBLIC):
        return name[len(PUBLIC):].split('/')[0]
    parts = name.split('/')
    return parts[2] if parts[1] == 'core' else 'src/' + parts[1]


class Includes:
    """Finds the room of what a file includes."""

    def __init__(self, files, core_rooms):
        self.files = files
        self.core_rooms = core_rooms
        words = re.search(r'find_package\(catkin REQUIRED COMPONENTS([^)]*)\)', files.get('CMakeLists.txt', ''))
        self.ros_packages = {'ros'} | set(words.group(1).split() if words else ())

    def of(self, name):
        """Line and room of each include of the project or of ROS."""
        for match in INCLUDE.finditer(self.files[name]):
            room = self.room(name, match.group(2))
            if room is not None:
                yield self.files[name].count('\n', 0, match.start(2)) + 1, room

    def room(self, name, included):
        first = included.split('/')[0]
        for folder in (posixpath.dirname(name), 'src/core', 'src', 'include'):
            found = posixpath.normpath(posixpath.join(folder, included))
            if found in self.files:
                return room_of(found)
        if first == 'tet_line_tracker':
            second = included.split('/')[1]
            return second if second in self.core_rooms else ROS  # a message
        if first in self.ros_packages or re.search(r'_(msgs|srvs)$', first):
            return ROS
        return None  # of the own room by its include folder, or of a library


def check_order(files):
    """Complaints about the drawing itself: rows that use rooms above them, rooms in another order than CMake's."""
    rooms = drawn_rooms(files[DRAWING])
    names = list(rooms) + [ROS]
    for number, (room, used) in enumerate(rooms.items()):
        for other in used:
            if other not in names:
                yield '{}: {} uses {}, which is not drawn'.format(DRAWING, room, other)
            elif names.index(other) <= number:
                yield '{}: {} uses {}, which is not below it'.format(DRAWING, room, other)
    drawn = [room for room in rooms if not room.startswith('src/')]
    registered = list(core_tests(files[CORE]))
    if drawn != registered[::-1]:
        yield '{} draws the rooms {}, {} registers, from the top, {}'.format(
            DRAWING, ' '.join(drawn), CORE, ' '.join(registered[::-1]))


def check_includes(files):
    """Complaints about includes that the drawing does not allow, and about uses in it that there are no longer."""
    rooms = drawn_rooms(files[DRAWING])
    core_rooms = [room for room in rooms if not room.startswith('src/')]
    includes = Includes(files, core_rooms)
    used = collections.defaultdict(set)
    for name in sorted(filter(is_source, files)):
        room = room_of(name)
        if room not in rooms:
            yield '{}: the room {} is not in the drawing of {}'.format(name, room, DRAWING)
            continue
        for line, other in includes.of(name):
            if other in core_rooms and not is_core(name):
                other = 'src/core'
            if other == room:
                continue
            used[room].add(other)
            if other not in rooms[room]:
                yield '{}:{}: {} may not use {} ({}, "Rooms of the core")'.format(name, line, room, other, DRAWING)
    for room in rooms:
        for other in rooms[room]:
            if other not in used[room]:
                yield '{}: {} does not use {}'.format(DRAWING, room, other)


def check_sizes(files):
    """Complaints about files of the core that are too long."""
    for name in sorted(name for name in files if is_source(name) and is_core(name)):
        count = files[name].count('\n')
        limit = MAX_LINES.get(name, MAX_LINES_IN_CORE)
        if count > limit:
            yield '{} has {} lines, more than {}'.format(name, count, limit)


def check_method_names(files):
    """Complaints about parts that ask for the name of the method they serve."""
    for name in sorted(filter(is_source, files)):
        if name in KNOWS_METHODS:
            continue
        for number, line in enumerate(files[name].splitlines(), 1):
            if METHOD_NAME.search(line) and OPTION_DEFAULT not in line:
                yield '{}:{}: asks for the name of a method: {}'.format(name, number, line.strip())


def complaints(files):
    """All complaints, none when the sources keep the rules."""
    return [complaint for check in (check_order, check_includes, check_sizes, check_method_names)
            for complaint in check(files)]


def read_sources(names):
    """What complaints() needs of the project's files."""
    needed = [name for name in names if is_source(name) or name in (DRAWING, CORE, 'CMakeLists.txt')]
    files = {}
    for name in needed:
        with open(name, encoding='utf-8') as file:
            files[name] = file.read()
    return files
