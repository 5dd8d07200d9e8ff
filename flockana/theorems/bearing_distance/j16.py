"""Erratum J16: in a box fragments need not reunite, and growing radii find one flockmate, not the flock."""

from __future__ import annotations

import numpy as np

from flockana.base.checks import FloatArray
from flockana.environment.zone_obstacles import Box
from flockana.environment.zone_world import ZoneWorld
from flockana.interactions import ZoneRadii, ZoneWeights
from flockana.laws.bearing_distance import ZoneFlocking
from flockana.theorems.claims import erratum, of_state
from flockana.theorems.shares import always
from flockana.theorems.theorem import Claim, Tolerances

_ROUNDING = 1e-11  # relative: of a few thousand steps straight on
_A, _SIDE, _SPEED = 5.0, 50.0, 3.0
_RADII = ZoneRadii(1.5, c=3.0, a=_A)
_PRINTED = ZoneWeights(cohesion_gain=1.0, alignment_gain=1.0)
_WALLED = ZoneWorld(box=Box((0.0, 0.0), (_SIDE, _SIDE)))
_SEEDS, _STEPS, _CLEAR = 40, 6000, 4.0  # of 0.1 s; m from the walls at first
_GROWTH, _SLOWER = 10.0, 5.0  # m/s: faster than two part at v^d each, and slower


def _positions(law: ZoneFlocking, q: FloatArray, p: FloatArray, steps: int) -> FloatArray:
    return law.iterate(0.0, q, p, law.start(q, p), steps)[0]


def _at_rest() -> Claim:
    """Two agents at rest, out of each other's sight and clear of the walls: no force at all, for ever."""
    law = ZoneFlocking.printed(_RADII, world=_WALLED)
    q, p = np.array([[10.0, 10.0], [40.0, 40.0]]), np.zeros((2, 2))
    path = _positions(law, q, p, 100)
    moved, apart = float(np.abs(path - q).max()), float(np.linalg.norm(path[-1, 1] - path[-1, 0]))
    return of_state(
        "at-rest",
        1.0 - apart / _A if moved == 0.0 else float("nan"),  # a state that a map keeps to the bit it keeps for ever
        _ROUNDING,
        computed=moved,
        stated="in a box separated agents eventually reunite",
        witness={"q": q.tolist(), "p": "0"},
        detail="two agents at rest, farther apart than a_i and than c_i from the walls: every behaviour is exactly "
        "zero (at rest (5) is 0/0, and read as 0), and they stay where they are",
    )


def _circling() -> Claim:
    """Two lone agents in the box, charitably read: many come to run along the walls, one behind the other."""
    law = ZoneFlocking(_RADII, _PRINTED, _WALLED)
    nearest = []
    for seed in range(_SEEDS):
        rng = np.random.default_rng(seed)
        q, angle = rng.uniform(_CLEAR, _SIDE - _CLEAR, (2, 2)), rng.uniform(0.0, 2.0 * np.pi, 2)
        path = _positions(law, q, _SPEED * np.column_stack([np.cos(angle), np.sin(angle)]), _STEPS)
        nearest.append(float(np.linalg.norm(path[:, 1] - path[:, 0], axis=1).min()))
    return always(
        "circling",
        [distance <= _A for distance in nearest],
        f"two agents in a box of {_SIDE:g} m meet within {0.1 * _STEPS:g} s",
        "lone agents in a box meet sooner or later",
        witness={"least distance by seed": nearest},
    )


def _lone() -> Claim:
    """Remark 2: two who fly apart in the open find each other once their radii of attraction grow."""
    q, p = np.array([[0.0, 0.0], [20.0, 3.0]]), np.array([[-_SPEED, 0.0], [_SPEED, 0.0]])
    gap = {growth: _last_gap(growth, q, p) for growth in (0.0, _SLOWER, _GROWTH)}
    return of_state(
        "growing",
        float(np.min([gap[0.0] / _A - 1.0, gap[_SLOWER] / _A - 1.0, 1.0 - gap[_GROWTH] / _A])),
        _ROUNDING,
        computed={f"distance after two minutes, growth {growth:g} m/s": d for growth, d in gap.items()},
        stated="lone agents part, unless their radii of attraction grow faster than they do so",
        witness={"q(0)": q.tolist(), "p(0)": p.tolist()},
        detail=f"two lone agents that fly apart are {gap[0.0]:.3g} m apart after two minutes, with radii that grow by "
        f"{_SLOWER:g} m/s {gap[_SLOWER]:.3g} m (they part by 6 m/s), and by {_GROWTH:g} m/s {gap[_GROWTH]:.3g} m",
    )


def _last_gap(growth: float, q: FloatArray, p: FloatArray) -> float:
    end = _positions(ZoneFlocking(_RADII, growth=growth), q, p, 1200)[-1]
    return float(np.linalg.norm(end[-1] - end[0]))


def _pairs() -> Claim:
    """Two pairs at their distance of rest and at the desired speed: everyone has a flockmate, and nothing grows."""
    law = ZoneFlocking(_RADII, _PRINTED, growth=_GROWTH)
    q = np.array([[0.0, 0.0], [0.0, 2.5], [20.0, 0.0], [20.0, 2.5]])  # 2.5 = c w^ls/(w^ls + g_c): no force
    p = _SPEED * np.array([[-1.0, 0.0], [-1.0, 0.0], [1.0, 0.0], [1.0, 0.0]])
    gap = _positions(law, q, p, 600)[-1]
    parted = float(gap[2, 0] - gap[0, 0])
    straight = 20.0 + 2.0 * _SPEED * 60.0
    return of_state(
        "fragments",
        0.5 - parted / straight,
        _ROUNDING,
        computed=parted,
        stated="growing radii of attraction keep the flock one",
        witness={"q(0)": q.tolist(), "p(0)": p.tolist()},
        detail=f"two pairs that fly apart: each agent has its flockmate, no radius grows, and they are {parted:.4g} m "
        f"apart after a minute, as straight on ({straight:g})",
    )


def _check(tolerances: Tolerances) -> list[Claim]:
    return [_at_rest(), _circling(), _lone(), _pairs()]


THEOREM = erratum(
    "J16",
    title="In a box fragments need not reunite",
    statement=(
        "Remark 2 says that in a confined environment separated agents eventually reunite, and that else radii of "
        "attraction may grow until a flockmate is found. Agents at rest never meet, and lone ones may run along the "
        "walls one behind the other. Growing radii bring lone agents back; fragments of two or more they leave apart."
    ),
    source="Jond, bearing-distance flocking, Remark 2",
    check=_check,
    references=("jond-2025",),
    expected={"at-rest": "refuted", "circling": "refuted", "growing": "verified", "fragments": "refuted"},
)
