"""Applicability of theorems to a flock from law and start alone, before any integration."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from flockana.base.errors import FlockanaError
from flockana.base.value_checks import ensure_finite_scalar, ensure_state
from flockana.dynamics.trajectory import Trajectory
from flockana.laws.first_order_law import VelocityLaw, ensure_any_law, first_order
from flockana.laws.wrapper_base import wrappers_of
from flockana.theorems.catalogue import catalogue
from flockana.theorems.claim import Claim, Hypothesis
from flockana.theorems.observed_run import Observed
from flockana.theorems.run_verdicts import claims_on_another_law, theorems_about
from flockana.theorems.theorem import Theorem
from flockana.theorems.tolerances import Tolerances
from flockana.theorems.verification import ensure_tolerances

if TYPE_CHECKING:
    import pandas as pd

COLUMNS = ("theorem", "claim", "by", "status", "need", "margin", "remedy", "proof", "cost")
_COSTS = {"met": "nothing", "unmet": "nothing", "assumed": "a look at the need", "needs a run": "a run"}


def applicable(
    law: Any, q0: Any, p0: Any = None, *, t0: float = 0.0, tolerances: Tolerances | None = None
) -> pd.DataFrame:
    """Return a table of claims of theorems that apply to a flock by law and start, one row per claim.

    The hypotheses are those of the theorems' own checks, asked of the start alone; nothing is integrated. A claim that
    is ``"met"`` is proved under hypotheses that all hold, and `verify` finds it verified on every run from there; of
    one that is ``"unmet"`` it says vacuous.

    Parameters
    ----------
    law : Law, VelocityLaw or DiscreteLaw
        The flock's law.
    q0, p0 : array_like, shape (n, m)
        Positions and velocities at the start; at rest by default.
    t0 : float
        When it starts.
    tolerances : Tolerances, optional
        Thresholds of the claims.

    Returns
    -------
    pandas.DataFrame
        Columns: `theorem`, `claim`; `by` whom it is; `status`: ``"met"``, ``"unmet"``, ``"assumed"`` (a hypothesis is
        about more than a start shows, or nobody knows it), ``"disproved"`` (false of every run under hypotheses that
        are met) or ``"needs a run"``; `need`, the hypothesis that decides with its numbers, and its `margin`; `remedy`,
        what would meet it; the `proof`; and the `cost` of knowing more.

    Examples
    --------
    >>> from flockana import Algorithm1
    >>> table = applicable(Algorithm1(), [[0.0, 0.0], [7.0, 0.0]], [[0.0, 0.1], [0.0, 0.0]])
    >>> table[table.theorem == "energy"][["claim", "status", "proof"]].values.tolist()
    [['rate', 'met', 'energy-identities'], ['balance', 'met', 'energy-identities']]
    """
    import pandas as pd

    law, tol = ensure_any_law(law), ensure_tolerances(tolerances)
    t0 = ensure_finite_scalar("t0", t0)
    if (core := first_order(law)) is not None:
        q0, p0 = core.start(t0, q0, p0)
    q0, p0 = ensure_state(q0, np.zeros(np.shape(q0)) if p0 is None else p0)
    law.check_dimension(q0.shape[1])
    law.check_agents(len(q0))
    start = start_of(law, q0, p0, t0)
    items = [catalogue()[name] for name in theorems_about(law, q0, p0, t0)]
    rows = [row for item in sorted(items, key=lambda item: item.on_motion) for row in _rows(item, start, tol)]
    return pd.DataFrame(rows, columns=list(COLUMNS))


def applicable_to(flock: Any) -> pd.DataFrame:
    """Return the table of `applicable` for a flock, a scenario, or the start of a run."""
    if isinstance(flock, Trajectory):
        return applicable(flock.law, flock.q[0], flock.p[0], t0=float(flock.t[0]))
    law, q0, p0, (t0, _) = flock.law_and_start(0)
    return applicable(law, q0, p0, t0=t0)


def start_of(law: Any, q0: Any, p0: Any, t0: float) -> Observed:
    """Return an initial state of a law as an exact run of one sample."""
    if isinstance(law, VelocityLaw):
        u = law.acceleration(t0, q0)
    else:
        u = np.zeros(np.shape(q0)) if law.is_map or wrappers_of(law) else law.acceleration(t0, q0, p0)
    extra_series = {name: np.asarray(value)[None] for name, value in law.start(q0, p0).items()} if law.is_map else {}
    series = extra_series or {"work": np.zeros(1)}
    start_observation = Observed.alone(Trajectory(np.array([t0]), q0[None], p0[None], np.asarray(u)[None], law, series))
    return replace(start_observation, doubt="")  # of its motion nothing is asked


def _rows(item: Theorem, start: Observed, used: Tolerances) -> list[tuple[Any, ...]]:
    """Return a table row for each claim of a theorem, on its applicability to a start."""
    if wrappers_of(start.law) and not item.wrapped:
        return [_judge(item, claim) for claim in claims_on_another_law(item, start.law)[1]]
    if item.on_motion:
        return [_row(item, name, "needs a run") for name in item.claims]
    try:
        requirements, claims = item.examine(start, used)
    except FlockanaError as why:  # of a start alone it has no answer
        return [_row(item, name, "needs a run", detail=str(why)) for name in item.claims]
    need_shown = next((need for need in requirements if need.on_motion and need.status != "met"), None)
    return [_judge(item, claim, need_shown) for claim in claims]


def _judge(item: Theorem, claim: Claim, shown: Hypothesis | None = None) -> tuple[Any, ...]:
    """Return the row of one claim: decided by the first unmet requirement, else by proof or disproof."""
    for missing in ("unmet", "assumed"):
        for entry in claim.needs:
            if entry.status == missing and not entry.on_motion:
                return _row(item, claim.name, missing, entry, proof=claim.proof, by=claim.by)
    if shown is not None:
        doubt_text = "assumed" if shown.status == "assumed" else "needs a run"
        return _row(item, claim.name, doubt_text, shown, proof=claim.proof, by=claim.by)
    is_known = not any(requirement.on_motion for requirement in claim.needs)
    proved, is_disproved = claim.status == "verified" and claim.proof, claim.status == "refuted" and claim.disproof
    status = "needs a run" if not is_known else "met" if proved else "disproved" if is_disproved else "needs a run"
    margins = {float(x.margin): x for x in claim.needs if x.margin is not None}
    requirement = margins[min(margins)] if margins else None
    return _row(item, claim.name, status, requirement, proof=claim.proof or claim.disproof, by=claim.by)


def _row(
    item: Theorem,
    name: str,
    status: str,
    need: Hypothesis | None = None,
    *,
    proof: str | None = None,
    by: str = "",
    detail: str = "",
) -> tuple[Any, ...]:
    text = detail if need is None else f"{need.name}: {need.detail}".removesuffix(": ")
    margin = None if need is None else need.margin
    remedy = need.remedy if need is not None and status in ("unmet", "assumed") else ""
    owner = by or item.by(name)
    return item.id, name, owner, status, text, margin, remedy, proof or "", _COSTS.get(status, "nothing")
