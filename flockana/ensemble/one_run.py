"""Execution of a single run of an ensemble, from plain data to a plain record."""

import json
import time
from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import asdict, dataclass, field, replace
from pkgutil import resolve_name
from typing import Any, Self

from flockana.base.errors import ArgumentError, FileError, SolverError
from flockana.base.integrity_seals import SEAL, digest
from flockana.base.interrupts import restore_interrupts
from flockana.base.serialize import to_data, to_data_mapping
from flockana.dynamics.predicates import ensure_uninterrupted
from flockana.dynamics.trajectory import Trajectory
from flockana.ensemble.digest import numerics_version
from flockana.measures.measure import measures
from flockana.scenarios import Flock, Scenario, scenario
from flockana.scenarios.option_checks import SOURCE
from flockana.theorems import Theorem, Tolerances, Verdict

Scalar = bool | int | float | str
COMPLETE, FAILED, ERROR, DIED = "complete", "failed", "error", "died"


@dataclass(frozen=True)
class Job:
    """One run of an ensemble: a seed and options."""

    seed: int
    options: tuple[tuple[str, Scalar], ...] = ()  # of the scenario, sorted by name


@dataclass(frozen=True)
class Request:
    """Settings shared by all runs of an ensemble, as names and numbers that can be sent to a process."""

    scenario: str  # a name of the catalogue, or ``"module:function"``
    # which to check; by default all of the scenario's own and what its source reports
    theorems: tuple[str, ...] | None = None
    # names of measures, or ``"module:function"``
    metrics: tuple[str, ...] = field(default_factory=lambda: tuple(measures()))
    tolerances: Tolerances = field(default_factory=Tolerances)
    mathematics: str = field(default_factory=numerics_version)  # version that the runs must be computed by
    flock: Flock | None = None  # instead of a scenario's name
    own: tuple[Theorem, ...] = ()  # the user's claims, which `theorems` names

    def to_dict(self, *, strict: bool = False) -> dict[str, Any]:
        """Return the settings of an ensemble as plain data, of which the keys of stored runs are made."""
        plain_value: Any = None
        if (flock := self.flock) is not None:
            start = ("drawn" if callable(item) else item for item in (flock.q0, flock.p0))  # digested apart
            parts = flock.law, *start, flock.t_span
            try:
                plain_value = [*map(to_data, parts), to_data_mapping(flock.options)]
            except ArgumentError as error:
                if strict:
                    raise ArgumentError(f"store: {error}") from None
                plain_value = repr((*parts, flock.options))  # functions as their names, which tell no versions apart
        data = asdict(replace(self, flock=None, own=()))
        del data["own"]  # their ids are among the theorems, their sources in the key
        return {**data, "flock": plain_value}


@dataclass(frozen=True)
class Record:
    """Record of one run of an ensemble."""

    job: Job  # which run
    status: str  # complete; ended early by the integrator; raised an error; or ended its worker process
    message: str = ""  # why, if not complete
    verdicts: Mapping[str, str] = field(default_factory=dict)  # status by theorem
    # status, margin and error of the margin by ``"theorem:claim"``
    claims: Mapping[str, tuple[str, float | None, float | None]] = field(default_factory=dict)
    metrics: Mapping[str, float] = field(default_factory=dict)  # measures by name
    stats: Mapping[str, int] = field(default_factory=dict)  # steps and evaluations
    seconds: float = 0.0  # wall time of simulating and checking: the one entry that differs from run to run

    def to_json(self, key: str = "") -> str:
        """Return JSON that restores every number exactly (NaN and infinities in Python's spelling), with a digest."""
        data = asdict(self)
        return json.dumps({**data, SEAL: digest([key, data])}, ensure_ascii=False)

    @classmethod
    def from_json(cls, text: str, key: str = "") -> Self:
        """Return the record of a JSON text from `to_json`."""
        data = json.loads(text)
        if data.pop(SEAL, None) != digest([key, data]):
            raise FileError("its digest is not that of its contents")
        job, claims = data.pop("job"), data.pop("claims")
        options = tuple((name, value) for name, value in job["options"])
        return cls(Job(job["seed"], options), claims={k: tuple(v) for k, v in claims.items()}, **data)


def reference(function: Callable[..., Any]) -> str:
    """Return ``"module:name"`` of a function that another process can import."""
    name = f"{getattr(function, '__module__', None)}:{getattr(function, '__qualname__', None)}"
    with suppress(ImportError, AttributeError, ValueError):
        if resolve_name(name) is function:
            return name
    raise ArgumentError(
        f"{function!r}: other processes cannot import it; expected a function defined at the top of a module"
    )


def run_batch(request: Request, jobs: tuple[Job, ...]) -> tuple[Record, ...]:
    """Simulate and verify runs of an ensemble one after the other in this process."""
    if numerics_version() != request.mathematics:
        raise SolverError(
            f"a worker computes with version {numerics_version()} of the mathematics, expected {request.mathematics}: "
            "give all machines the same flockana, Python, numpy, scipy and numba, edit none of it meanwhile, and start "
            "the workers anew"
        )
    return tuple(run_one(request, job) for job in jobs)


def run_one(request: Request, job: Job) -> Record:
    """Simulate and verify one run of an ensemble; an error becomes part of its record."""
    start_time = time.perf_counter()
    try:
        with restore_interrupts():
            item = build(request, job)
            run = ensure_uninterrupted(item.run())
            if run.status == COMPLETE:
                record = _judge_run(request, job, item, run)
            else:  # of a part of the run no claim about the whole follows
                record = Record(job, FAILED, run.message, stats=_stats(run))
    except Exception as error:
        record = Record(job, ERROR, f"{type(error).__name__}: {' '.join(str(error).split())}")
    return replace(record, seconds=time.perf_counter() - start_time)


def build(request: Request, job: Job) -> Scenario:
    """Return the scenario of one run of an ensemble, built from the run's seed and options."""
    if request.flock is not None:
        return request.flock.scenario(job.seed, **dict(job.options))
    name = request.scenario
    if ":" not in name:
        return scenario(name, job.seed, **dict(job.options))
    flock = resolve_name(name)(job.seed, **dict(job.options))
    if not isinstance(flock, Scenario):
        raise ArgumentError(f"{name} returned {type(flock).__name__}: expected a Scenario")
    return flock


def _judge_run(request: Request, job: Job, item: Scenario, run: Trajectory) -> Record:
    verdicts = _verdicts(request, item, run)
    claims: dict[str, Any] = {}
    for verdict in verdicts:
        for claim in verdict.claims:
            margin_values = (None if x is None else float(x) for x in (claim.margin, claim.error))
            claims[f"{verdict.theorem}:{claim.name}"] = (claim.status, *margin_values)
    metrics = {
        name: float((resolve_name(name) if ":" in name else measures()[name].number)(run)) for name in request.metrics
    }
    statuses: dict[str, str] = {verdict.theorem: verdict.status for verdict in verdicts}
    return Record(job, COMPLETE, "", statuses, claims, metrics, _stats(run))


def _verdicts(request: Request, item: Scenario, run: Trajectory) -> tuple[Verdict, ...]:
    tolerances = request.tolerances
    if request.theorems is None:
        return item.verify(run, tolerances=tolerances)
    own_theorems = {entry.id: entry for entry in request.own}
    names = [name for name in request.theorems if name != SOURCE]
    verdicts = [item.verdict(own_theorems.get(name, name), run, tolerances=tolerances) for name in names]
    if SOURCE in request.theorems:
        verdicts += item.reported(run, tolerances=tolerances)
    return tuple(verdicts)


def _stats(run: Trajectory) -> dict[str, int]:
    return {name: int(run.stats[name]) for name in ("steps", "evaluations") if name in run.stats}
