"""Executors: serial, process pool, custom."""

from collections.abc import Callable, Iterator
from concurrent.futures import Executor, Future
from contextlib import contextmanager
from dataclasses import dataclass
from types import NoneType
from typing import Any

from flockana.base.value_checks import ensure_count, ensure_kind
from flockana.ensemble.worker_processes import ProcessPool, cores


class Serial(Executor):
    """Executor that runs each call at once in the caller's thread."""

    def submit(self, function: Callable[..., Any], /, *arguments: Any, **options: Any) -> Future[Any]:
        """Call the function now; Ctrl-C ends it and goes on to the caller."""
        future: Future[Any] = Future()
        try:
            future.set_result(function(*arguments, **options))
        except Exception as error:
            future.set_exception(error)
        return future


@dataclass
class WorkerPool:
    """Executor with its number of workers and its behaviour when one dies."""

    executor: Executor  # who works
    width: Callable[[], int]  # how many batches it can work on at once, now
    renew: Callable[[], Executor] | None = None  # gives a new executor after a worker's death broke this one


@contextmanager
def worker_pool(executor: Executor | None = None, *, jobs: int | None = None) -> Iterator[WorkerPool]:
    """Provide workers: this process, a pool that ends with the block, or a given executor."""
    ensure_worker_options(executor, jobs)
    count = cores() if jobs is None else jobs
    if executor is not None:
        width = jobs or getattr(executor, "_max_workers", None) or cores()
        yield WorkerPool(executor, lambda: width)
    elif count == 1:
        yield WorkerPool(Serial(), lambda: 1)
    else:
        pools = [ProcessPool(count)]  # the last one is at work; another replaces it when a worker dies

        def renew() -> Executor:
            pools[-1].stop()
            pools.append(ProcessPool(count))
            return pools[-1]

        try:
            yield WorkerPool(pools[0], lambda: count, renew)
            pools[-1].shutdown()
        except BaseException:
            pools[-1].stop()
            raise


def ensure_worker_options(executor: Any, jobs: Any) -> None:
    """Raise on bad executor options before anything is started."""
    ensure_kind("executor", executor, (Executor, NoneType), "a concurrent.futures.Executor")
    if jobs is not None:
        ensure_count("jobs", jobs)
