"""Ensembles of a scenario over seeds and options, in parallel, with a store to resume from."""

import inspect
import os
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from concurrent.futures import Executor
from contextlib import ExitStack
from itertools import islice
from math import prod
from pathlib import Path
from pkgutil import resolve_name
from types import NoneType
from typing import TYPE_CHECKING, Any

import numpy as np

from flockana.base.digests import sha256
from flockana.base.errors import ArgumentError, format_value
from flockana.base.integrity_seals import digest
from flockana.base.progress import progress_bar
from flockana.base.serialize import to_data
from flockana.base.value_checks import TimeSpan, ensure_kind, ensure_known
from flockana.dynamics.trajectory import Trajectory
from flockana.ensemble.dataset import RESERVED, Grid, metric_name, to_dataset
from flockana.ensemble.executors import ensure_worker_options, worker_pool
from flockana.ensemble.one_run import COMPLETE, Job, Request, Scalar, reference
from flockana.ensemble.process_guard import can_start_processes
from flockana.ensemble.runs import make_runs
from flockana.ensemble.store import Store
from flockana.ensemble.worker_processes import cores
from flockana.measures.measure import measures
from flockana.scenarios import Flock, Scenario, scenarios
from flockana.scenarios import scenario as named_scenario
from flockana.scenarios.flock import chosen as chosen_flock
from flockana.scenarios.option_checks import SOURCE
from flockana.theorems import Theorem, Tolerances, theorem, theorems

if TYPE_CHECKING:
    import xarray

MOST = 1_000_000  # runs of one ensemble: each is held in memory, with its record, until the dataset is made
_REMEDY = "split them into several ensembles"


def ensemble(
    scenario: str | Flock | Callable[..., Scenario] | None = None,
    seeds: Iterable[int] = (0,),
    *,
    law: Any = None,
    q0: Any = None,
    p0: Any = None,
    t_span: TimeSpan | None = None,
    theorems: Iterable[str | Theorem] | None = None,
    parameters: Mapping[str, Scalar | Iterable[Scalar]] | None = None,
    metrics: Iterable[str | Callable[[Trajectory], float]] | None = None,
    tolerances: Tolerances | None = None,
    executor: Executor | None = None,
    jobs: int | None = None,
    store: str | os.PathLike[str] | None = None,
    retry: bool = False,
    progress: bool = False,
) -> "xarray.Dataset":
    """Run and verify a scenario for many seeds, and for all combinations of given options.

    The same seeds give the same numbers, ``seconds`` aside, whoever computes them and in whatever order, on processors
    of one kind with the same libraries. A run that fails is part of the result, with its error; it ends nothing.

    Parameters
    ----------
    scenario : str, Flock or callable
        A name of the catalogue, a flock, or a function ``seed, **options -> Scenario`` from the top of a module.
    seeds : iterable of int
        Seeds, each >= 0 and given once; with all combinations of options at most a million runs.
    law, q0, p0, t_span : optional
        Instead of a scenario: the parts of a `Flock`; q0 and p0 are functions of the seed if there are several seeds.
    theorems : iterable of str or Theorem, optional
        Which to check: names, or claims of your own (`claim`), whose margin other processes can have only if it stands
        at the top of a module (else this one makes the runs, with a warning); ``"source"`` stands for what the source
        reports. By default all of the scenario's own and what its source reports, or all that are about the law of a
        flock. Empty for none.
    parameters : mapping of str to scalar or iterable, optional
        Options of the scenario, or numbers of a flock's law by dotted name, such as ``"gains.c1_gamma"``: several
        values make a dimension of the result, one value does not.
    metrics : iterable of str or callable
        What to keep of each run: names, by default all there are, or functions ``trajectory -> float`` from the
        top of a module.
    executor : concurrent.futures.Executor, optional
        Who computes, such as Dask's ``client.get_executor(pure=False)`` or loky's; it is left running. By default a
        pool of processes that is started for the purpose.
    jobs : int, optional
        Processes to start, by default one per core; with 1 this process computes. Of a given executor the number of
        its workers, where it does not say it itself.
    store : path-like, optional
        File that keeps runs as they are done. What it holds is not computed again, so an interrupted ensemble goes on
        from where it was when the same call is made again; a larger one computes what it lacks.
    retry : bool
        Make runs anew that the store holds as failed.
    progress : bool
        Show a bar with rate and time left, on a terminal.

    Returns
    -------
    xarray.Dataset
        Over the parameters and ``seed``: ``status``, ``margin`` and ``error`` of each claim (dimension ``claim``),
        ``verdict`` of each theorem (dimension ``theorem``), the metrics, and of each run its status ``run``,
        ``message``, ``steps``, ``evaluations`` and ``seconds``. Codes are explained by their ``flag_meanings``; -1 is
        a claim that was not checked. `shares` makes a table of it.

    Raises
    ------
    ArgumentError
        On bad input, before anything is computed.
    FileError
        If the store cannot be written, is damaged, or is of another version.
    SolverError
        If the executor fails; what was done is in the store, and the same call with another executor goes on from it.
    KeyboardInterrupt
        On Ctrl-C; it says how many runs are done, and where they are stored.

    Examples
    --------
    >>> runs = ensemble("hexagon", range(4), theorems=["os-1"], jobs=1)
    >>> runs.claim.values.tolist()
    ['os-1:i', 'os-1:ii', 'os-1:iii', 'os-1:iii-barrier']
    >>> runs.status.sel(claim="os-1:iii").values.tolist()  # 0 is verified
    [0, 0, 0, 0]
    """
    ensure_worker_options(executor, jobs)
    grid = Grid(*_split(parameters), ensure_seeds(seeds))
    if (runs := prod(grid.shape)) > MOST:
        raise ArgumentError(f"{runs} runs: expected at most {MOST}, seeds times values of options; {_REMEDY}")
    chosen_metrics = _ensure_metrics(metrics)
    names = Counter((*RESERVED, *grid.axes, *grid.fixed, *map(metric_name, chosen_metrics)))
    for name in (name for name, count in names.items() if count > 1):
        raise ArgumentError(f"{name}: the result has another variable of that name; leave it out or rename it")
    ensure_kind("tolerances", tolerances, (Tolerances, NoneType), "flockana.Tolerances(...)")
    chosen = chosen_flock(scenario, law=law, q0=q0, p0=p0, t_span=t_span)
    flock = chosen if isinstance(chosen, Flock) else None
    if flock is None:
        name, checked = _ensure_scenario(chosen, grid), _ensure_theorems(theorems)
    else:
        name, checked = flock.name, _ensure_flock(flock, grid, theorems)
    own_theorems = tuple(item for item in checked or () if isinstance(item, Theorem))
    ids = None if checked is None else tuple(item.id if isinstance(item, Theorem) else item for item in checked)
    request = Request(name, ids, chosen_metrics, tolerances or Tolerances(), flock=flock, own=own_theorems)
    all_jobs = grid.jobs()
    with ExitStack() as stack:
        open_store = None if store is None else stack.enter_context(Store(store))
        keys = _keys(request, all_jobs, strict=open_store is not None)
        records = {} if open_store is None else open_store.read(keys.values())
        if retry:
            records = {key: record for key, record in records.items() if record.status == COMPLETE}
        missing = [job for job in all_jobs if keys[job] not in records]
        if missing:
            advance = stack.enter_context(progress_bar(len(missing), enabled=progress, steady=True))
            text = f"runs, {len(all_jobs) - len(missing)} stored before" if len(missing) < len(all_jobs) else "runs"
            count_done = 0
            if executor is None:
                jobs = min(jobs or cores(), len(missing))
                jobs = 1 if jobs > 1 and not can_start_processes(request) else jobs
            try:
                with worker_pool(executor, jobs=jobs) as workers:
                    for batch in make_runs(request, missing, workers):
                        new_records = {keys[record.job]: record for record in batch}
                        if open_store is not None:
                            open_store.add(name, new_records)
                        records |= new_records
                        count_done += len(new_records)
                        advance(count_done, text)
            except KeyboardInterrupt:
                store_text = (
                    "a store would keep them"
                    if store is None
                    else f"they are stored in {store}, and the same call goes on"
                )
                raise KeyboardInterrupt(f"{len(records)} of {len(all_jobs)} runs done; {store_text}") from None
    return to_dataset(request, grid, [records[keys[job]] for job in all_jobs])


def ensure_seeds(seeds: Any) -> tuple[int, ...]:
    """Return seeds as a tuple of whole numbers >= 0, each of them once."""
    if isinstance(seeds, str) or not isinstance(seeds, Iterable):
        raise ArgumentError(f"seeds = {seeds!r}: expected several whole numbers, such as range(200)")
    unique: dict[int, None] = {}
    for seed in islice(seeds, MOST + 1):  # there may be no end of them
        if isinstance(seed, bool) or not isinstance(seed, int | np.integer) or not 0 <= seed < 2**63:
            raise ArgumentError(f"seed {seed!r}: expected a whole number >= 0, below 2^63")
        if seed in unique:
            raise ArgumentError(f"seed {seed} comes twice: expected different seeds")
        unique[int(seed)] = None
    if not unique:
        raise ArgumentError("seeds: empty; expected at least one, such as range(200)")
    if len(unique) > MOST:
        raise ArgumentError(f"seeds: there are more than {MOST}; expected at most so many, {_REMEDY}")
    return tuple(unique)


def _split(parameters: Any) -> tuple[dict[str, list[Scalar]], dict[str, Scalar]]:
    """Return scenario options split into varied ones, with several values each, and fixed ones."""
    axes: dict[str, list[Scalar]] = {}
    fixed_values: dict[str, Scalar] = {}
    if not isinstance(parameters, Mapping | None):
        raise ArgumentError(f"parameters = {parameters!r}: expected a dictionary, such as {{'n': [20, 40]}}")
    for name, options in (parameters or {}).items():
        if isinstance(options, str) or not isinstance(options, Iterable):
            fixed_values[name] = _scalar(name, options)
            continue
        values = [_scalar(name, value) for value in islice(options, MOST + 1)]
        if len(values) > MOST:
            raise ArgumentError(f"{name}: there are more than {MOST} values; expected at most so many, {_REMEDY}")
        if not values or len(set(values)) < len(values) or len({isinstance(v, str) for v in values}) > 1:
            raise ArgumentError(f"{name} = {values}: expected at least one value, all different and of one kind")
        axes[name] = values
    return axes, fixed_values


def _scalar(name: str, value: Any) -> Scalar:
    plain_value = value.item() if isinstance(value, np.generic) else value
    if not isinstance(plain_value, bool | int | float | str) or plain_value != plain_value:
        raise ArgumentError(f"{name} = {value!r}: expected numbers, texts or truth values that an option can have")
    return plain_value


def _ensure_metrics(metrics: Any) -> tuple[str, ...]:
    if metrics is None:
        return tuple(measures())
    if isinstance(metrics, str) or not isinstance(metrics, Iterable):
        raise ArgumentError(f"metrics = {metrics!r}: expected several names or functions, such as ('strain',)")
    return tuple(reference(each) if callable(each) else ensure_known("metric", each, measures()) for each in metrics)


def _ensure_theorems(given: Any) -> tuple[str | Theorem, ...] | None:
    if given is None:
        return None
    if isinstance(given, str | Theorem) or not isinstance(given, Iterable):
        raise ArgumentError(f"theorems = {given!r}: expected several, such as ['os-1', '{SOURCE}', claim(...)]")
    items, catalogue = {(item.id if isinstance(item, Theorem) else item): item for item in _named(given)}, theorems()
    for name, item in items.items():
        if not isinstance(item, Theorem):
            ensure_known("theorem", name, (SOURCE, *catalogue))
        elif name == SOURCE or (name in catalogue and item is not theorem(name)):
            raise ArgumentError(f"theorems: your claim {name!r} has the name of one in the catalogue; rename it")
        if name != SOURCE and theorem(item).kind != "trajectory":
            raise ArgumentError(f"{name} is not about a run: expected theorems about motion, such as os-1")
    return tuple(name if name in catalogue else item for name, item in items.items())


def _named(given: Iterable[Any]) -> Iterator[Any]:
    """Yield theorems given by name or as the user's own claims; raise on other values."""
    for item in given:
        if not isinstance(item, str | Theorem):
            raise ArgumentError(f"theorems: {format_value(item)}: expected names of theorems, or claims of your own")
        yield item


def _ensure_scenario(scenario: Any, grid: Grid) -> str:
    """Return the name of a scenario after building it once with each option."""
    if isinstance(scenario, str):
        ensure_known("scenario", scenario, scenarios())
        for job in grid.jobs(1):
            named_scenario(scenario, job.seed, **dict(job.options))
        return scenario
    if not callable(scenario):
        raise ArgumentError(f"scenario = {scenario!r}: expected a name of the catalogue or a function")
    name = reference(scenario)
    try:
        inspect.signature(scenario).bind(0, **dict.fromkeys((*grid.axes, *grid.fixed)))
    except TypeError as error:
        raise ArgumentError(f"{name} cannot be called with a seed and these options: {error}") from None
    return name


def _ensure_flock(flock: Flock, grid: Grid, theorems: Any) -> tuple[str | Theorem, ...]:
    """Return the theorems to check on a flock after building it once with each combination of parameters."""
    if len(grid.seeds) > 1 and not flock.drawn:
        raise ArgumentError(
            f"{len(grid.seeds)} seeds, but q0 and p0 are arrays, so all runs would be the same: expected functions of "
            "a seed, such as q0=lambda seed: 20 * numpy.random.default_rng(seed).random((30, 2)), or one seed"
        )
    for job in grid.jobs(1):
        flock.scenario(job.seed, **dict(job.options))
    return flock.theorems(grid.seeds[0]) if theorems is None else _ensure_theorems(theorems) or ()


def _keys(request: Request, grid: Sequence[Job], *, strict: bool) -> dict[Job, str]:
    """Return the key of each run, including the source of user functions."""
    shared_settings = request.to_dict(strict=strict)
    own_names = {name for name in (request.scenario, *request.metrics) if ":" in name}
    shared_settings["own"] = {name: _file_digest(resolve_name(name), name, strict) for name in sorted(own_names)}
    margins = {f"claim {item.id}": getattr(item.check, "margin", item.check) for item in request.own}
    starts = {} if request.flock is None else {key: getattr(request.flock, key) for key in ("q0", "p0")}
    for key, function in (margins | {key: start for key, start in starts.items() if callable(start)}).items():
        shared_settings["own"][key] = [_file_digest(function, key, strict), *_written(function, key, strict)]
    return {job: digest(shared_settings | {"seed": job.seed, "options": dict(job.options)}) for job in grid}


def _written(function: Any, name: str, strict: bool) -> list[Any]:
    """Return the source line of a user's function, and the values captured by the function."""
    cells = (cell.cell_contents for cell in getattr(function, "__closure__", None) or ())
    default_values = getattr(function, "__defaults__", None), (getattr(function, "__kwdefaults__", None) or {}).values()
    closure_values = (*cells, *(default_values[0] or ()), *default_values[1])
    try:
        values: Any = [to_data(value) for value in closure_values]
    except ArgumentError as error:
        if strict:
            raise ArgumentError(f"{name}: its function holds a value that a store cannot write: {error}") from None
        values = repr(closure_values)
    return [getattr(getattr(function, "__code__", None), "co_firstlineno", 0), values]


def _file_digest(function: Any, name: str, strict: bool) -> str:
    """Return a digest of the file that defines a user's function."""
    try:
        file = Path(inspect.getsourcefile(function) or "")
    except TypeError:  # an object with no source
        file = Path()
    if file.is_file():
        return sha256([file.read_bytes()])
    if strict:
        raise ArgumentError(
            f"{name}: its source file is not known, so a store cannot tell its versions apart; leave "
            "the store out, or put the function into a module"
        )
    return ""
