"""Programs as tests start them: they answer Ctrl-C themselves, show signs of life, and do not outlive the test."""

import os
import signal
import subprocess
import sys
import time
from contextlib import contextmanager
from pathlib import Path

import pytest

# A shell starts background jobs, such as a whole CI, with Ctrl-C ignored, and everything they start inherits that.
ANSWERS_CTRL_C = """
import signal
signal.signal(signal.SIGINT, signal.default_int_handler)
if hasattr(signal, "pthread_sigmask"):
    signal.pthread_sigmask(signal.SIG_UNBLOCK, {signal.SIGINT})
"""
IGNORES_CTRL_C = "import signal; signal.signal(signal.SIGINT, signal.SIG_IGN)\n"
CLI = "from flockana.cli.main import main\nmain()\n"
posix = pytest.mark.skipif(os.name != "posix", reason="signals to a process group")


@contextmanager
def program(*arguments, paths=(), environment=None, folder=None, output=subprocess.PIPE):
    """A Python program in a session of its own, which ends at the end with all that it started."""
    found = os.environ | (environment or {})
    known = filter(None, [*map(str, paths), os.environ.get("PYTHONPATH", "")])
    process = subprocess.Popen(
        [sys.executable, *map(str, arguments)],
        env=found | {"PYTHONPATH": os.pathsep.join(known)},
        cwd=folder,
        stdout=output,
        stderr=output,
        text=True,
        start_new_session=True,
    )
    try:
        yield process
    finally:
        _kill(process)
        process.communicate()


def _kill(process):
    if group(process):
        os.killpg(process.pid, signal.SIGKILL)


def until(condition, *alive):
    """Wait for a sign of life, as long as those that can give it are alive; the test's own time limit ends the rest."""
    while not condition():
        ended = [process for process in alive if process.poll() is not None]
        if ended and not condition():
            _kill(ended[0])  # what it started may hold its output
            pytest.fail(f"ended with {ended[0].returncode}: {ended[0].communicate()}")
        time.sleep(0.02)


def group(process):
    """The living processes that a program started, itself included."""
    if Path("/proc/self/stat").exists():
        states = [_state(path) for path in Path("/proc").glob("[0-9]*/stat")]
    else:
        listed = subprocess.run(["ps", "-A", "-o", "stat=,pgid=,pid="], capture_output=True, text=True, check=True)
        states = [tuple(line.split()) for line in listed.stdout.splitlines()]
    return [int(one) for state, of, one in filter(None, states) if of == str(process.pid) and state[0] not in "ZX"]


def _state(path):
    try:
        state, _, of = path.read_text().rpartition(")")[2].split()[:3]
    except OSError:  # it ended meanwhile
        return None
    return state, of, path.parent.name


@contextmanager
def full_disk(room=0):
    """No file may grow beyond so many bytes: what a full disk says, in this process alone."""
    resource = pytest.importorskip("resource")
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (room, before[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)


def out_of_a_kernel():
    """What numba makes of Ctrl-C now and then."""
    error = SystemError("CPUDispatcher returned a result with an exception set")
    error.__cause__ = SystemError("and so did what it called")
    error.__cause__.__cause__ = KeyboardInterrupt()
    return error


def interrupt(process):
    """Ctrl-C as the terminal does it: the signal goes to the whole group of processes."""
    os.killpg(process.pid, signal.SIGINT)


class Starts:
    """Numbers the starts of runs in the order in which they come: second runs of a start do not count."""

    def __init__(self):
        self.seen = {}

    def number(self, run):
        return self.seen.setdefault((run.q[0].tobytes(), run.p[0].tobytes()), len(self.seen))
