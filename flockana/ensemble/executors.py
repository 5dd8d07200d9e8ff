"""Who makes the runs: this process, a pool of processes of our own, a Dask cluster, or any executor of the user's.

All are used in the same way: batches of runs go out, a few more than there are workers, and records come back as they
are done. Nothing is decided by which comes first, so the numbers do not depend on who computes them.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, BrokenExecutor, Executor, Future
from concurrent.futures import wait as wait_for
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

from flockana.base.checks import ensure_count
from flockana.base.errors import ArgumentError, FlockanaError, SolverError
from flockana.ensemble.processes import ProcessPool, cores
from flockana.ensemble.work import DIED, Job, Record, Request, run_batch

_TICK = 0.5  # seconds between looks around
_QUEUED = 2  # batches per worker that are out at once: one at work, one ready
_BATCH_SECONDS = 0.5  # runs shorter than this travel together
_LONGEST_BATCH = 256
_HOPELESS = 3  # workers that died in a row, without one batch done in between


class Serial(Executor):
    """An executor that works at once, in the caller's own process and thread.

    Examples
    --------
    >>> Serial().submit(pow, 2, 5).result()
    32
    """

    def submit(self, function: Callable[..., Any], /, *arguments: Any, **options: Any) -> Future[Any]:
        """Call the function now; Ctrl-C ends it and goes on to the caller."""
        future: Future[Any] = Future()
        try:
            future.set_result(function(*arguments, **options))
        except Exception as error:
            future.set_exception(error)
        return future


@dataclass
class Crew:
    """An executor and what must be known of it to keep it busy.

    Parameters
    ----------
    executor : Executor
        Who works.
    width : callable
        How many batches it can work on at once, now.
    renew : callable, optional
        Gives a new executor after a worker's death broke this one.
    loses : bool
        Whether a result may be lost with its worker, whatever error that then is: Dask's.
    """

    executor: Executor
    width: Callable[[], int]
    renew: Callable[[], Executor] | None = None
    loses: bool = False


@contextmanager
def crew(executor: Executor | None = None, *, cluster: str | None = None, jobs: int | None = None) -> Iterator[Crew]:
    """Who makes the runs; what is started here ends here."""
    ensure_crew(executor, cluster, jobs)
    count = cores() if jobs is None else jobs
    if executor is not None:
        width = getattr(executor, "_max_workers", None) or cores()
        yield Crew(executor, lambda: width)
    elif cluster is not None:
        from flockana.ensemble.cluster import connected

        with connected(cluster, count) as (workers, threads):
            yield Crew(workers, threads, loses=True)
    elif count == 1:
        yield Crew(Serial(), lambda: 1)
    else:
        with _pool(count) as found:
            yield found


def ensure_crew(executor: Any, cluster: Any, jobs: Any) -> None:
    """Check who shall make the runs, before anything is started."""
    if executor is not None and not isinstance(executor, Executor):
        raise ArgumentError(f"executor = {executor!r}: expected a concurrent.futures.Executor")
    if executor is not None and (cluster is not None or jobs is not None):
        raise ArgumentError("executor, and cluster or jobs: expected one of them; an executor has its own size")
    if cluster is not None and not (isinstance(cluster, str) and cluster):
        raise ArgumentError(f"cluster = {cluster!r}: expected the address of a Dask scheduler, or 'local'")
    if cluster not in (None, "local") and jobs is not None:
        raise ArgumentError(f"jobs = {jobs}: the cluster at {cluster} has its own size; leave it out")
    if jobs is not None:
        ensure_count("jobs", jobs)


@contextmanager
def _pool(count: int) -> Iterator[Crew]:
    """A process pool of our own, made anew when a worker dies."""
    pools = [ProcessPool(count)]

    def renew() -> Executor:
        pools[-1].stop()
        pools.append(ProcessPool(count))
        return pools[-1]

    try:
        yield Crew(pools[0], lambda: count, renew)
        pools[-1].shutdown()
    except BaseException:
        pools[-1].stop()
        raise


def make_runs(request: Request, jobs: Sequence[Job], hands: Crew) -> Iterator[tuple[Record, ...]]:
    """Make runs by whoever does it; records come as batches of them are done.

    A run that ends its worker (for want of memory, say) is found by trying those under suspicion one at a time, and
    recorded as such; all others are made again.
    """
    waiting, suspects = deque(jobs), deque[Job]()
    pending: dict[Future[tuple[Record, ...]], tuple[Job, ...]] = {}
    dead: list[Record] = []  # kept back until a batch is done: only then the fault was theirs
    size = 1
    try:
        while waiting or suspects or pending:
            for batch in _next_batches(waiting, suspects, len(pending), hands.width(), size):
                try:
                    pending[hands.executor.submit(run_batch, request, batch)] = batch
                except Exception as error:  # it broke since we last looked: whoever it was, not this batch
                    suspects.extend(_under_suspicion(error, batch, pending, hands))
                    break
            done, _ = wait_for(pending, timeout=_TICK, return_when=FIRST_COMPLETED)
            for future in done:
                batch = pending.pop(future)
                try:
                    records = future.result()
                except Exception as error:
                    alone = len(batch) == 1 and not pending
                    lost = hands.loses and not isinstance(error, FlockanaError)  # `width` tells if all is over
                    found = batch if lost else _under_suspicion(error, batch, pending, hands)
                    if not alone:
                        suspects.extend(found)
                        break  # what else is done is still pending, or under suspicion
                    dead.append(Record(batch[0], DIED, "the worker process that made this run ended"))
                    if len(dead) == _HOPELESS:
                        raise _hopeless() from error
                else:
                    size = _batch_size(records)
                    yield (*dead, *records)
                    dead.clear()
        yield tuple(dead)
    except BaseException:
        for future in pending:
            future.cancel()
        raise


def _next_batches(
    waiting: deque[Job], suspects: deque[Job], out: int, width: int, size: int
) -> Iterator[tuple[Job, ...]]:
    """Batches to send now: a few per worker; one run alone while some are suspected of ending workers."""
    if suspects:
        if not out:
            yield (suspects.popleft(),)
        return
    for _ in range(_QUEUED * width - out):
        if waiting:
            fair = max(1, len(waiting) // (_QUEUED * width))  # so that all workers end together
            yield tuple(waiting.popleft() for _ in range(min(size, fair)))


def _batch_size(records: tuple[Record, ...]) -> int:
    """How many runs make a batch of about half a second, by the last ones that were made."""
    each = sum(one.seconds for one in records) / len(records)
    return int(min(_LONGEST_BATCH, max(1.0, _BATCH_SECONDS / max(each, 1e-6))))


def _under_suspicion(
    error: BaseException, batch: tuple[Job, ...], pending: dict[Any, tuple[Job, ...]], hands: Crew
) -> tuple[Job, ...]:
    """The runs any of which may have ended a worker; raises if it was something else, or nothing can go on."""
    if type(error).__name__ == "KilledWorker":  # Dask's, after it tried the batch on several workers
        return batch
    if isinstance(error, BrokenExecutor) and hands.renew is not None:
        found = (*batch, *(job for other in pending.values() for job in other))
        pending.clear()
        hands.executor = hands.renew()
        return found
    if isinstance(error, FlockanaError):
        raise error
    raise _failed(error) from error


def _failed(error: BaseException) -> SolverError:
    return SolverError(
        f"the executor failed: {type(error).__name__}: {error}; runs in a store are kept, so mend it and start again"
    )


def _hopeless() -> SolverError:
    return SolverError(
        f"{_HOPELESS} worker processes died one after the other: a script that starts an ensemble must do so under "
        "`if __name__ == '__main__':`; if memory is short, use jobs=1 (--jobs 1)"
    )
