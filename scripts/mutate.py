#!/usr/bin/env python3
"""Makes the mutations of mutations.txt one at a time and runs the tests of the core; called by mutate.sh.

    mutate.py --list
    mutate.py FOLDER [NUMBER ...]

FOLDER gets a copy of the source folder and a build of it. The core is a shared library there, so that a mutant of it costs
one object file, one link and the tests. Those of the mutated room run first; where none of them fails, those of the
rooms above it, up to the first room in which one does. Outside of the core the table names the tests of a mutation.
"""
import collections
import os
import re
import shutil
import subprocess
import sys

import lint
import rooms

TABLE = 'scripts/mutations.txt'
TIMEOUT_S = 300  # of a test program; some mutants never end
MAX_SHOWN = 4  # tests that notice a mutation

Mutation = collections.namedtuple('Mutation', 'number file tests purpose old new')


class Failure(Exception):
    pass


def mutations():
    """The blocks of the table, numbered from 1; each must fit its file exactly once."""
    with open(TABLE) as file:
        lines = [line.rstrip('\n') for line in file if not line.startswith('#')]
    found = []
    for block in re.split(r'\n{2,}', '\n'.join(lines).strip()):
        match = re.fullmatch(r'(src/[\w/]+\.cpp)(?: \[([\w ]+)\])?: (.+)\n- (.+)\n\+ ?(.*)', block)
        if match is None or (match[2] is None) != match[1].startswith('src/core/'):
            raise Failure('{}: not of the form "src/core/ROOM/FILE.cpp: WHAT" or "src/FILE.cpp [TEST ...]: WHAT", "- OLD", '
                          '"+ NEW":\n{}'.format(TABLE, block))
        file, tests, *rest = match.groups()
        found.append(Mutation(len(found) + 1, file, (tests or '').split(), *rest))
    for mutation in found:
        count = read(mutation.file).count(mutation.old)
        if count != 1:
            raise Failure('mutation {}: "{}" is {} times in {}, must be there once: bring {} up to date'.format(
                mutation.number, mutation.old, count, mutation.file, TABLE))
    return found


def read(path):
    with open(path) as file:
        return file.read()


def write(path, content):
    with open(path, 'w') as file:
        file.write(content)


def copy_source(source):
    """Copies the project; files that did not change keep their time, so that they are not built again."""
    # roslaunch looks everywhere below a package, and takes no launch file that it finds twice.
    launch = os.path.join(source, 'launch')
    shutil.rmtree(launch, ignore_errors=True)
    os.makedirs(launch)
    for name in lint.project_files():
        if name.startswith('launch/'):
            continue
        target = os.path.join(source, name)
        os.makedirs(os.path.dirname(target), exist_ok=True)
        with open(name, 'rb') as file:
            content = file.read()
        if os.path.exists(target):
            with open(target, 'rb') as file:
                if file.read() == content:
                    continue
        shutil.copy(name, target)


def run(log, *command):
    """Runs a command with its output in `log`; False when it fails."""
    with open(log, 'w') as file:
        return subprocess.run(command, stdin=subprocess.DEVNULL, stdout=file, stderr=file).returncode == 0


def build(folder, *targets):
    log = os.path.join(folder, 'build.log')
    if not run(log, 'cmake', '--build', os.path.join(folder, 'build'), '--target', *targets):
        raise Failure('does not build, see ' + log)


def configure(folder):
    tree = os.path.join(folder, 'build')
    log = os.path.join(folder, 'configure.log')
    # catkin leaves out folders that are not there yet.
    os.makedirs(os.path.join(tree, 'devel/lib/python3/dist-packages'), exist_ok=True)
    launcher = ['-DCMAKE_CXX_COMPILER_LAUNCHER=ccache'] if shutil.which('ccache') else []
    if not run(log, 'cmake', '-S', os.path.join(folder, 'source'), '-B', tree, '-G', 'Ninja',
               '-DCMAKE_BUILD_TYPE=None', '-DCMAKE_CXX_FLAGS=-O1', '-DBUILD_SHARED_LIBS=ON',
               '-DCATKIN_ENABLE_TESTING=ON', *launcher):
        raise Failure('CMake could not configure the project, see ' + log)


def failed_tests(folder, program):
    """Names of the tests of a program that fail, or what else happened to it."""
    libraries = os.path.join(folder, 'build/devel/lib')
    path = os.path.join(libraries, 'tet_line_tracker', program)
    # A shell that has sourced a setup.bash would load the core of that build, which is not mutated.
    searched = os.pathsep.join(filter(None, [libraries, os.environ.get('LD_LIBRARY_PATH')]))
    try:
        done = subprocess.run([path], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                              timeout=TIMEOUT_S, cwd=folder, env=dict(os.environ, LD_LIBRARY_PATH=searched))
    except subprocess.TimeoutExpired:
        return ['{} does not end'.format(program)]
    if done.returncode == 0:
        return []
    names = re.findall(r'^\[  FAILED  \] ([\w/]+\.[\w/]+)', done.stdout.decode(errors='replace'), re.MULTILINE)
    return list(dict.fromkeys(names)) or ['{} crashes'.format(program)]


def programs_of(mutation):
    """Test programs that could notice a mutation, the nearest first: of the core by room, else those that are named."""
    if mutation.tests:
        return [mutation.tests]
    file = mutation.file
    tests = rooms.core_tests(read(rooms.CORE))
    names = list(tests)
    own = os.path.splitext(os.path.basename(file))[0]
    return [[test + '_test' for test in sorted(tests[name], key=lambda test: test != own)]
            for name in names[names.index(file.split('/')[2]):]]


def killers(folder, mutation):
    """What notices the mutation; empty when nothing does."""
    path = os.path.join(folder, 'source', mutation.file)
    original = read(path)
    write(path, original.replace(mutation.old, mutation.new))
    try:
        build(folder, *(mutation.tests or ['tet_line_tracker_core']))
        for programs in programs_of(mutation):
            failed = [test for program in programs for test in failed_tests(folder, program)]
            if failed:
                return failed
        return []
    finally:
        write(path, original)


def outcome_of(noticed):
    if not noticed:
        return 'SURVIVED'
    more = ' and {} more'.format(len(noticed) - MAX_SHOWN) if len(noticed) > MAX_SHOWN else ''
    return 'killed by ' + ', '.join(noticed[:MAX_SHOWN]) + more


def show(mutation, outcome=''):
    file = re.sub('^src/(core/)?', '', mutation.file)
    print('{:3}  {:<36} {:<66} {}'.format(mutation.number, file, mutation.purpose, outcome).rstrip(), flush=True)


def main():
    table = mutations()
    if sys.argv[1] == '--list':
        for mutation in table:
            show(mutation)
        return 0
    folder = sys.argv[1]
    wanted = [int(number) for number in sys.argv[2:]] or [mutation.number for mutation in table]
    unknown = [number for number in wanted if not 1 <= number <= len(table)]
    if unknown:
        raise Failure('there is no mutation {}: they are 1 to {}'.format(unknown[0], len(table)))
    chosen = [table[number - 1] for number in wanted]

    copy_source(os.path.join(folder, 'source'))
    configure(folder)
    programs = list(dict.fromkeys(program for mutation in chosen for room in programs_of(mutation)
                                  for program in room))
    build(folder, 'tet_line_tracker_core', *programs)
    for program in programs:
        failed = failed_tests(folder, program)
        if failed:
            raise Failure('without any mutation fails ' + ', '.join(failed))

    survivors = 0
    for mutation in chosen:
        noticed = killers(folder, mutation)
        show(mutation, outcome_of(noticed))
        survivors += 0 if noticed else 1
    print('{} mutations, {} killed, {} survived'.format(len(chosen), len(chosen) - survivors, survivors))
    return 1 if survivors else 0


if __name__ == '__main__':
    try:
        sys.exit(main())
    except Failure as failure:
        sys.exit('mutate.sh: {}'.format(failure))
