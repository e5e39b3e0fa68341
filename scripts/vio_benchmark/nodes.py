"""Nodes as processes: starting, waiting until they listen, processor time, stopping."""
import os
import signal
import subprocess
import time
import xmlrpc.client

import rosgraph


class Failure(Exception):
    """One sentence for the user."""


def cpu_seconds(pid):
    """Processor time that a process and its threads have used."""
    with open('/proc/{}/stat'.format(pid)) as file:
        # The name in brackets may hold anything.
        fields = file.read().rsplit(')', 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf('SC_CLK_TCK')


def pid_of_node(name):
    address = rosgraph.Master('/vio_benchmark').lookupNode(name)
    return xmlrpc.client.ServerProxy(address).getPid('/vio_benchmark')[2]


def wait_until(true, seconds, sentence):
    end = time.time() + seconds
    while not true():
        if time.time() > end:
            raise Failure(sentence)
        time.sleep(0.05)


def listens(node, topic):
    """Whether a node has subscribed."""
    try:
        subscribers = rosgraph.Master('/vio_benchmark').getSystemState()[1]
    except (rosgraph.MasterException, OSError):
        return False
    return any(name == topic and node in nodes for name, nodes in subscribers)


class Processes:
    """Started in a `with`, ended with it."""

    def __init__(self, logs):
        self.logs = logs
        self.running = {}
        os.makedirs(logs, exist_ok=True)

    def __enter__(self):
        return self

    def log(self, name):
        return os.path.join(self.logs, name + '.log')

    def start(self, name, command):
        with open(self.log(name), 'w') as log:
            self.running[name] = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=log, stderr=subprocess.STDOUT)
        return self.running[name]

    def check(self):
        for name, process in self.running.items():
            if process.poll() not in (None, 0):
                raise Failure('{} ended with status {}; see {}'.format(name, process.returncode, self.log(name)))

    def __exit__(self, *_):
        for sent in (signal.SIGINT, signal.SIGTERM, signal.SIGKILL):
            for process in self.running.values():
                if process.poll() is None:
                    process.send_signal(sent)
            end = time.time() + 8.0
            while time.time() < end and any(process.poll() is None for process in self.running.values()):
                time.sleep(0.05)
