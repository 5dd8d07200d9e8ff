"""Erratum E9: the MSN project's position update counts the velocity's gain twice."""

from typing import Any

import numpy as np

from flockana.environment.targets import StaticTarget
from flockana.interactions import Gains
from flockana.laws.olfati_saber import Algorithm2
from flockana.sources.isola_2024.laws import CONSTANT_ACCELERATION, PRINTED, MSNDiscretisation
from flockana.theorems.theorem_toolkit import EPS, Claim, Tolerances, erratum, exact, of_map

_Q, _P, _Q_R, _DT = 3.0, -2.0, 11.0, 0.125  # binary fractions: the step below is exact in floating point
_PROOF = "constant-acceleration"


def _step(factor: float) -> tuple[float, float]:
    """Return (displacement beyond q + p dt + ½ u dt² in one step, u dt²) of one agent."""
    law = Algorithm2(gains=Gains(c1_gamma=1.0, c2_gamma=0.0), target=StaticTarget((_Q_R,)))
    q, p = np.array([[_Q]]), np.array([[_P]])
    next_positions, _, u, _ = MSNDiscretisation(law, dt=_DT, position_factor=factor).step(0.0, q, p, {})
    swept = float(u[0, 0]) * _DT**2
    return float(next_positions[0, 0]) - (_Q + _P * _DT + 0.5 * swept), swept


def _symbolic_excess(v: str) -> tuple[str, bool]:
    """Return (excess of q + v dt + ½ u dt² over exact motion, as text; whether zero), for old or new v."""
    import sympy as sp

    q, p, u, dt, s = sp.symbols("q p u dt s")
    exact = q + sp.integrate(p + u * s, (s, 0, dt))
    velocity_used = {"start": p, "end": p + u * dt}[v]
    excess = sp.expand(q + velocity_used * dt + u * dt**2 / 2 - exact)
    return str(excess), excess == 0


def _by_algebra(name: str, v: str, factor: float, **proof: Any) -> Claim:
    """Return the claim that a step equals exact motion under constant u, with old or new velocity."""
    text, zero = _symbolic_excess(v)
    measured, swept = _step(factor)
    detail = f"with the velocity at the {v} of the step, the displacement exceeds p dt + ½ u dt² by {text}"
    return exact(name, zero, **proof).described(
        computed=text, stated="0", witness={"u dt²": swept, "excess of one step of the map": measured}, detail=detail
    )


@erratum(
    "E9", references=("isola-2024",), expected={"refuted": "printed", "verified": "corrected excess"}, ours=("excess",)
)
def theorem(tolerances: Tolerances) -> list[Claim]:
    """The MSN project takes v' = v + u dt first and then q' = q + v' dt + ½ u dt². Under a constant u the displacement
    is v dt + ½ u dt²; the printed one is v dt + (3/2) u dt², an excess of u dt².
    """
    # One step under a constant u: exactly by algebra, and on the map itself.
    excess, swept = _step(PRINTED)
    return [
        _by_algebra("printed", "end", PRINTED, disproof=_PROOF),
        _by_algebra("corrected", "start", CONSTANT_ACCELERATION, proof=_PROOF),
        of_map("excess", tolerances.agreement * abs(swept) - abs(excess - swept), 8.0 * EPS * _Q_R).described(
            computed=excess,
            stated=swept,
            witness=f"one agent, u = {swept / _DT**2:g}, dt = {_DT:g}",
            detail=f"one printed step of the map goes {excess:.6g} too far, where u dt² = {swept:.6g}",
        ),
    ]
