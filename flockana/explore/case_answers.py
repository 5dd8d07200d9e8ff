"""Results computed for a case of the explorer's page, sent in order of computation."""

from collections.abc import Callable, Iterator
from functools import cache, partial
from typing import Any

import numpy as np

from flockana.base.errors import FlockanaError
from flockana.dynamics.trajectory import Trajectory
from flockana.equilibria import find_equilibrium
from flockana.equilibria.lattice_collapse import collapse_threshold
from flockana.equilibria.rest_without_potential import resting_state
from flockana.explore.law_parameters import numbers
from flockana.explore.page_case import Case, program
from flockana.explore.page_starts import Start
from flockana.explore.streamed_runs import ensure_small, shown, watched
from flockana.interactions import AlphaInteraction
from flockana.player.marked_instants import marks_of
from flockana.scenarios.option_checks import SOURCE
from flockana.stability import linearise
from flockana.theorems import theorem, verify
from flockana.theorems.claim import BYLINES

Send = Callable[[str, Any], None]  # a kind, and plain data or bytes

_LONG = ("linearised-decay-terminal", "alpha-flocking-strict")
_MODES = 12  # that a page lists
_POLES = 900  # n m above which the whole spectrum takes too long for a page
_RESTING = 0.02  # residual, of the force scale, up to which the end of a run is near an equilibrium
_SOUGHT = 400  # steps of the search for it
_SQUEEZED = 400  # agents up to which the collapse threshold is sought, in the plane


def answer(asked: Any, send: Send, *, limit: float, cancelled: Callable[[], bool]) -> None:
    """Simulate a case of the explorer's page and send its results; stop at the first error, which is sent."""
    try:
        case = asked if isinstance(asked, Case) else Case.of(asked)
        parts = case.parts
        send("form", form(case, parts))
        ensure_small(parts)
        show, saved = partial(send, "run"), parts.recorded
        run = shown(saved, show) if saved is not None else watched(parts, show, limit=limit, cancelled=cancelled)
        send("ran", {"status": run.status, "message": run.message, "samples": len(run.t)})
        for kind, content in _analysed(parts, run):
            if cancelled():
                raise KeyboardInterrupt
            send(kind, content)
    except FlockanaError as error:
        send("error", {"text": str(error)})
    send("done", {})


def form(case: Case, parts: Start) -> dict[str, Any]:
    """Return the data of the page's form: the law's parameters, the start, and equivalent Python code."""
    default_values = {number.path: number.value for number in numbers(case.start().law)}
    number_rows = [
        {"path": item.path, "value": item.value, "usual": default_values.get(item.path), "place": item.place}
        for item in numbers(parts.law)
        if not item.path.endswith(_idle(parts.law))
    ]
    reports = [] if parts.source is None else [{"id": SOURCE, "title": "What the source reports of this run"}]
    return {
        "title": parts.title,
        "law": type(parts.law).__name__,
        "n": len(parts.q0),
        "m": parts.q0.shape[1],
        "q0": parts.q0.tolist(),
        "duration": parts.t_span[1] - parts.t_span[0],
        "numbers": number_rows,
        "theorems": [{"id": name, "title": theorem(name).title} for name in parts.theorems] + reports,
        "ratio": _collapses_by_ratio(parts.law),
        "python": program(parts),
    }


def _idle(law: Any) -> tuple[str, ...]:
    """Return the names of a law's gains that have no effect, as it has no γ-agent or no obstacles."""
    idle_gains = () if law.target is not None else ("c1_gamma", "c2_gamma")
    return idle_gains if law.obstacles else (*idle_gains, "c1_beta", "c2_beta")


def _analysed(parts: Start, run: Trajectory) -> Iterator[tuple[str, Any]]:
    for name in sorted(parts.theorems, key=lambda name: name in _LONG):  # what takes seconds comes last
        try:
            answer = verify(name, run, tolerances=parts.tolerances)
            verdict = answer.to_dict() | {"marks": marks_of(run, [answer]), "bylines": dict(BYLINES)}
        except FlockanaError as error:  # such as an erratum about another number of agents
            verdict = {"theorem": name, "status": "not checked", "error": str(error), "hypotheses": [], "claims": []}
        yield "verdict", {**verdict, "statement": theorem(name).statement}
    if parts.source is not None:
        for answer in parts.source.reported(run):
            statement = " ".join(f"{report.name}: {report.text.rstrip('.')}." for report in parts.source.reports)
            yield "verdict", answer.to_dict() | {"marks": marks_of(run, [answer]), "statement": statement}
    yield "poles", poles(run)
    if _collapses_by_ratio(parts.law):
        yield "threshold", _threshold(parts.law.pair, *parts.q0.shape)


def poles(run: Trajectory) -> dict[str, Any]:
    """Return poles and slowest modes at the end of a run, about the nearby equilibrium or the frozen final state."""
    law, q = run.law.continuous, run.q[-1]
    if law is None:
        return {"note": f"{run.law.title} is a map of its own: it has no poles in continuous time"}
    if q.size > _POLES:
        text = f"{q.size} coordinates: this page computes the poles of at most {_POLES}; use flockana stability"
        return {"note": text}
    t = float(run.t[-1])
    try:
        linear = linearise(law, q, t=t, allow_residual=True)
        note = f"Linearised at the end of the run as if at rest; it is no equilibrium (residual {linear.residual:.2g})"
        if linear.residual <= _RESTING and not law.obstacles:
            equilibrium = (
                find_equilibrium(law, q, t=t, max_iter=_SOUGHT)
                if law.terms and law.conservative
                else resting_state(law, q, t=t)
            )
            linear = linearise(law, equilibrium, t=t)
            note = "At the equilibrium nearest to the end of the run"
        modes, eigenvalues = linear.modes[:_MODES], linear.eigenvalues
    except FlockanaError as error:
        return {"note": f"No poles: {error}"}
    mode_names = [mode.name for mode in linear.zero_modes if not mode.name.startswith("soft")]
    soft_count = len(linear.zero_modes) - len(mode_names)
    return {
        "note": note,
        "poles": np.column_stack([eigenvalues.real, eigenvalues.imag]).tolist(),
        "zero": [*mode_names, f"{soft_count} soft ones"] if soft_count else mode_names,
        "abscissa": linear.spectral_abscissa if modes else None,
        "q": linear.q.tolist(),
        "links": np.asarray(linear.links).tolist(),
        "modes": [_shown_mode(mode) for mode in modes],
    }


def _shown_mode(mode: Any) -> dict[str, Any]:
    shape = {name: np.round(part(mode.shape), 6).tolist() for name, part in (("real", np.real), ("imag", np.imag))}
    value = [mode.eigenvalue.real, mode.eigenvalue.imag]
    return {"name": mode.name, "value": value, "damping": mode.damping_ratio, **shape}


def _collapses_by_ratio(law: Any) -> bool:
    """Return whether one linear pull acts on all agents, so that c1γ/c1α decides collapse (erratum E11)."""
    gains, decouples = getattr(law, "gains", None), getattr(law, "centre_decouples", False)
    is_following = law.target is not None and decouples and isinstance(law.pair, AlphaInteraction)
    return bool(is_following and gains is not None and not gains.per_agent and gains.c1_alpha > 0.0)


@cache
def _threshold(alpha: AlphaInteraction, n: int, m: int) -> dict[str, Any]:
    if n > _SQUEEZED or m != 2:
        return {"note": f"threshold of collapse: computed in the plane, for at most {_SQUEEZED} agents"}
    try:
        low, high = collapse_threshold(alpha, n, halvings=2)
    except FlockanaError as error:
        return {"note": str(error)}
    return {"low": low, "high": high}
