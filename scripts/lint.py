#!/usr/bin/env python3
"""Checks what a compiler does not: format, clang-tidy, catkin_lint, doxygen, rooms, paths of one machine, scripts' syntax.

    lint.py BUILD

Called by test.sh. Writes test_results/lint.xml into the build folder; exits 1 when a check failed. A check whose
tool is not installed is skipped.
"""
import concurrent.futures
import hashlib
import json
import os
import re
import shlex
import shutil
import subprocess
import sys
import time
import xml.etree.ElementTree as ElementTree

import rooms
import std_headers

# clang-format's style differs between its versions; this one is Debian 12's.
CLANG_FORMAT_VERSION = 14
# From Ubuntu 20.04's to Debian 12's. Newer ones have checks that this project has not been read with.
CLANG_TIDY_VERSIONS = range(10, 15)
PROGRESS_PERIOD_S = 30.0
MAX_TIDY_BATCH = 8  # source files; more would leave a processor idle at the end
# Spelled so that this file does not find itself.
MACHINE_PATH = re.compile(r'(?:^|[^\w.~)}\]/*-])/(?:ho' r'me|wo' r'rk|ro' r'ot|tm' r'p|Us' r'ers)/')


class Skipped(Exception):
    pass


def run(*command):
    """Output of a command; its output as the message of a RuntimeError when it fails."""
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL)
    output = done.stdout.decode(errors='replace').strip()
    if done.returncode != 0:
        raise RuntimeError(output or '{} ended with status {}'.format(command[0], done.returncode))
    return output


def require(tool):
    if shutil.which(tool) is None:
        raise Skipped(tool + ' is not installed')


def version_of(tool):
    return int(re.search(r'version (\d+)', run(tool, '--version')).group(1))


def project_files():
    """Files that belong to the project: what git would deliver, or without git all but build/."""
    try:
        names = run('git', 'ls-files', '--cached', '--others', '--exclude-standard').splitlines()
    except (RuntimeError, OSError):
        names = [os.path.relpath(os.path.join(folder, name))
                 for folder, _, found in os.walk('.') for name in found]
        names = [name for name in names if not name.startswith(('build/', '.git/')) and not name.endswith('.pyc')]
    return sorted(name for name in names if os.path.isfile(name))


def read(name):
    with open(name, 'rb') as file:
        return file.read()


def check_format(files):
    require('clang-format')
    version = version_of('clang-format')
    if version != CLANG_FORMAT_VERSION:
        raise Skipped('clang-format {} formats differently from {}'.format(version, CLANG_FORMAT_VERSION))
    run('clang-format', '--dry-run', '--Werror', *(f for f in files if f.endswith(('.cpp', '.h'))))


def tidy_flags(entry):
    """The words of an entry of the compilation database without the names of its files."""
    words = [word for word in shlex.split(entry['command']) if os.path.basename(word) != 'ccache']
    source = os.path.realpath(os.path.join(entry['directory'], entry['file']))
    flags = []
    skip = False
    for word in words:
        if skip or word == '-o':
            skip = not skip
        elif word != '-c' and os.path.realpath(os.path.join(entry['directory'], word)) != source:
            flags.append(word)
    return flags


def local_names(content):
    """Names that a source file defines for itself, in unnamed namespaces."""
    names = set()
    for body in re.findall(r'^namespace \{$(.*?)^\}  // namespace$', content, re.MULTILINE | re.DOTALL):
        for line in re.findall(r'^[A-Za-z].*$', body, re.MULTILINE):
            words = re.findall(r'\w+', re.split(r'[(={;]', line)[0])
            names.update(words[-1:])
    return names


def tidy_batches(units, flags_of, content_of):
    """Lists of source files that clang-tidy can read as one: with the same flags, no local name in two of them.

    What takes its time are the headers of Eigen, OpenCV, ROS and the standard library, which it checks like any other
    source; a batch does so once.
    """
    batches = []  # [flags, names, units]
    for unit in units:
        flags = flags_of(unit)
        names = local_names(content_of(unit))
        for batch in batches:
            if batch[0] == flags and len(batch[2]) < MAX_TIDY_BATCH and not batch[1] & names:
                batch[1].update(names)
                batch[2].append(unit)
                break
        else:
            batches.append([flags, set(names), [unit]])
    return [batch[2] for batch in batches]


def run_tidy(units, entries, folder):
    """clang-tidy over source files as if they were one. A RuntimeError holds what it complains of."""
    work = os.path.abspath(os.path.join(folder, hashlib.sha256(' '.join(units).encode()).hexdigest()[:12]))
    os.makedirs(work, exist_ok=True)
    source = os.path.abspath(units[0])
    if len(units) > 1:
        source = os.path.join(work, 'batch.cpp')
        with open(source, 'wb') as file:
            for number, unit in enumerate(units):
                # Each program has a main.
                file.write(b'#define main main_of_%d\n%s\n#undef main\n' % (number, read(unit)))
    entry = entries[units[0]]
    folders = dict.fromkeys(os.path.abspath(os.path.dirname(unit)) for unit in units)
    flags = tidy_flags(entry) + [word for path in folders for word in ('-iquote', path)] + ['-c', source]
    with open(os.path.join(work, 'compile_commands.json'), 'w') as file:
        json.dump([{'directory': entry['directory'], 'file': source, 'arguments': flags}], file)
    try:
        run('clang-tidy', '--quiet', '--config-file=.clang-tidy', '-p', work, source)
    except RuntimeError as complaint:
        # It counts what it holds back in the headers of others.
        raise RuntimeError(re.sub(r'(?m)^\d+ warnings? generated\.\n', '', str(complaint)))


def check_tidy(files, build):
    """clang-tidy over src, in batches; what passed is read again only when it, a header or the rules changed."""
    require('clang-tidy')
    if version_of('clang-tidy') not in CLANG_TIDY_VERSIONS:
        raise Skipped('clang-tidy {} is none of {} to {}'.format(version_of('clang-tidy'), CLANG_TIDY_VERSIONS[0],
                                                                CLANG_TIDY_VERSIONS[-1]))
    with open(os.path.join(build, 'compile_commands.json')) as file:
        entries = {os.path.relpath(entry['file']): entry for entry in json.load(file)}
    units = [f for f in files if f.startswith('src/') and f.endswith('.cpp')]
    not_compiled = [unit for unit in units if unit not in entries]
    if not_compiled:
        raise RuntimeError('in src/ but in no target: ' + ' '.join(not_compiled))
    common = hashlib.sha256()
    for name in ['.clang-tidy'] + [f for f in files if f.endswith(('.h', '.msg', '.cfg'))]:
        common.update(read(name))
    folder = os.path.join(build, 'lint')
    os.makedirs(folder, exist_ok=True)

    def tidy(batch):
        digest = common.copy()
        for unit in batch:
            digest.update(unit.encode() + read(unit))
        stamp = os.path.join(folder, digest.hexdigest())
        if os.path.exists(stamp):
            return
        try:
            run_tidy(batch, entries, folder)
        except RuntimeError:
            # Which file is it? None, when they only do not compile as one.
            found = []
            for unit in batch:
                try:
                    run_tidy([unit], entries, folder)
                except RuntimeError as complaint:
                    found.append(str(complaint))
            if found:
                raise RuntimeError('\n'.join(found))
        open(stamp, 'w').close()

    batches = tidy_batches(units, lambda unit: tuple(tidy_flags(entries[unit])), lambda unit: read(unit).decode())
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        results = [pool.submit(tidy, batch) for batch in batches]
        told = time.monotonic()
        for done, _ in enumerate(concurrent.futures.as_completed(results), 1):
            if time.monotonic() - told > PROGRESS_PERIOD_S:
                told = time.monotonic()
                print('lint clang_tidy: {} of {} batches ...'.format(done, len(batches)), flush=True)
    complaints = [str(result.exception()) for result in results if result.exception() is not None]
    if complaints:
        raise RuntimeError('\n'.join(complaints))


def check_std_headers(files):
    found = std_headers.complaints({name: read(name).decode() for name in files if name.endswith(('.cpp', '.h'))})
    if found:
        raise RuntimeError('\n'.join(found))


def check_catkin(_):
    require('catkin_lint')
    run('catkin_lint', '--strict', '--offline', '.')


def check_doxygen(_):
    require('doxygen')
    output = run('doxygen')  # with what Doxyfile says it prints warnings alone
    if output:
        raise RuntimeError(output)


def check_paths(files):
    """Paths of one machine work nowhere else."""
    found = []
    for name in files:
        content = read(name)
        if b'\0' in content:
            continue
        for number, line in enumerate(content.decode(errors='replace').splitlines(), 1):
            if MACHINE_PATH.search(line):
                found.append('{}:{}: {}'.format(name, number, line.strip()))
    if found:
        raise RuntimeError('\n'.join(found))


def check_rooms(files):
    found = rooms.complaints(rooms.read_sources(files))
    if found:
        raise RuntimeError('\n'.join(found))


def check_scripts(files):
    for name in files:
        if name.endswith('.sh') or name == '.ci/run':
            run('bash', '-n', name)
        elif name.endswith(('.py', '.cfg')):
            compile(read(name), name, 'exec')


def check_xml(files):
    for name in files:
        if name.endswith(('.xml', '.launch', '.test')):
            ElementTree.parse(name)


def main():
    if len(sys.argv) != 2 or not os.path.isdir(sys.argv[1]):
        print(__doc__)
        return 2
    build = sys.argv[1]
    files = project_files()
    checks = [('clang_format', check_format), ('catkin_lint', check_catkin), ('doxygen', check_doxygen), ('machine_paths', check_paths),
              ('rooms', check_rooms), ('std_headers', check_std_headers), ('script_syntax', check_scripts), ('xml_syntax', check_xml),
              ('clang_tidy', lambda names: check_tidy(names, build))]
    suite = ElementTree.Element('testsuite', name='lint')
    status = 0
    for name, check in checks:
        case = ElementTree.SubElement(suite, 'testcase', classname='lint', name=name)
        try:
            check(files)
            print('lint {}: passed'.format(name), flush=True)
        except Skipped as reason:
            ElementTree.SubElement(case, 'skipped', message=str(reason))
            print('lint {}: skipped, {}'.format(name, reason), flush=True)
        except Exception as complaint:  # each is a check that failed, also a file that cannot be parsed
            ElementTree.SubElement(case, 'failure', message=str(complaint))
            print('lint {}: FAILED\n{}'.format(name, complaint), flush=True)
            status = 1
    os.makedirs(os.path.join(build, 'test_results'), exist_ok=True)
    ElementTree.ElementTree(suite).write(os.path.join(build, 'test_results', 'lint.xml'))
    return status


if __name__ == '__main__':
    sys.exit(main())
