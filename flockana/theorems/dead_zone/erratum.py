"""What the errata of the dead-zone paper share: claims judged by a margin, the theorem of an erratum, two set-ups."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any

import numpy as np

from flockana.base.checks import FloatArray
from flockana.laws.dead_zone import DeadZoneFlocking
from flockana.theorems.theorem import Claim, Hypothesis, Rigour, Status, Theorem, Tolerances, judge

CheckResult = tuple[list[Hypothesis], list[Claim]]


def margin_claim(
    name: str, margin: float, detail: str, *, error: float, rigour: Rigour = "numeric", **more: Any
) -> Claim:
    """A claim judged by its margin alone."""
    return Claim(name, judge(margin, error, []), rigour, margin=margin, error=error, detail=detail, **more)


def erratum(
    number: int,
    title: str,
    statement: str,
    source: str,
    check: Callable[[Tolerances], tuple[Iterable[Hypothesis], Iterable[Claim]]],
    *,
    whole: Status,
    **claims: Status,
) -> Theorem:
    """Erratum L1 to L8 as a theorem that is checked by itself."""
    key = f"L{number}"
    expected = {f"{key}:{name.replace('_', '-')}": status for name, status in claims.items()}
    where = f"Li, Yuan and Liu, {source}"
    return Theorem(key, title, statement, where, "fixed", check, ("li-dead-zone",), {key: whole, **expected})


def parting_pair() -> tuple[DeadZoneFlocking, FloatArray, FloatArray]:
    """(law, q, p) of two agents 14 m apart that leave each other at 12 m/s."""
    return DeadZoneFlocking(), np.array([[0.0, 0.0], [14.0, 0.0]]), np.array([[-6.0, 0.0], [6.0, 0.0]])


def advance(
    law: DeadZoneFlocking, q: FloatArray, p: FloatArray, dt: float, t_end: float
) -> tuple[FloatArray, FloatArray]:
    """Positions and velocities at t_end, by semi-implicit Euler steps of which only the last is kept."""
    for _ in range(round(t_end / (500 * dt))):
        states = law.semi_implicit(q, p, dt, 500)
        q, p = states[0][-1], states[1][-1]
    return q, p
