import contextlib
import ctypes
import signal
import subprocess
import sys
import threading

import pytest

from flockana.base.interrupts import defer_sigint, raise_swallowed, restore_interrupts
from tests.programs import out_of_a_kernel, posix

REPORT = "import signal; print(*(s.name for s in signal.pthread_sigmask(signal.SIG_BLOCK, ())), sep=',')"


pytestmark = pytest.mark.usefixtures("answering")


@pytest.fixture
def another_thread():
    """One that takes the signal when this one does not, as a thread of linear algebra's does."""
    end = threading.Event()
    thread = threading.Thread(target=end.wait)
    thread.start()
    yield
    end.set()
    thread.join()


def held(work, *, after=None):
    """Do something with Ctrl-C held, then what comes after it."""
    with defer_sigint():
        work()
    if after is not None:
        after()


def test_ctrl_c_comes_at_the_end_whoever_takes_the_signal(another_thread):
    done = []

    def work():
        for _ in range(3):
            signal.raise_signal(signal.SIGINT)
            done.append(sum(range(100_000)))

    with pytest.raises(KeyboardInterrupt):
        held(work, after=lambda: done.append("after"))
    assert done == [4999950000] * 3
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler


@posix
def test_a_signal_to_the_process_is_held_too(another_thread):
    """Sent from outside, it goes to any thread that does not block it, and Python hands it to the main one."""
    kill = [sys.executable, "-c", "import os, signal; os.kill(os.getppid(), signal.SIGINT)"]
    done = []

    def work():
        subprocess.run(kill, check=True)
        done.append(sum(range(100_000)))

    with pytest.raises(KeyboardInterrupt):
        held(work)
    assert done == [4999950000]


def test_one_in_another_ends_with_the_outer():
    done = []

    def work():
        held(lambda: signal.raise_signal(signal.SIGINT), after=lambda: done.append("after the inner"))

    with pytest.raises(KeyboardInterrupt):
        held(work, after=lambda: done.append("after the outer"))
    assert done == ["after the inner"]


def test_an_error_is_the_context_of_the_interrupt():
    def work():
        signal.raise_signal(signal.SIGINT)
        raise ValueError("torn")

    with pytest.raises(KeyboardInterrupt) as found:
        held(work)
    assert isinstance(found.value.__context__, ValueError)


def test_where_it_is_ignored_it_stays_ignored():
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    with defer_sigint():
        signal.raise_signal(signal.SIGINT)
    assert signal.getsignal(signal.SIGINT) is signal.SIG_IGN


def test_in_another_thread_it_leaves_the_main_ones_handler_alone():
    failures = []

    def work():
        try:
            with defer_sigint():
                assert signal.getsignal(signal.SIGINT) is signal.default_int_handler
        except BaseException as error:
            failures.append(error)

    thread = threading.Thread(target=work)
    thread.start()
    thread.join()
    assert failures == []


@posix
def test_processes_started_meanwhile_do_not_get_it_even_the_first_of_all():
    """In a process of its own: multiprocessing starts a helper with the first process, and then unblocks the signal."""
    code = f"""
import multiprocessing, subprocess, sys
from flockana.base.interrupts import block_sigint
if __name__ == "__main__":
    with block_sigint():
        lock = multiprocessing.get_context("spawn").Lock()
        subprocess.run([sys.executable, "-c", {REPORT!r}])
    subprocess.run([sys.executable, "-c", {REPORT!r}])
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.split("\n") == ["SIGINT", "", ""]


def lock_in_disorder():
    """What `threading` makes of Ctrl-C that comes while a lock is taken again."""
    with contextlib.ExitStack() as stack:
        stack.callback(threading.Lock().release)
        raise KeyboardInterrupt


def kernel():
    raise out_of_a_kernel()


@pytest.mark.parametrize("work", [kernel, lock_in_disorder])
def test_what_others_make_of_ctrl_c_is_ctrl_c_again(work):
    with pytest.raises(RuntimeError if work is lock_in_disorder else SystemError):
        work()
    with pytest.raises(KeyboardInterrupt), restore_interrupts():
        work()


def handled():
    try:
        raise KeyboardInterrupt
    except KeyboardInterrupt:
        raise ValueError("another subject") from None


def plain():
    raise ValueError("another subject")


@pytest.mark.parametrize("work", [handled, plain])
def test_other_errors_stay_what_they_are(work):
    with pytest.raises(ValueError, match="another subject"), restore_interrupts():
        work()


@pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning")
def test_ctrl_c_that_a_librarys_callback_swallows_is_raised_after_the_block(monkeypatch):
    """As within the code that LLVM calls while it compiles: Python can only print what is raised there."""
    callback = ctypes.CFUNCTYPE(None)(lambda: signal.raise_signal(signal.SIGINT))
    callback()
    passed = []

    @raise_swallowed()
    def block():
        callback()
        passed.append("block")

    with pytest.raises(KeyboardInterrupt):
        block()
    assert passed == ["block"]
    before = signal.signal(signal.SIGINT, lambda number, frame: passed.append("handled"))
    with raise_swallowed():
        callback()  # nothing is raised, so nothing is lost
    signal.signal(signal.SIGINT, before)
    assert passed == ["block", "handled"]
