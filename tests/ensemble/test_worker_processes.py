import os
import signal
import time
from multiprocessing import active_children

from flockana.ensemble.worker_processes import ProcessPool
from tests.programs import posix


@posix
def test_stopping_ends_workers_whatever_they_are_at():
    """One works for an hour, one does not hear requests."""
    before = {*active_children()}
    pool = ProcessPool(2)
    futures = [pool.submit(time.sleep, 3600.0) for _ in range(3)]
    workers = {*active_children()} - before
    assert len(workers) == 2
    os.kill(next(iter(workers)).pid, signal.SIGSTOP)
    pool.stop()
    assert not any(worker.is_alive() for worker in workers)
    assert all(future.done() for future in futures)


def test_stopping_what_never_started_or_has_ended_does_nothing():
    pool = ProcessPool(2)
    pool.stop()
    pool.stop()
    with ProcessPool(1) as pool:
        assert pool.submit(pow, 2, 5).result() == 32
    pool.stop()


@posix
def test_workers_never_get_ctrl_c(answering):
    """Not as long as they start, when it is blocked, nor later, when it is ignored as well."""
    with ProcessPool(1) as pool:
        assert pool.submit(_of_the_interrupt).result() == (True, signal.SIG_IGN)


@posix
def test_where_ctrl_c_is_ignored_a_pool_leaves_it_so(answering):
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    with ProcessPool(1) as pool:
        pool.submit(pow, 2, 5).result()
        assert signal.getsignal(signal.SIGINT) is signal.SIG_IGN
    assert signal.getsignal(signal.SIGINT) is signal.SIG_IGN


def _of_the_interrupt():
    return signal.SIGINT in signal.pthread_sigmask(signal.SIG_BLOCK, ()), signal.getsignal(signal.SIGINT)
