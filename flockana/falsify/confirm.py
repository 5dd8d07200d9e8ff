"""No counterexample that a finer run takes back: what refutes a claim is integrated a thousand times more tightly."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any

from flockana.checks import FloatArray
from flockana.laws.law import DiscreteLaw, Law
from flockana.simulate import simulate
from flockana.theorems import Verdict
from flockana.trajectory import Trajectory

THOUSANDTH = 1e-3  # of a run's tolerances
FINEST = 3e-14  # relative tolerance below which the solvers cannot go
_DEFAULT = 1e-8  # the relative tolerance of `simulate`; for want of its own, that of a fixed step too


def confirmed(
    verdict: Verdict,
    judge: Callable[[Trajectory], Verdict],
    *,
    law: Law | DiscreteLaw,
    q0: FloatArray,
    p0: FloatArray,
    t_span: tuple[float, float],
    options: Mapping[str, Any],
) -> Verdict:
    """A verdict whose refuted claims a run at a thousandth of the tolerance refutes too; the others are inconclusive.

    A map has no tolerance: its verdict stays as it is.

    Parameters
    ----------
    verdict : Verdict
        On a run of this start.
    judge : callable
        From a run to its verdict.
    law : Law or DiscreteLaw
        What moves the flock.
    q0, p0 : ndarray, shape (n, m)
        The start.
    t_span : (float, float)
        Start and end.
    options : mapping
        Keyword arguments of `simulate`.

    Raises
    ------
    KeyboardInterrupt
        If it was interrupted.
    """
    if isinstance(law, DiscreteLaw) or all(claim.status != "refuted" for claim in verdict.claims):
        return verdict
    run = simulate(law, q0, p0, t_span, **tighter(options))
    if run.status == "interrupted":
        raise KeyboardInterrupt
    found = {claim.name: claim.status for claim in judge(run).claims} if run.status == "complete" else {}
    reason = "a run at a thousandth of the tolerance takes this back"
    claims = (
        replace(claim, status="inconclusive", detail=f"{claim.detail}; {reason}".lstrip("; "))
        if claim.status == "refuted" and found.get(claim.name) != "refuted"
        else claim
        for claim in verdict.claims
    )
    return replace(verdict, claims=tuple(claims))


def tighter(options: Mapping[str, Any]) -> dict[str, Any]:
    """Options of `simulate` with a thousandth of the tolerance; a fixed step gives way to an adaptive method.

    Parameters
    ----------
    options : mapping
        Keyword arguments of `simulate`.

    Examples
    --------
    >>> tighter({"method": "RK4", "dt": 0.1, "t_eval": [1.0]}) == {"t_eval": [1.0], "rtol": 1e-11}
    True
    """
    found = {key: value for key, value in options.items() if key not in ("dt", "rtol", "atol")}
    if found.get("method") == "RK4":
        del found["method"]
    found["rtol"] = max(THOUSANDTH * options.get("rtol", _DEFAULT), FINEST)
    if options.get("atol") is not None:
        found["atol"] = THOUSANDTH * options["atol"]
    return found
