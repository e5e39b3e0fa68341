#!/usr/bin/env python3
"""rviz on a virtual screen, for tests and pictures.

    rviz_session.py CONFIG PICTURE.png [--size WxH] [--seconds S] [--fixed-frame FRAME]
                    [--remap FROM:=TO ...] [-- COMMAND ...]

Starts a master, COMMAND (a program that publishes), and rviz with CONFIG, waits S seconds (default 20), and writes what is
on the screen. Needs Xvfb.
"""
import argparse
import os
import re
import signal
import socket
import struct
import subprocess
import sys
import tempfile
import time
import xmlrpc.client
import zlib


def free_port():
    with socket.socket() as listener:
        listener.bind(('localhost', 0))
        return listener.getsockname()[1]


class Picture:
    """What is on a screen; rows of red, green, blue, from an X window dump."""

    def __init__(self, dump):
        header = struct.unpack('>25I', dump[:100])
        assert header[1] == 7 and header[11] == 32, 'not a dump of a screen with 24 bits of colour'
        self.width, self.height = header[4], header[5]
        start = header[0] + header[19] * 12
        order = '<' if header[7] == 0 else '>'
        pixels = dump[start:start + self.height * header[12]]
        blue, green, red = (0, 1, 2) if order == '<' else (3, 2, 1)
        self.rgb = bytearray(3 * self.width * self.height)
        for channel, place in enumerate((red, green, blue)):
            self.rgb[channel::3] = pixels[place::4]

    def count_near(self, rgb, tolerance=20):
        """Number of pixels of about this colour."""
        near = [{value for value in range(256) if abs(value - wanted) <= tolerance} for wanted in rgb]
        return sum(1 for red, green, blue in zip(self.rgb[0::3], self.rgb[1::3], self.rgb[2::3])
                   if red in near[0] and green in near[1] and blue in near[2])

    def rows_near(self, column, rgb, above, tolerance=20):
        """Rows above another one in which the screen has about this colour in a column."""
        step = 3 * self.width
        pixels = zip(*(self.rgb[3 * column + channel:above * step:step] for channel in range(3)))
        return [row for row, pixel in enumerate(pixels)
                if all(abs(value - wanted) <= tolerance for value, wanted in zip(pixel, rgb))]

    def write_png(self, path):
        rows = b''.join(b'\0' + bytes(self.rgb[row * 3 * self.width:(row + 1) * 3 * self.width])
                        for row in range(self.height))
        with open(path, 'wb') as file:
            file.write(b'\x89PNG\r\n\x1a\n')
            for name, content in ((b'IHDR', struct.pack('>2I5B', self.width, self.height, 8, 2, 0, 0, 0)),
                                  (b'IDAT', zlib.compress(rows, 9)), (b'IEND', b'')):
                file.write(struct.pack('>I', len(content)) + name + content +
                           struct.pack('>I', zlib.crc32(name + content)))


class Session:
    """A virtual screen, a master, and rviz on it. All of them end with the session."""

    def __init__(self, width=1500, height=900):
        self.size = (width, height)
        self.children = []
        self.folder = tempfile.TemporaryDirectory(prefix='rviz_session_')
        self.environment = dict(os.environ, ROS_HOSTNAME='localhost', QT_X11_NO_MITSHM='1', XDG_RUNTIME_DIR=self.folder.name,
                                ROS_LOG_DIR=self.folder.name)

    def __enter__(self):
        try:
            self.start_screen()
            self.start_master()
        except BaseException:
            self.__exit__()
            raise
        return self

    def __exit__(self, *_):
        for child in reversed(self.children):
            self.stop(child)
        self.folder.cleanup()

    @staticmethod
    def stop(child):
        """Ends a program and all that it started."""
        for number, patience in ((signal.SIGINT, 10), (signal.SIGKILL, 10)):
            try:
                os.killpg(child.pid, number)
                child.wait(patience)
            except (ProcessLookupError, subprocess.TimeoutExpired):
                pass

    def start(self, *command, **options):
        log = open(os.path.join(self.folder.name, os.path.basename(command[0]) + '.log'), 'wb')
        with log:
            self.children.append(subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=log, stderr=subprocess.STDOUT,
                                                  env=self.environment, start_new_session=True, **options))
        return self.children[-1]

    def start_screen(self):
        reader, writer = os.pipe()
        self.start('Xvfb', '-displayfd', str(writer), '-screen', '0', '{}x{}x24'.format(*self.size), '-nolisten', 'tcp', '-nocursor',
                   '-fbdir', self.folder.name, pass_fds=(writer,))
        os.close(writer)
        with os.fdopen(reader) as pipe:
            display = pipe.readline().strip()
        if not display:
            raise RuntimeError('Xvfb did not start')
        self.environment['DISPLAY'] = ':' + display

    def start_master(self):
        port = free_port()
        self.environment['ROS_MASTER_URI'] = 'http://localhost:{}'.format(port)
        self.start('roscore', '-p', str(port))
        self.wait(lambda: self.subscribers() is not None, 'the master did not answer')

    def start_rviz(self, config, *options):
        # rviz remembers the configurations that were open, in the home folder.
        self.start('env', 'HOME=' + self.folder.name, 'rosrun', 'rviz', 'rviz', '-d', config, *options)

    def subscribers(self):
        """Topics with the nodes that subscribe to them; None when there is no master."""
        try:
            _, _, state = xmlrpc.client.ServerProxy(self.environment['ROS_MASTER_URI']).getSystemState('/rviz_session')
        except OSError:
            return None
        return dict(state[1])

    def subscribed_by_rviz(self):
        return {topic for topic, nodes in (self.subscribers() or {}).items() if any('rviz' in node for node in nodes)}

    def messages(self):
        """What rviz wrote."""
        with open(os.path.join(self.folder.name, 'env.log'), errors='replace') as file:
            return re.sub(r'\x1b\[[0-9;]*m', '', file.read())

    def picture(self):
        with open(os.path.join(self.folder.name, 'Xvfb_screen0'), 'rb') as file:
            return Picture(file.read())

    @staticmethod
    def wait(condition, complaint, seconds=60):
        end = time.monotonic() + seconds
        while not condition():
            if time.monotonic() > end:
                raise RuntimeError(complaint if isinstance(complaint, str) else complaint())
            time.sleep(0.2)


def main():
    words = sys.argv[1:]
    command = []
    if '--' in words:
        command = words[words.index('--') + 1:]
        words = words[:words.index('--')]
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('config')
    parser.add_argument('picture')
    parser.add_argument('--size', default='1500x900')
    parser.add_argument('--seconds', type=float, default=20)
    parser.add_argument('--fixed-frame')
    parser.add_argument('--remap', nargs='+', default=[], metavar='FROM:=TO', help='topics of the configuration')
    arguments = parser.parse_args(words)
    with Session(*map(int, arguments.size.split('x'))) as session:
        if command:
            session.start(*command)
            session.wait(session.subscribers, 'no node of the command has started')  # rviz asks for the kind of time once
        frame = ['-f', arguments.fixed_frame] if arguments.fixed_frame else []
        session.start_rviz(arguments.config, *frame, *arguments.remap)
        session.wait(session.subscribed_by_rviz, 'rviz did not start')
        time.sleep(arguments.seconds)
        session.picture().write_png(arguments.picture)
        print(session.messages(), file=sys.stderr)


if __name__ == '__main__':
    main()
