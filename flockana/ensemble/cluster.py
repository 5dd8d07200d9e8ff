"""Dask clusters, local or by address; every wait has a time limit, and failures close the client.

A client that is left open closes itself when it is collected, and waits for ever if Dask holds its own lock just then.
"""

import gc
import time
from collections.abc import Callable, Iterator
from concurrent.futures import Executor
from contextlib import contextmanager, suppress
from typing import Any

from flockana.base.errors import ArgumentError, SolverError
from flockana.base.interrupts import block_sigint, defer_sigint, restore_interrupts
from flockana.ensemble.processes import single_threaded_children

CONNECT = 10.0  # seconds to find a scheduler and a worker
START = 120.0  # seconds for worker processes of our own to stand
ALONE = 60.0  # seconds without an answer of the scheduler, or without any worker, until a cluster at work is given up
_CLOSE = 10.0  # seconds to say goodbye
_GRACE = 1.0  # seconds more for Dask to say itself what is wrong
_LOOK = 0.05  # seconds between looks for a first worker


@contextmanager
def connected(address: str, count: int) -> Iterator[tuple[Executor, Callable[[], int]]]:
    """Return the executor of a cluster, and a function for its current number of threads."""
    try:
        import distributed  # noqa: F401
    except ImportError as error:
        raise ArgumentError(
            f"cluster = {address!r}: Dask is not installed; pip install 'flockana[cluster]', or leave cluster out"
        ) from error
    own = None
    try:
        if address == "local":
            with defer_sigint(), block_sigint(), single_threaded_children():
                own = _own_cluster(count)
        client = _client(own or address, address)
        try:
            # by default Dask takes two calls that look alike for one and gives the first one's result again
            yield client.get_executor(pure=False), _size_of(client)
        finally:
            _end(client)
    finally:
        if own is not None:
            _end(own)


def _own_cluster(count: int) -> Any:
    """Start worker processes on this machine."""
    from distributed import LocalCluster, Nanny

    class LimitedNanny(Nanny):  # type: ignore[misc]
        async def close(self, *args: Any, **options: Any) -> Any:
            started = self.process and self.process.process
            try:
                return await super().close(*args, **options)
            finally:  # a process that was given up while it started is let go, not ended
                if started is not None and started.is_alive():
                    await started.kill()
                    await started.join(_CLOSE)

    cluster = LocalCluster.__new__(LocalCluster)  # so that there is something to close if the constructor fails
    try:
        cluster.__init__(
            n_workers=count,
            threads_per_worker=1,
            worker_class=LimitedNanny,
            host="127.0.0.1",
            dashboard_address="127.0.0.1:0",
            silence_logs=50,
            death_timeout=START,
        )
        return cluster
    except Exception as error:
        reason = _reason(error)
    _end(cluster)
    del cluster
    gc.collect()
    raise SolverError(
        f"cluster = 'local': its worker processes do not start ({reason}); a script that starts a cluster must do so "
        "under `if __name__ == '__main__':`; or use jobs=1 (--jobs 1)"
    )


def _client(target: Any, address: str) -> Any:
    """Return a client of a cluster, or of the scheduler at an address, with at least one worker."""
    try:
        with restore_interrupts():
            return _opened(target)
    except Exception as error:
        reason = _reason(error)
    gc.collect()  # free a discarded client now, while no lock of Dask is held
    raise SolverError(
        f"cluster = {address!r}: no scheduler with a worker answers within {CONNECT:g} s ({reason}); start "
        "them with `dask scheduler` and `dask worker ADDRESS --nthreads 1`, and give the scheduler's address"
    )


def _opened(target: Any) -> Any:
    """Return a client with a worker, or raise within the time limit after closing it."""
    from distributed import Client

    class LimitedClient(Client):  # type: ignore[misc]
        def start(self, **options: Any) -> None:
            try:
                # its own limit does not hold for a server that takes the call and says nothing
                super().start(callback_timeout=CONNECT + _GRACE, **options)
            except BaseException:  # if the constructor fails, no other code can close the client
                _end(self)
                raise

    client = LimitedClient(target, timeout=CONNECT, set_as_default=False)
    try:
        deadline = time.monotonic() + CONNECT
        while not _threads(client, CONNECT):
            if time.monotonic() > deadline:
                raise TimeoutError("it has no workers")
            time.sleep(_LOOK)
    except BaseException:
        _end(client)
        raise
    return client


def _threads(client: Any, limit: float) -> int:
    """Return the current number of threads of the cluster's workers."""
    return int(sum(client.sync(client.scheduler.ncores, callback_timeout=limit).values()))


def _size_of(client: Any) -> Callable[[], int]:
    """Return a function for the number of runs that a cluster can make at once, at present."""
    seen = time.monotonic()

    def size() -> int:
        nonlocal seen
        try:
            threads = _threads(client, ALONE)
        except Exception as error:  # whatever Dask makes of a scheduler that is gone
            raise SolverError(
                f"the executor failed: Dask's scheduler does not answer ({_reason(error)}); runs in a store are kept, "
                "so mend it and start again"
            ) from error
        now = time.monotonic()
        if threads:
            seen = now
        elif now - seen > ALONE:
            raise SolverError(
                f"the executor failed: the cluster has had no worker for {ALONE:g} s; runs in a store are kept, so "
                "start workers and go on"
            )
        return max(1, threads)

    return size


def _end(closing: Any) -> None:
    """Close a client or a cluster, also after a failed constructor, with the thread that it started."""
    with defer_sigint():
        with suppress(Exception):  # there is nobody left to answer
            closing.close(timeout=_CLOSE)
        with suppress(AttributeError):  # it failed before it had one
            closing._loop_runner.stop()


def _reason(error: BaseException) -> str:
    text = str(error) or "no answer" * isinstance(error, TimeoutError)
    return " ".join(f"{type(error).__name__}: {text}".split())
