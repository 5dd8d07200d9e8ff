"""Checking of theorems on a run, a recording, a tube, a configuration, or alone: `verify`."""

from collections.abc import Sequence
from importlib import import_module
from typing import Any, TypedDict, Unpack, overload

from flockana.base.errors import ArgumentError, format_value
from flockana.base.value_checks import TimeSpan, ensure_time_span
from flockana.dynamics.predicates import ensure_uninterrupted
from flockana.dynamics.simulate import simulate
from flockana.dynamics.trajectory import Trajectory
from flockana.laws.first_order_law import start_velocities
from flockana.theorems.catalogue import theorem
from flockana.theorems.evidence import Evidence, NoCase, NotEvidence, State
from flockana.theorems.run_verdicts import RunEvidence
from flockana.theorems.theorem import Theorem, Tolerances, Verdict
from flockana.theorems.verdicts import Verdicts

T_SPAN = (0.0, 20.0)  # of a law that is run without one
_KINDS = {"recording": ("flockana.recorded.recording", "Recording"), "tube": ("flockana.certified.tube", "Tube")}


class _Case(TypedDict, total=False):
    """Keyword arguments of `verify`."""

    basin: Any
    law: Any
    q0: Any
    p0: Any
    t_span: TimeSpan | None
    q: Any
    d: float | None
    r: float | None
    tolerances: Tolerances | None
    subject: str


@overload
def verify(  # type: ignore[overload-overlap]  # a text is a sequence of texts, too
    name: str | Theorem, trajectory: Any = None, **case: Unpack[_Case]
) -> Verdict: ...
@overload
def verify(name: Sequence[str | Theorem] | None = None, trajectory: Any = None, **case: Unpack[_Case]) -> Verdicts: ...
def verify(
    name: str | Theorem | Sequence[str | Theorem] | None = None,
    trajectory: Any = None,
    *,
    basin: Any = None,
    law: Any = None,
    q0: Any = None,
    p0: Any = None,
    t_span: TimeSpan | None = None,
    q: Any = None,
    d: float | None = None,
    r: float | None = None,
    tolerances: Tolerances | None = None,
    subject: str = "",
) -> Verdict | Verdicts:
    """Check a theorem: on a run, on a law that is run first, on a configuration, or (errata) alone.

    Without a theorem, check all that are about the law of the run.

    Parameters
    ----------
    name : str or Theorem, or several in a list, optional
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
    Verdict, or Verdicts of several theorems or without one

    A claim about a run carries the error of its integration: the same start is integrated once more, a hundred times
    more tightly, and both must agree (`flockana.theorems.observed_run`). A failed run verifies nothing.

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
    tol = ensure_tolerances(tolerances)
    if isinstance(name, Sequence) and not isinstance(name, str):
        items = [theorem(entry) for entry in name]
        if trajectory is None and law is not None:
            trajectory, law, q0, p0, t_span = _run(None, law, q0, p0, t_span), None, None, None, None
        parts: Any = {"basin": basin, "law": law, "q0": q0, "p0": p0, "t_span": t_span, "q": q, "d": d, "r": r}
        return Verdicts(verify(entry, trajectory, tolerances=tol, subject=subject, **parts) for entry in items)
    case = {"trajectory": trajectory, "law": law, "q0": q0, "p0": p0, "t_span": t_span, "q": q, "d": d, "r": r}
    item = None if name is None else theorem(name)
    evidence = _choose_evidence(item, case, basin)
    return evidence.judge_all(tol, subject) if item is None else evidence.judge(item, tol, subject)


def ensure_tolerances(tolerances: Any) -> Tolerances:
    """Return tolerances, the defaults for None; raise on anything else."""
    tolerances_used = Tolerances() if tolerances is None else tolerances
    if not isinstance(tolerances_used, Tolerances):
        raise ArgumentError(f"tolerances = {tolerances!r}: expected flockana.Tolerances(...)")
    return tolerances_used


def _choose_evidence(item: Theorem | None, case: dict[str, Any], basin: Any) -> Evidence:
    """Return the evidence of a run, a recording, a tube, a state, or none; raise on unsuitable arguments."""
    if _is("recording", case["trajectory"]):
        from flockana.theorems.recording_verdicts import RecordingEvidence  # which loads what fits and smooths

        if any(entry is not None for entry in (basin, *(case[name] for name in ("q0", "p0", "t_span", "q")))):
            raise ArgumentError("a recording: expected verify(theorem, recording, law=...), or d= and r= without a law")
        return RecordingEvidence(case["trajectory"], case["law"], case["d"], case["r"])
    motion = [case[name] for name in ("trajectory", "law", "q0", "p0", "t_span")]
    if item is None:
        return RunEvidence(_run(*motion))
    _ensure_given(item, **case)
    if _is("tube", case["trajectory"]):
        from flockana.theorems.tube_verdicts import TubeEvidence  # which loads ball arithmetic

        return TubeEvidence(case["trajectory"], basin)
    if basin is not None:
        raise ArgumentError("a basin decides the limit of a tube: expected verify(theorem, enclose(...), basin=...)")
    if item.kind == "trajectory":
        return RunEvidence(_run(*motion))
    return State(case["q"], case["d"], case["r"]) if item.kind == "configuration" else NoCase()


def _ensure_given(item: Theorem, **case: Any) -> None:
    """Raise unless exactly the theorem's required arguments are given."""
    names = {name for name, value in case.items() if value is not None}
    motion = {"law", "q0", "p0", "t_span"}
    start = names & motion if {"law", "q0"} <= names else motion
    demand = {"trajectory": ({"trajectory"}, start), "configuration": ({"q", "d", "r"},), "fixed": (set(),)}[item.kind]
    if names not in demand:
        options = " or ".join(", ".join(sorted(option)) or "nothing" for option in demand)
        raise ArgumentError(f"{item.id} is checked on {options}: got {', '.join(sorted(names)) or 'nothing'}")


def _run(trajectory: Any, law: Any, q0: Any, p0: Any, t_span: Any) -> Trajectory:
    """Return the given run, or simulate one from a start (by default at rest, over 20 time units)."""
    if trajectory is None:
        if law is None or q0 is None:
            raise ArgumentError("got no run and no law with positions: expected a Trajectory, or law=..., q0=...")
        if callable(q0) or callable(p0):
            raise ArgumentError("the start is a function of a seed: expected Flock(law, q0, p0, t_span).verify(seed)")
        span = T_SPAN if t_span is None else ensure_time_span(t_span)
        return ensure_uninterrupted(simulate(law, q0, start_velocities(law, span[0], q0, p0), span))
    if not isinstance(trajectory, Trajectory):
        if isinstance(trajectory, NotEvidence):
            raise ArgumentError(trajectory.advice)
        text = format_value(trajectory)
        raise ArgumentError(f"trajectory = {text}: expected a Trajectory, such as scenario('collapse').run()")
    return trajectory


def _is(kind: str, run: Any) -> bool:
    """Return whether a value is of a given kind, recording or tube, importing its class only if needed."""
    if run is None or isinstance(run, Trajectory):
        return False
    module, name = _KINDS[kind]
    return isinstance(run, getattr(import_module(module), name))
