"""Law and start positions of a command: from a scenario, a file, or a builder with given scale and range."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import typer

from flockana.base.errors import ArgumentError, SolverError

if TYPE_CHECKING:
    from flockana.base.value_checks import FloatArray


_SEARCH, _MODES = 3.5, 2.0  # seconds for 1000 agents: an equilibrium with its modes, or the slowest modes alone
_SEARCHED, _GIVEN = 30_000, 150_000  # agents: beyond, minutes and more memory than many machines have
_SHORT = 10.0  # seconds that need no word


def read_motion(
    source: str,
    *,
    start: str | None = None,
    seed: int | None = None,
    algorithm: int | None = None,
    d: float | None = None,
    r: float | None = None,
    time: float | None = None,
    at: str | None = None,
    potential: bool = False,
) -> tuple[Any, FloatArray, FloatArray | None]:
    """Return a law with positions and velocities from a scenario, file or name; the γ-agent is held in place.

    `potential` asks for a law that has one; `at` has the positions of a law in a Python file. Without a run the
    velocities are None.
    """
    from flockana.cli.command_subject import is_own, read_law
    from flockana.cli.positions_source import ensure_source, read_source
    from flockana.environment import StaticTarget
    from flockana.interactions import AlphaInteraction
    from flockana.laws import Algorithm1, Algorithm2
    from flockana.scenarios import scenarios

    if at is not None:
        if not is_own(source):
            raise ArgumentError(f"--at {at}: {source} has positions of its own; expected a law in FILE.py, or no --at")
        _refuse(source, "is a law", start=start, seed=seed, time=time, algorithm=algorithm, r=r)
        law, q = read_law(source), read_source(at, d=d).q
        return _with_fixed_target(_ensured(law, q.shape[1], potential), 0.0), q, None
    if source in scenarios() or is_own(source):
        _refuse(source, "has a law of its own", time=time, algorithm=algorithm, d=d, r=r)
        return _of_scenario(source, start or "end", seed or 0, potential)
    ensure_source(source, scenarios())
    _refuse(source, "is no scenario", seed=seed, start=start)
    motion = read_source(source, d=d, r=r, time=time)
    if motion.law is not None:
        _refuse(source, "has a law of its own", algorithm=algorithm, d=d, r=r)
        return _with_fixed_target(_ensured(motion.law, motion.q.shape[1], potential), motion.t), motion.q, motion.p
    alpha = AlphaInteraction(d=motion.d, r=motion.r)
    if algorithm == 2:
        return Algorithm2(alpha, target=StaticTarget(motion.q.mean(axis=0))), motion.q, None
    return Algorithm1(alpha), motion.q, None


def announce_time(n: int, *, as_given: bool | None = None) -> None:
    """Print the expected time of work on a large flock to stderr; raise if it is too long.

    `as_given` tells whether only the modes at given positions are sought; None where there is no such choice.
    """
    search_limit, unit_seconds = (_GIVEN, _MODES) if as_given else (_SEARCHED, _SEARCH)
    if n > search_limit:
        choice = f", or {_GIVEN} with --as-given (slowest modes at these positions)" if as_given is False else ""
        raise ArgumentError(f"n = {n}: expected at most {search_limit} agents{choice}")
    seconds = unit_seconds * n / 1000.0
    if seconds >= _SHORT:
        typer.echo(f"n = {n}: about {seconds:.0f} s on a machine of 2024", err=True)


def _refuse(name: str, reason: str, **given: object) -> None:
    """Raise on an option that does not suit the given source of positions."""
    for option, value in given.items():
        if value is not None:
            raise ArgumentError(f"--{option} {value}: {name} {reason}, and has no such choice; leave it out")


def _of_scenario(name: str, start: str, seed: int, potential: bool) -> tuple[Any, FloatArray, FloatArray]:
    from flockana.cli.command_subject import is_own, read_flock
    from flockana.cli.positions_source import integrated_law
    from flockana.equilibria.classify import ensure_small

    item = read_flock(name, seed)
    law = item.law if is_own(name) and not potential else integrated_law(item.law)
    law = _ensured(law, item.q0.shape[1], potential)
    ensure_small(*item.q0.shape)
    if start == "start":
        return _with_fixed_target(law, item.t_span[0]), item.q0, item.p0
    run = item.run()
    if run.status == "interrupted":
        raise KeyboardInterrupt
    if run.status != "complete":
        raise SolverError(f"the run of {name} {run.status}: {run.message}; use --start start")
    return _with_fixed_target(law, float(run.t[-1])), run.q[-1], run.p[-1]


def _ensured(law: Any, m: int, potential: bool) -> Any:
    """Return the law; raise if the command needs a potential and the law has none."""
    from flockana.equilibria.potential import ensure_flock_law

    return ensure_flock_law(law, m) if potential or (law.terms and law.conservative) else law


def _with_fixed_target(law: Any, t: float) -> Any:
    """Return the law with its γ-agent fixed at its position at time t."""
    from flockana.environment import StaticTarget

    target, inner_law = law.target, getattr(law, "law", None)
    if target is not None and inner_law is not None:
        return replace(law, law=_with_fixed_target(inner_law, t))
    return law if target is None else replace(law, target=StaticTarget(tuple(target.position(t).tolist())))
