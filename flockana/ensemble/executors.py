"""Executors: serial, process pool, Dask, custom."""

from collections.abc import Callable, Iterator
from concurrent.futures import Executor, Future
from contextlib import contextmanager
from dataclasses import dataclass
from types import NoneType
from typing import Any

from flockana.base.checks import ensure_count, ensure_kind
from flockana.base.errors import ArgumentError
from flockana.ensemble.processes import ProcessPool, cores


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
    loses: bool = False  # whether a result may be lost with its worker, whatever error that then is: Dask's


@contextmanager
def worker_pool(
    executor: Executor | None = None, *, cluster: str | None = None, jobs: int | None = None
) -> Iterator[WorkerPool]:
    """Provide workers: this process, a pool that ends with the block, a cluster, or a given executor."""
    ensure_worker_options(executor, cluster, jobs)
    count = cores() if jobs is None else jobs
    if executor is not None:
        width = getattr(executor, "_max_workers", None) or cores()
        yield WorkerPool(executor, lambda: width)
    elif cluster is not None:
        from flockana.ensemble.cluster import connected

        with connected(cluster, count) as (workers, threads):
            yield WorkerPool(workers, threads, loses=True)
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


def ensure_worker_options(executor: Any, cluster: Any, jobs: Any) -> None:
    """Raise on bad executor options before anything is started."""
    ensure_kind("executor", executor, (Executor, NoneType), "a concurrent.futures.Executor")
    if executor is not None and (cluster is not None or jobs is not None):
        raise ArgumentError("executor, and cluster or jobs: expected one of them; an executor has its own size")
    if cluster is not None and not (isinstance(cluster, str) and cluster):
        raise ArgumentError(f"cluster = {cluster!r}: expected the address of a Dask scheduler, or 'local'")
    if cluster not in (None, "local") and jobs is not None:
        raise ArgumentError(f"jobs = {jobs}: the cluster at {cluster} has its own size; leave it out")
    if jobs is not None:
        ensure_count("jobs", jobs)
