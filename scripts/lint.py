#!/usr/bin/env python3
"""Checks what a compiler does not: format, clang-tidy, catkin_lint, rooms, paths of one machine, scripts' syntax.

Called by test.sh. Writes test_results/lint.xml into the build folder; exits 1 when a check failed. A check whose
tool is not installed is skipped.
"""
import concurrent.futures
import hashlib
import json
import os
import re
import shutil
import subprocess
import sys
import xml.etree.ElementTree as ElementTree

import rooms

# clang-format's style differs between its versions; this one is Debian 12's.
CLANG_FORMAT_VERSION = 14
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
    version = int(re.search(r'version (\d+)', run('clang-format', '--version')).group(1))
    if version != CLANG_FORMAT_VERSION:
        raise Skipped('clang-format {} formats differently from {}'.format(version, CLANG_FORMAT_VERSION))
    run('clang-format', '--dry-run', '--Werror', *(f for f in files if f.endswith(('.cpp', '.h'))))


def check_tidy(files, build):
    """clang-tidy over src; a file that passed is read again only when it, a header or the rules changed."""
    require('clang-tidy')
    with open(os.path.join(build, 'compile_commands.json')) as file:
        compiled = {os.path.relpath(entry['file']) for entry in json.load(file)}
    units = [f for f in files if f.startswith('src/') and f.endswith('.cpp')]
    not_compiled = [unit for unit in units if unit not in compiled]
    if not_compiled:
        raise RuntimeError('in src/ but in no target: ' + ' '.join(not_compiled))
    common = hashlib.sha256()
    for name in ['.clang-tidy'] + [f for f in files if f.endswith(('.h', '.msg', '.cfg'))]:
        common.update(read(name))
    passed = os.path.join(build, 'lint')
    os.makedirs(passed, exist_ok=True)

    def tidy(unit):
        digest = common.copy()
        digest.update(unit.encode() + read(unit))
        stamp = os.path.join(passed, digest.hexdigest())
        if not os.path.exists(stamp):
            try:
                run('clang-tidy', '--quiet', '-p', build, unit)
            except RuntimeError as complaint:
                # It counts what it holds back in the headers of others.
                raise RuntimeError(re.sub(r'(?m)^\d+ warnings? generated\.\n', '', str(complaint)))
            open(stamp, 'w').close()

    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        results = [pool.submit(tidy, unit) for unit in units]
    complaints = [str(result.exception()) for result in results if result.exception() is not None]
    if complaints:
        raise RuntimeError('\n'.join(complaints))


def check_catkin(_):
    require('catkin_lint')
    run('catkin_lint', '--strict', '--offline', '.')


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
    build = sys.argv[1]
    files = project_files()
    checks = [('clang_format', check_format), ('catkin_lint', check_catkin), ('machine_paths', check_paths),
              ('rooms', check_rooms), ('script_syntax', check_scripts), ('xml_syntax', check_xml),
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
