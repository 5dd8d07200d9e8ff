"""Erratum E9: the MSN project's position update counts the velocity's gain twice."""

from __future__ import annotations

import numpy as np

from flockana.environment.targets import StaticTarget
from flockana.interactions import Gains
from flockana.laws.msn import CONSTANT_ACCELERATION, PRINTED, MSNDiscretisation
from flockana.laws.olfati_saber import Algorithm2
from flockana.theorems.theorem import Claim, Hypothesis, Rigour, Theorem, Tolerances, judge

_Q, _P, _Q_R, _DT = 3.0, -2.0, 11.0, 0.125  # binary fractions: the step below is exact in floating point


def _step(factor: float) -> tuple[float, float]:
    """(displacement of one agent in one step beyond q + p dt + ½ u dt², u dt²)."""
    law = Algorithm2(gains=Gains(c1_gamma=1.0, c2_gamma=0.0), target=StaticTarget((_Q_R,)))
    q, p = np.array([[_Q]]), np.array([[_P]])
    after, _, u, _ = MSNDiscretisation(law, dt=_DT, position_factor=factor).step(0.0, q, p, {})
    swept = float(u[0, 0]) * _DT**2
    return float(after[0, 0]) - (_Q + _P * _DT + 0.5 * swept), swept


def _symbolic_excess(v: str) -> tuple[str, bool]:
    """(q + v dt + ½ u dt² minus what a constant u does, as text; whether it is zero), v of the step's start or end."""
    import sympy as sp

    q, p, u, dt, s = sp.symbols("q p u dt s")
    exact = q + sp.integrate(p + u * s, (s, 0, dt))
    used = {"start": p, "end": p + u * dt}[v]
    excess = sp.expand(q + used * dt + u * dt**2 / 2 - exact)
    return str(excess), excess == 0


def _check(tolerances: Tolerances) -> tuple[list[Hypothesis], list[Claim]]:
    """One step under a constant u: exactly by algebra, and on the map itself."""
    rounding = 8.0 * float(np.finfo(float).eps) * _Q_R
    claims = []
    for name, v, factor in (("printed", "end", PRINTED), ("corrected", "start", CONSTANT_ACCELERATION)):
        text, zero = _symbolic_excess(v)
        measured, swept = _step(factor)
        rigour: Rigour = "symbolic"
        claims.append(
            Claim(
                name,
                "verified" if zero else "refuted",
                rigour,
                computed=text,
                stated="0",
                witness={"u dt²": swept, "excess of one step of the map": measured},
                detail=f"with the velocity of the {v} of the step, q moves {text} beyond q + p dt + ½ u dt²",
            )
        )
    measured, swept = _step(PRINTED)
    margin = tolerances.agreement * abs(swept) - abs(measured - swept)
    claims.append(
        Claim(
            "excess",
            judge(margin, rounding, []),
            computed=measured,
            stated=swept,
            margin=margin,
            error=rounding,
            witness=f"one agent, u = {swept / _DT**2:g}, dt = {_DT:g}",
            detail=f"one printed step of the map goes {measured:.6g} too far, where u dt² = {swept:.6g}",
        )
    )
    return [], claims


THEOREM = Theorem(
    id="E9",
    title="The MSN project's step moves the agents u dt² too far",
    statement=(
        "The MSN project takes v' = v + u dt first and then q' = q + v' dt + ½ u dt². Under a constant u the "
        "displacement is v dt + ½ u dt²; the printed one is v dt + (3/2) u dt², an excess of u dt²."
    ),
    source="MSN project, update of the kinematics",
    kind="fixed",
    check=_check,
    references=("isola-2024",),
    expected={"E9": "refuted", "E9:printed": "refuted", "E9:corrected": "verified", "E9:excess": "verified"},
)
