"""The catalogue of theorems, one per file, and `verify`, which checks one on a run, a configuration, or by itself."""

from __future__ import annotations

import re
from collections.abc import Iterator
from functools import cache
from importlib import import_module
from types import ModuleType
from typing import TYPE_CHECKING, Any, TypedDict, Unpack, overload

import numpy as np

from flockana.base.checks import ensure_points, ensure_positive
from flockana.base.errors import ArgumentError, UnknownNameError, format_value
from flockana.base.modules import modules, source_modules
from flockana.base.seals import ensure_sealed
from flockana.dynamics.predicates import ensure_uninterrupted
from flockana.dynamics.simulate import simulate
from flockana.dynamics.trajectory import Trajectory
from flockana.laws.wrapped import wrappers_of
from flockana.theorems.fits import ensure_fits
from flockana.theorems.observed import Observed, with_resolution
from flockana.theorems.of_schemes import is_about_steps, on_steps
from flockana.theorems.theorem import Hypothesis, Theorem, Tolerances, Verdict

if TYPE_CHECKING:
    from flockana.theorems.together import Verdicts

T_SPAN = (0.0, 20.0)  # of a law that is run without one
_RUN = "a run as simulate returned it, or its window, its rescaled copy or its file"
_KINDS = {"recording": ("flockana.recorded.recording", "Recording"), "tube": ("flockana.certified.tube", "Tube")}
_REMEDY = "simulate(law, q0, p0, t_span) makes one; samples from elsewhere are judged as Recording(t, q, p, bound=...)"


@cache
def catalogue() -> dict[str, Theorem]:
    """Return all theorems by id, from every module of this package and of the sources' theorems."""
    by_id = {item.id: item for module in theorem_modules() for item in theorems_in(module).values()}
    return dict(sorted(by_id.items(), key=lambda pair: _natural(pair[0])))


def theorem_modules() -> Iterator[ModuleType]:
    """Import all modules that may define theorems."""
    yield from modules("flockana.theorems")
    yield from source_modules("theorems")


def theorems_in(module: ModuleType) -> dict[str, Theorem]:
    """Return the theorems that a module defines, by their names in it."""
    return {name: item for name, item in vars(module).items() if isinstance(item, Theorem)}


def _natural(name: str) -> tuple[Any, ...]:
    """Sort key of an id: E2 before E10, and the errata after the theorems."""
    return (name[:1].isupper(), *(int(part) if part.isdigit() else part for part in re.split(r"(\d+)", name)))


def theorems() -> tuple[str, ...]:
    """Ids of every theorem, correction and erratum that can be checked.

    Examples
    --------
    >>> "os-1" in theorems() and "E1" in theorems()
    True
    """
    return tuple(catalogue())


def theorem(name: str | Theorem) -> Theorem:
    """Return a theorem by its id or printed name: its statement, its source, the cases it is checked on.

    Parameters
    ----------
    name : str
        One of `theorems`, or the name that its source prints, such as "Theorem 3"; a theorem is returned as it is.

    Raises
    ------
    UnknownNameError
        If there is none; the closest name is suggested.
    ArgumentError
        If several sources print a theorem of that name.

    Examples
    --------
    >>> theorem("os-3").kind, theorem("Theorem 3").id
    ('trajectory', 'os-3')
    """
    if isinstance(name, Theorem):
        return name
    if not isinstance(name, str):
        raise UnknownNameError("theorem", name, theorems())
    return catalogue().get(name) or _printed_as(name)


def _printed_as(name: str) -> Theorem:
    """Return the theorem that its source prints under a name such as "Theorem 3"."""
    wanted = re.compile(rf"\b{re.escape(name.strip())}$", re.IGNORECASE)
    found = [x for x in catalogue().values() if x.id[0].islower() and wanted.search(re.split(r";| \(", x.source)[0])]
    if len(found) == 1:
        return found[0]
    if found:
        listed = "; ".join(f"{x.id} ({x.source})" for x in found)
        raise ArgumentError(f"several theorems are printed as {name!r}: expected one of {listed}")
    raise UnknownNameError("theorem", name, theorems())


class _Case(TypedDict, total=False):
    """Keyword arguments of `verify`."""

    basin: Any
    law: Any
    q0: Any
    p0: Any
    t_span: Any
    q: Any
    d: float | None
    r: float | None
    tolerances: Tolerances | None
    subject: str


@overload
def verify(name: None = None, trajectory: Any = None, **case: Unpack[_Case]) -> Verdicts: ...
@overload
def verify(name: str | Theorem, trajectory: Any = None, **case: Unpack[_Case]) -> Verdict: ...
def verify(
    name: str | Theorem | None = None,
    trajectory: Any = None,
    *,
    basin: Any = None,
    law: Any = None,
    q0: Any = None,
    p0: Any = None,
    t_span: Any = None,
    q: Any = None,
    d: float | None = None,
    r: float | None = None,
    tolerances: Tolerances | None = None,
    subject: str = "",
) -> Verdict | Verdicts:
    """Check a theorem: on a run, on a law that is run first, on a configuration, or (errata) by itself.

    Without a theorem, check all that are about the law of the run.

    Parameters
    ----------
    name : str or Theorem, optional
        One of `theorems`, or a theorem of your own; by default all that are about the law.
    trajectory : Trajectory, Tube or Recording, optional
        The run, for theorems about motion. Of a recording with `law` the first hypothesis is that its samples follow
        the law, within their stated accuracy; definitions about samples take d and r instead of a law. Of a tube
        (`flockana.enclose`) the claims are decided rigorously, for every start that it encloses, and their rigour reads
        ``"interval"``; they are those of the law whose parameters are the decimals that they print as.
    basin : Basin, optional
        With a tube: a certified basin (`flockana.certify`) that it may end in, which decides claims about limits.
    law, q0, p0, t_span : optional
        Instead of a trajectory: `simulate` is called with them and its defaults.
    q : array_like, shape (n, m), optional
        The configuration, for theorems about configurations, with d and r.
    d, r : float, optional
        Its scale and interaction range.
    tolerances : Tolerances, optional
        Thresholds; shown with the verdict.
    subject : str
        A name for the case, kept in the verdict.

    Returns
    -------
    Verdict, or Verdicts without a theorem

    A claim about a run carries the error of its integration: the same start is integrated once more, a hundred times
    more tightly, and both must agree (`flockana.theorems.observed`). A failed run verifies nothing.

    Raises
    ------
    ArgumentError
        If what the theorem needs is not given, or something else is; if a run, tube or basin was made or changed by
        hand, or a run's samples are not those of its law.

    Examples
    --------
    >>> verify("E8").claim("printed").computed
    0.6666666666666666
    """
    used = Tolerances() if tolerances is None else tolerances
    if not isinstance(used, Tolerances):
        raise ArgumentError(f"tolerances = {tolerances!r}: expected flockana.Tolerances(...)")
    if _is("recording", trajectory):
        if any(each is not None for each in (basin, q0, p0, t_span, q)):
            raise ArgumentError("a recording: expected verify(theorem, recording, law=...), or d= and r= without a law")
        from flockana.theorems.on_recordings import verify_recording, verify_recording_together

        case = {"law": law, "d": d, "r": r, "subject": subject}
        if name is None:
            return verify_recording_together(trajectory, used, **case)
        return verify_recording(theorem(name), trajectory, used, **case)
    if name is None:
        from flockana.theorems.together import verify_together  # which checks each theorem by this function

        return verify_together(_run(trajectory, law, q0, p0, t_span), tolerances=used, subject=subject)
    item = theorem(name)
    _ensure_given(item, trajectory=trajectory, law=law, q0=q0, p0=p0, t_span=t_span, q=q, d=d, r=r)
    if _is("tube", trajectory):
        return _verified_tube(item, trajectory, basin, used, subject)
    if basin is not None:
        raise ArgumentError("a basin decides the limit of a tube: expected verify(theorem, enclose(...), basin=...)")
    if item.kind == "trajectory":
        return _verified_run(item, _run(trajectory, law, q0, p0, t_span), used, subject)
    subject_data: tuple[Any, ...] = ()
    if item.kind == "configuration":
        subject_data = (ensure_points("q", q), ensure_positive("d", d), ensure_positive("r", r))
    return item.verdict(item.examine(*subject_data, used), used, subject)


def _ensure_given(item: Theorem, **case: Any) -> None:
    """Raise unless exactly what a theorem is checked on is given."""
    given = {name for name, value in case.items() if value is not None}
    motion = {"law", "q0", "p0", "t_span"}
    start = given & motion if {"law", "q0"} <= given else motion
    needed = {"trajectory": ({"trajectory"}, start), "configuration": ({"q", "d", "r"},), "fixed": (set(),)}[item.kind]
    if given not in needed:
        options = " or ".join(", ".join(sorted(option)) or "nothing" for option in needed)
        raise ArgumentError(f"{item.id} is checked on {options}: got {', '.join(sorted(given)) or 'nothing'}")


def _run(trajectory: Any, law: Any, q0: Any, p0: Any, t_span: Any) -> Trajectory:
    """Return the run, or one from a start; without p0 at rest, without t_span over 20 time units."""
    if trajectory is None:
        if law is None or q0 is None:
            raise ArgumentError("got no run and no law with positions: expected a Trajectory, or law=..., q0=...")
        if callable(q0) or callable(p0):
            raise ArgumentError("the start is a function of a seed: expected Flock(law, q0, p0, t_span).verify(seed)")
        p = np.zeros(np.shape(q0)) if p0 is None else p0
        return ensure_uninterrupted(simulate(law, q0, p, T_SPAN if t_span is None else t_span))
    if not isinstance(trajectory, Trajectory):
        if hasattr(trajectory, "drawn"):  # a flock, of a layer above
            raise ArgumentError("trajectory is a Flock: expected flock.run(seed), or flock.verify(seed)")
        given = format_value(trajectory)
        raise ArgumentError(f"trajectory = {given}: expected a Trajectory, such as scenario('collapse').run()")
    return trajectory


def _is(kind: str, run: Any) -> bool:
    """Return whether a value is a recording or a tube, without importing what it is an instance of unless needed."""
    if run is None or isinstance(run, Trajectory):
        return False
    module, name = _KINDS[kind]
    return isinstance(run, getattr(import_module(module), name))


def _of_another_law(item: Theorem, run: Trajectory, tolerances: Tolerances, subject: str) -> Verdict:
    """Return the vacuous verdict on a run of a wrapped law, which a theorem about the bare law does not cover."""
    around = ", ".join(type(one).__name__ for one in wrappers_of(run.law))
    detail = f"the law of the run is wrapped in {around}; the theorem is about the law alone"
    missed = Hypothesis("the law acts undisturbed, at once and without a limit", "unmet", detail=detail)
    return item.verdict(((missed,), item.vacuous_claims(missed)), tolerances, subject)


def _verified_tube(item: Theorem, tube: Any, basin: Any, tolerances: Tolerances, subject: str) -> Verdict:
    if item.enclosed is None:
        able = ", ".join(name for name, one in catalogue().items() if one.enclosed is not None)
        raise ArgumentError(f"{item.id} is not decided from a tube: expected a Trajectory, or one of {able}")
    tube.ensure_unedited()
    if basin is not None:
        from flockana.certified.basin import Basin

        if not isinstance(basin, Basin):
            raise ArgumentError(f"basin = {format_value(basin)}: expected a basin, as certify(...) returns it, or None")
        basin.ensure_unedited()
    return item.verdict(item.examine(tube, basin, tolerances, check=item.enclosed), tolerances, subject)


def _verified_run(item: Theorem, run: Trajectory, tolerances: Tolerances, subject: str) -> Verdict:
    ensure_sealed("trajectory", run, _RUN, _REMEDY)
    if wrappers_of(run.law) and not (item.wrapped and run.law is run.law.continuous):
        return _of_another_law(item, run, tolerances, subject)
    ensure_fits(run)
    seen = Observed.of(run)
    examined = on_steps if is_about_steps(item, seen) else Theorem.examine
    return item.verdict(with_resolution(*examined(item, seen, tolerances), seen), tolerances, subject)
