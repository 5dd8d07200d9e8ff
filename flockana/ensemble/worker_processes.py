"""Worker processes that ignore Ctrl-C, use one thread each, and end with the program."""

import atexit
import gc
import multiprocessing
import os
import signal
import threading
from collections.abc import Callable, Iterator
from concurrent.futures import Future, ProcessPoolExecutor
from contextlib import contextmanager
from multiprocessing.process import BaseProcess
from typing import Any

from flockana.base.garbage_collection import SELDOM, freeze_gc
from flockana.base.interrupts import block_sigint, defer_sigint
from flockana.jit import pause_compiling

_END = 10.0  # seconds in which killed processes are gone
_ONE_THREAD = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS")


def cores() -> int:
    """Return the number of processors that this process may use."""
    affinity = getattr(os, "sched_getaffinity", None)  # not on macOS and Windows
    return len(affinity(0)) if affinity else os.cpu_count() or 1


class ProcessPool(ProcessPoolExecutor):
    """Pool of single-threaded processes that ignore Ctrl-C and end with their parent."""

    def __init__(self, jobs: int) -> None:
        # spawned, not forked: a forked child inherits the locks of threads that it does not have
        context = multiprocessing.get_context("spawn")
        super().__init__(jobs, mp_context=context, initializer=_begin_worker)

    def submit(self, function: Callable[..., Any], /, *arguments: Any, **options: Any) -> Future[Any]:
        """Call the function in a process, which is started if there are too few."""
        with defer_sigint(), block_sigint(), single_threaded_children():
            return super().submit(function, *arguments, **options)

    def stop(self) -> None:
        """End all processes at once and wait until they are gone."""
        with defer_sigint():  # a second Ctrl-C must not leave half of them
            workers = list((getattr(self, "_processes", None) or {}).values())  # Python 3.14 has a public way
            manager = getattr(self, "_executor_manager_thread", None)
            self.shutdown(wait=False, cancel_futures=True)
            for worker in workers:
                worker.kill()  # one that is stopped would not hear a mere request
            if manager is not None:
                manager.join(_END)


def _begin_worker() -> None:
    """Prepare a worker process: ignore Ctrl-C, and end with the parent."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    gc.set_threshold(SELDOM)
    atexit.register(freeze_gc)
    if (parent := multiprocessing.parent_process()) is not None:
        threading.Thread(target=_end_with, args=(parent,), daemon=True).start()


def _end_with(parent: BaseProcess) -> None:
    parent.join()
    os._exit(1)


@contextmanager
def single_threaded_children() -> Iterator[None]:
    """Limit processes started inside to one thread of linear algebra each."""
    with pause_compiling():
        previous_env = {name: os.environ[name] for name in _ONE_THREAD if name in os.environ}
        os.environ |= dict.fromkeys(_ONE_THREAD, "1")
        try:
            yield
        finally:
            for name in _ONE_THREAD:
                os.environ.pop(name, None)
            os.environ |= previous_env
