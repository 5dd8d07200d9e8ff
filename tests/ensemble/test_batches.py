from concurrent.futures import Executor, Future
from concurrent.futures.process import BrokenProcessPool

import pytest

from flockana.base.errors import SolverError
from flockana.ensemble.batches import map_in_batches
from flockana.ensemble.executors import WorkerPool, worker_pool


class Mortal(Executor):
    """As a process pool of which some items end the worker; `sent` are the batches that it was given."""

    def __init__(self, lethal):
        self.lethal, self.sent = frozenset(lethal), []

    def submit(self, function, /, batch):
        self.sent.append(batch)
        future = Future()
        if self.lethal.isdisjoint(batch):
            future.set_result(function(batch))
        else:
            future.set_exception(BrokenProcessPool("a child process terminated abruptly"))
        return future


def squares(batch):
    return tuple(x * x for x in batch)


def worked(pool, items, **options):
    workers = WorkerPool(pool, lambda: 2, renew=lambda: pool)
    return [pair for done in map_in_batches(items, squares, workers, **options) for pair in done]


def test_every_item_has_its_own_result_once():
    pairs = worked(Mortal([]), range(50), batch_size=lambda results: 4)
    assert sorted(pairs) == [(x, x * x) for x in range(50)]


def test_items_that_end_their_workers_are_named_and_the_others_done():
    """More of them than workers that may die in a row: in between something was done."""
    lethal = [0, 7, 14, 21, 28]
    pairs = worked(Mortal(lethal), range(40), batch_size=lambda results: 3)
    assert sorted(pairs, key=lambda pair: pair[0]) == [(x, None if x in lethal else x * x) for x in range(40)]


def test_workers_that_die_in_a_row_end_it():
    with pytest.raises(SolverError, match="3 worker processes died one after the other"):
        worked(Mortal(range(9)), range(9))


def test_the_size_of_a_batch_follows_the_last_results_and_the_end_is_shared_out():
    pool = Mortal([])
    worked(pool, range(100), batch_size=lambda results: 10)
    assert [len(batch) for batch in pool.sent][:4] == [1, 10, 10, 10]
    assert len(pool.sent[-1]) == 1


def test_an_error_of_the_function_ends_it_as_it_is():
    def fails(batch):
        raise ValueError("a bad item")

    with worker_pool(jobs=1) as workers, pytest.raises(ValueError, match="a bad item"):
        list(map_in_batches([1, 2], fails, workers))


def test_what_is_under_way_is_told_before_it_begins():
    told = []
    with worker_pool(jobs=1) as workers:
        results = map_in_batches([3, 4], squares, workers, watch=told.append)
        assert told == []
        assert next(results) == ((3, 9),)
        assert told == [(3,)]
        assert next(results) == ((4, 16),)
        assert told[-1] == (4,)
