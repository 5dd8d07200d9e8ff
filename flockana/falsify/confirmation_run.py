"""Confirmation of counterexamples by a second run with a thousandth of the tolerance."""

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any

from flockana.base.units import times
from flockana.dynamics.error_tolerances import FINEST
from flockana.dynamics.predicates import ensure_uninterrupted
from flockana.dynamics.simulate import simulate
from flockana.dynamics.trajectory import Trajectory
from flockana.theorems import Verdict

THOUSANDTH = 1e-3  # of a run's tolerances
_DEFAULT = 1e-8  # the relative tolerance of `simulate`; for want of its own, that of a fixed step too


def confirmed(verdict: Verdict, judge: Callable[[Trajectory], Verdict], case: Any) -> Verdict:
    """Return the verdict, with refuted claims inconclusive unless a much finer run refutes them too."""
    # The case, a scenario or a counterexample, has a law, a start and options of `simulate`.
    # A map has no tolerance: its verdict stays as it is.
    if case.law.is_map or all(claim.status != "refuted" for claim in verdict.claims):
        return verdict
    options = tightened_options(case.options)
    run = ensure_uninterrupted(simulate(case.law, case.q0, case.p0, case.t_span, **options))
    replay_claims = judge(run).claims if run.status == "complete" else ()
    sure_names = {claim.name for claim in replay_claims if claim.status == "refuted"}
    reason = "a run at a thousandth of the tolerance takes this back"
    claims = list(verdict.claims)
    for k, claim in enumerate(claims):
        if claim.status == "refuted" and claim.name not in sure_names:
            detail = f"{claim.detail}; {reason}".lstrip("; ")
            claims[k] = replace(claim, status="inconclusive", detail=detail)
    return replace(verdict, claims=tuple(claims))


def tightened_options(options: Mapping[str, Any]) -> dict[str, Any]:
    """Return options of `simulate` with a thousandth of the tolerance, by an adaptive method."""
    finer_options = {key: value for key, value in options.items() if key not in ("dt", "rtol", "atol")}
    if finer_options.get("method") == "RK4":
        del finer_options["method"]
    finer_options["rtol"] = max(THOUSANDTH * options.get("rtol", _DEFAULT), FINEST)
    if options.get("atol") is not None:
        finer_options["atol"] = times(options["atol"], THOUSANDTH)
    return finer_options
