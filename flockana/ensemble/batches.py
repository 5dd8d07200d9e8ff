"""Distribution of work to executors in batches, with results in order of completion.

Nothing is decided by which comes first, so results do not depend on who works. An item that ends its worker process
(for want of memory, say) is found by trying those under suspicion one at a time; all others are worked on again.
"""

from collections import deque
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, BrokenExecutor, Future
from concurrent.futures import wait as wait_for
from typing import Any, TypeVar

from flockana.base.errors import SolverError
from flockana.ensemble.executors import WorkerPool

_TICK = 0.2  # seconds between looks around
_QUEUED = 2  # batches per worker that are out at once: one at work, one ready
HOPELESS = 3  # workers that died in a row, without one batch done in between
_REMEDY = (
    "a script that starts them must do so under `if __name__ == '__main__':`; if memory is short, use jobs=1 (--jobs 1)"
)

Item = TypeVar("Item")
Result = TypeVar("Result")
Batch = tuple[Any, ...]
Pending = dict[Future[Any], Batch]


def map_in_batches(
    items: Sequence[Item],
    function: Callable[[tuple[Item, ...]], tuple[Result, ...]],
    workers: WorkerPool,
    *,
    batch_size: Callable[[tuple[Result, ...]], int] = lambda results: 1,
    watch: Callable[[tuple[Item, ...]], None] = lambda under_way: None,
) -> Iterator[tuple[tuple[Item, Result | None], ...]]:
    """Call a function on batches of items, and yield each item with its result as batches complete."""
    # The result is None for an item that ended its worker process. `batch_size` tells from the last results how many
    # items to send together; `watch` is told what is under way. An error of the function ends all.
    waiting_items, suspects = deque(items), deque[Any]()
    pending: Pending = {}
    dead_items: list[tuple[Item, None]] = []  # kept back until a batch is done: only then the fault was theirs
    size = 1
    try:
        while waiting_items or suspects or pending:
            width = workers.width()
            for batch in next_batches(waiting_items, suspects, len(pending), width, size):
                watch((*_under_way(pending), *batch)[:width])
                try:
                    sent_future = workers.executor.submit(function, batch)
                except Exception as error:  # the pool broke earlier: this batch is not the cause
                    suspects.extend(_suspected(error, batch, pending, workers))
                    break
                pending[sent_future] = batch
                if sent_future.done():  # this process works itself: what is done is given before more is begun
                    break
            finished, _ = wait_for(pending, timeout=_TICK, return_when=FIRST_COMPLETED)
            for future in finished:
                batch = pending.pop(future)
                try:
                    results = future.result()
                except Exception as error:
                    is_single = len(batch) == 1 and not pending
                    suspect_items = _suspected(error, batch, pending, workers)
                    if not is_single:
                        suspects.extend(suspect_items)
                        break  # what else is done is still pending, or under suspicion
                    dead_items.append((batch[0], None))
                    if len(dead_items) == HOPELESS:
                        raise SolverError(f"{HOPELESS} worker processes died one after the other: {_REMEDY}") from error
                else:
                    size = batch_size(results)
                    yield (*dead_items, *zip(batch, results, strict=True))
                    dead_items.clear()
            watch(_under_way(pending)[:width])
        if dead_items:
            yield tuple(dead_items)
    except BaseException:
        for future in pending:
            future.cancel()
        raise


def next_batches(
    waiting: deque[Any], suspects: deque[Any], out: int, width: int, size: int
) -> Iterator[tuple[Any, ...]]:
    """Return batches to submit now: a few per worker; single items while one may have killed a worker."""
    if suspects:
        if not out:
            yield (suspects.popleft(),)
        return
    for _ in range(_QUEUED * width - out):
        if waiting:
            fair_count = max(1, len(waiting) // (_QUEUED * width))  # so that all workers end together
            yield tuple(waiting.popleft() for _ in range(min(size, fair_count)))


def _under_way(pending: Pending) -> Batch:
    """Return the items in progress or next in the workers' queues."""
    return tuple(item for future, batch in pending.items() if future.running() for item in batch)


def _suspected(error: BaseException, batch: Batch, pending: Pending, workers: WorkerPool) -> Batch:
    """Return the items that may have ended a worker; raise if the failure has another cause."""
    if type(error).__name__ == "KilledWorker":  # Dask's, after it tried the batch on several workers
        return batch
    if isinstance(error, BrokenExecutor) and workers.renew is not None:
        suspect_items = (*batch, *(item for pending_batch in pending.values() for item in pending_batch))
        pending.clear()
        workers.executor = workers.renew()
        return suspect_items
    raise error
