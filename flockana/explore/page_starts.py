"""Starts of the explorer's page: scenarios, laws with random flocks, and files, with equivalent Python."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cache, lru_cache
from pathlib import Path
from typing import Any

import numpy as np

from flockana.base.value_checks import FloatArray, ensure_count, ensure_dimension, ensure_known
from flockana.dynamics.trajectory import Trajectory
from flockana.environment.obstacles import Sphere
from flockana.environment.targets import StaticTarget
from flockana.falsify.counterexample import Counterexample
from flockana.laws.algorithm3 import Algorithm3
from flockana.laws.olfati_saber import Algorithm2
from flockana.laws.usual_laws import Candidate, candidates
from flockana.scenarios import scenario, scenarios
from flockana.scenarios.scenario import Scenario
from flockana.theorems import Tolerances

_FLOCK = 50  # agents of a law that is tried
_SPREAD, _SPEED = 0.9, 0.2  # side of the square over √n lengths of the law; speeds over the length per time unit
_OPTIONS = ("method", "rtol", "atol", "dt", "max_step")
FILES = (".nc", ".json")


@dataclass(frozen=True, eq=False)
class Start:
    """Law, flock and time span of a case of the explorer's page, before the user's changes."""

    title: str
    law: Any
    q0: FloatArray  # q0, p0: shape (n, m): the flock
    p0: FloatArray
    t_span: tuple[float, float]
    # python that makes ``law, q0, p0, t_span, options``, where flockana is ``fl`` and numpy is ``np``
    lines: tuple[str, ...]
    options: Mapping[str, Any] = field(default_factory=dict)
    theorems: tuple[str, ...] = ()  # ids of those that are checked
    tolerances: Tolerances = field(default_factory=Tolerances)
    tolerances_text: str = ""  # these as an expression; empty for the usual ones
    recorded: Trajectory | None = None  # the run of a file, which is shown until something is changed
    source: Scenario | None = None  # one whose source reports something of the run, as long as nothing is changed


def law_names() -> tuple[str, ...]:
    """Return the names of the laws that the explorer can try on a random flock.

    Examples
    --------
    >>> law_names()
    ('Algorithm1', 'Algorithm2', 'Algorithm3', 'CuckerSmale', 'DeadZoneFlocking')
    """
    return tuple(_tried_laws())


@cache
def _tried_laws() -> dict[str, Candidate]:
    """Return the laws that the explorer can try on a random flock, by the name of their class."""
    targeted = Candidate(Algorithm2, span=20.0), Candidate(Algorithm3, span=40.0)
    by_name = {item.law.__name__: item for item in (*targeted, *candidates().values())}
    return {name: by_name[name] for name in sorted(by_name)}


def _law(name: str, m: int, side: float) -> tuple[Any, str]:
    """Return a law with default parameters, with the γ-agent and sphere that it needs, and its Python code."""
    here = (0.0,) * m
    there, between = (2.0 * side, *here[1:]), (side, *here[1:])
    if name == "Algorithm2":
        return Algorithm2(target=StaticTarget(here)), f"fl.Algorithm2(target=fl.StaticTarget({here}))"
    if name == "Algorithm3":
        radius = round(side / 8.0, 3)
        target, text = StaticTarget(there), f"fl.StaticTarget({there}), obstacles=(fl.Sphere({between}, {radius}),)"
        return Algorithm3(target=target, obstacles=(Sphere(between, radius),)), f"fl.Algorithm3(target={text})"
    return _tried_laws()[name].law(), f"fl.{name}()"


def from_law(name: str, *, n: int = _FLOCK, m: int = 2, seed: int = 0) -> Start:
    """Return the start of a law with default parameters, and of n agents at random in a square or cube."""
    ensure_known("law", name, law_names())
    n, m = ensure_count("n", n), ensure_dimension(m)
    law_length, end = _tried_laws()[name].length, _tried_laws()[name].span
    side, speed = round(_SPREAD * law_length * n ** (1 / m), 3), round(_SPEED * law_length, 3)
    law, text = _law(name, m, side)
    rng = np.random.default_rng(seed)
    q0 = side * rng.uniform(-0.5, 0.5, (n, m))
    p0 = speed * rng.normal(size=(n, m))
    lines = (
        f"law = {text}",
        f"rng = np.random.default_rng({seed})",
        f"q0 = {side} * rng.uniform(-0.5, 0.5, ({n}, {m}))",
        f"p0 = {speed} * rng.normal(size=({n}, {m}))",
        f"t_span, options = (0.0, {end}), {{}}",
    )
    start = f"{name}, {n} agents at random", law, q0, p0, (0.0, end), lines
    return Start(*start, theorems=theorems_of(name))


@lru_cache(maxsize=8)
def from_scenario(name: str, *, seed: int = 0) -> Start:
    """Return the start of a scenario of the catalogue, for the explorer's page."""
    item = scenario(name, seed)
    lines = (
        f"item = fl.scenario({name!r}, seed={item.seed})",
        "law, q0, p0, t_span, options = item.law, item.q0.copy(), item.p0.copy(), item.t_span, dict(item.options)",
    )
    span = (float(item.t_span[0]), float(item.t_span[1]))
    start = (item.title, item.law, item.q0, item.p0, span, lines, item.options, item.theorems)
    return Start(*start, source=item if item.reports else None)


@lru_cache(maxsize=1)
def from_file(path: str) -> Start:
    """Return the start of a saved run (.nc) or of a counterexample (.json), for the explorer's page."""
    if Path(path).suffix == ".json":
        case = Counterexample.load(path)
        lines: tuple[str, ...] = (
            "from flockana.falsify.counterexample import Counterexample",
            f"found = Counterexample.load({str(path)!r})",
            "law, q0, p0 = found.law, found.q0.copy(), found.p0.copy()",
            "t_span, options = found.t_span, dict(found.options)",
        )
        title = f"A counterexample to {case.theorem}, {case.claim}; from {case.scenario}"
        start = (title, case.law, case.q0, case.p0, case.t_span, lines, case.options, (case.theorem,))
        return Start(*start, case.tolerances, "found.tolerances")
    run = Trajectory.load(path)
    is_discrete = run.stats.get("method") == "discrete"
    options = {key: run.stats[key] for key in _OPTIONS if not is_discrete and run.stats.get(key) is not None}
    span = (float(run.t[0]), float(run.t[-1]))
    lines = (
        f"saved = fl.Trajectory.load({str(path)!r})",
        f"law, q0, p0, t_span, options = saved.law, saved.q[0].copy(), saved.p[0].copy(), {span}, {options}",
    )
    title = f"{Path(path).name}: {run.n} agents, {run.law.title}"
    checked_theorems = theorems_of(run.law.title)
    return Start(title, run.law, run.q[0], run.p[0], span, lines, options, checked_theorems, recorded=run)


@cache
def theorems_of(law: str) -> tuple[str, ...]:
    """Return the ids of theorems that the catalogue checks on this kind of law, errata excluded."""
    items = (scenario(name) for name in scenarios())
    names = (name for item in items if type(item.law).__name__ == law for name in item.theorems)
    return tuple(dict.fromkeys(name for name in names if name.islower()))
