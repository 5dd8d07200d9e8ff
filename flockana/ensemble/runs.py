"""Execution of an ensemble's runs on workers."""

from collections.abc import Iterator, Sequence
from functools import partial

from flockana.base.errors import ArgumentError, FlockanaError, SolverError
from flockana.ensemble.batches import map_in_batches
from flockana.ensemble.executors import WorkerPool
from flockana.ensemble.one_run import DIED, Job, Record, Request, run_batch

BATCH_SECONDS = 0.5  # runs shorter than this travel together
_LONGEST_BATCH = 256
SENDABLE = "to be sent to a worker, functions of starts and claims are written with def at the top of a module"


def make_runs(request: Request, jobs: Sequence[Job], workers: WorkerPool) -> Iterator[tuple[Record, ...]]:
    """Make runs and yield their records; a run that kills its worker is recorded as failed."""
    try:
        for batch in map_in_batches(jobs, partial(run_batch, request), workers, batch_size=_batch_size):
            yield tuple(
                Record(job, DIED, "the worker process that made this run ended") if record is None else record
                for job, record in batch
            )
    except FlockanaError:
        raise
    except Exception as error:  # what a run raises is in its record: this comes from who works
        if "pickle" in f"{type(error).__name__} {error}".lower():
            raise ArgumentError(f"{type(error).__name__}: {error}; {SENDABLE}") from error
        raise SolverError(
            f"the executor failed: {type(error).__name__}: {error}; runs in a store are kept: make the same call with "
            "a new executor, and only what is missing is computed"
        ) from error


def _batch_size(records: tuple[Record, ...]) -> int:
    """Return the number of runs in a batch of about half a second, from recent timings."""
    seconds_per_run = sum(record.seconds for record in records) / len(records)
    return int(min(_LONGEST_BATCH, max(1.0, BATCH_SECONDS / max(seconds_per_run, 1e-6))))
