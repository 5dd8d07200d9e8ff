"""Erratum J16: fragments in a box need not reunite; growing radii find one flockmate, not the flock."""

import numpy as np

from flockana.sources.jond_2025.environment.zone_obstacles import Box
from flockana.sources.jond_2025.environment.zone_world import ZoneWorld
from flockana.sources.jond_2025.interactions.zones import ZoneRadii, ZoneWeights
from flockana.sources.jond_2025.laws.zone_flocking import ZoneFlocking
from flockana.theorems.theorem_toolkit import Certificate, Claim, FloatArray, Tolerances, erratum, limit_claim, of_map

_ROUNDING = 1e-11  # relative: of a few thousand steps straight on
_A, _C, _SIDE, _SPEED = 5.0, 3.0, 50.0, 3.0
_RADII = ZoneRadii(1.5, c=_C, a=_A)
_PRINTED = ZoneWeights(cohesion_gain=1.0, alignment_gain=1.0)
_WALLED = ZoneWorld(box=Box((0.0, 0.0), (_SIDE, _SIDE)))
_SEEDS, _STEPS, _CLEAR = 40, 6000, 4.0  # of 0.1 s; m from the walls at first
_UNBOUNDED, _STEPS_AT_WALLS, _LINEAR = 1e6, 200, 1e-9  # an input bound that never acts; m
_REUNITE = "in a box separated agents eventually reunite"
_GROWTH, _SLOWER = 10.0, 5.0  # m/s: faster than two part at v^d each, and slower


def _positions(law: ZoneFlocking, q: FloatArray, p: FloatArray, steps: int) -> FloatArray:
    return law.iterate(0.0, q, p, law.start(q, p), steps)[0]


def _at_walls() -> Claim:
    """Return the claim that two agents head on at opposite walls slow down and stay there."""
    # With e = d - d*, the speed and e obey v' = (1 - gδ)v + wδe and e' = e - δv'. Of a matrix with two real eigenvalues
    # in (0, 1) all states with e/v above that of the faster mode stay so, with v > 0: e falls, and never to 0.
    law = ZoneFlocking(_RADII, _PRINTED, _WALLED, u_max=_UNBOUNDED)
    q, p = np.array([[_C, 25.0], [_SIDE - _C, 25.0]]), np.array([[-_SPEED, 0.0], [_SPEED, 0.0]])
    g, w, dt = float(np.max(_PRINTED.speed)), float(np.max(_PRINTED.obstacle)), law.dt
    step = np.array([[1.0 - g * dt, w * dt], [-dt * (1.0 - g * dt), 1.0 - w * dt**2]])
    fast, slow_root = np.sort(np.linalg.eigvals(step))
    e = _SPEED * g / w  # d - d* at d = c
    states = np.array([np.linalg.matrix_power(step, k) @ (_SPEED, e) for k in range(1, _STEPS_AT_WALLS + 1)])
    path = _positions(law, q, p, _STEPS_AT_WALLS)[:, :, 0]
    depths = np.stack([_C - path[:, 0], path[:, 1] - (_SIDE - _C)])
    off = float(np.abs(depths - (e - states[:, 1])).max())
    real = bool(np.isrealobj(fast) and 0.0 < fast < slow_root < 1.0)
    margin = min(e / _SPEED - (fast - step[0, 0]) / step[0, 1], 1.0 - off / _LINEAR) if real else -1.0
    return limit_claim(
        "at-walls",
        [],
        escape=Certificate(float(margin), "their speeds towards the walls stay positive at all later times", _ROUNDING),
        computed={"steps off the linear recursion by": off, "eigenvalues": [float(fast.real), float(slow_root.real)]},
        stated=_REUNITE,
        witness={"q(0)": q.tolist(), "p(0)": p.tolist(), "bound of inputs": _UNBOUNDED},
        detail=f"two agents that head for opposite walls at v^d come to rest at them, {_SIDE - 2.0 * _C:g} m apart "
        "or more: in the zones of the walls each obeys a linear recursion",
    )


def _circling() -> Claim:
    """Return the claim that many pairs of lone agents in a box end up running along the walls in line."""
    law = ZoneFlocking(_RADII, _PRINTED, _WALLED)
    nearest = []
    for seed in range(_SEEDS):
        rng = np.random.default_rng(seed)
        q, angle = rng.uniform(_CLEAR, _SIDE - _CLEAR, (2, 2)), rng.uniform(0.0, 2.0 * np.pi, 2)
        path = _positions(law, q, _SPEED * np.column_stack([np.cos(angle), np.sin(angle)]), _STEPS)
        nearest.append(float(np.linalg.norm(path[:, 1] - path[:, 0], axis=1).min()))
    meetings = sum(distance <= _A for distance in nearest)
    return limit_claim("circling", [], computed={"meet": meetings, "of": _SEEDS}).described(
        stated="lone agents in a box meet sooner or later, wherever they start",
        witness={"least distance by seed": nearest},
        detail=f"from {meetings} of {_SEEDS} random starts two agents in a box of {_SIDE:g} m meet within "
        f"{0.1 * _STEPS:g} s; the others run along the walls, one behind the other, which leaves later times open",
    )


def _growing_radii() -> Claim:
    """Return the claim of Remark 2: growing radii of attraction reunite two separated agents."""
    q, p = np.array([[0.0, 0.0], [20.0, 3.0]]), np.array([[-_SPEED, 0.0], [_SPEED, 0.0]])
    gap = {growth: _last_gap(growth, q, p) for growth in (0.0, _SLOWER, _GROWTH)}
    margin = float(np.min([gap[0.0] / _A - 1.0, gap[_SLOWER] / _A - 1.0, 1.0 - gap[_GROWTH] / _A]))
    return of_map("growing", margin, _ROUNDING).described(
        computed={f"distance after two minutes, growth {growth:g} m/s": d for growth, d in gap.items()},
        stated="lone agents part, unless their radii of attraction grow faster than they do so",
        witness={"q(0)": q.tolist(), "p(0)": p.tolist()},
        detail=f"two lone agents that fly apart at 6 m/s are {gap[0.0]:.3g} m apart after two minutes; "
        f"{gap[_SLOWER]:.3g} m if radii grow by {_SLOWER:g} m/s, {gap[_GROWTH]:.3g} m if by {_GROWTH:g} m/s",
    )


def _last_gap(growth: float, q: FloatArray, p: FloatArray) -> float:
    end = _positions(ZoneFlocking(_RADII, growth=growth), q, p, 1200)[-1]
    return float(np.linalg.norm(end[-1] - end[0]))


def _pairs() -> Claim:
    """Return the claim that no radius grows in two pairs at rest distance, as every agent has a flockmate."""
    law = ZoneFlocking(_RADII, _PRINTED, growth=_GROWTH)
    q = np.array([[0.0, 0.0], [0.0, 2.5], [20.0, 0.0], [20.0, 2.5]])  # 2.5 = c w^ls/(w^ls + g_c): no force
    p = _SPEED * np.array([[-1.0, 0.0], [-1.0, 0.0], [1.0, 0.0], [1.0, 0.0]])
    gap = _positions(law, q, p, 600)[-1]
    end_gap = float(gap[2, 0] - gap[0, 0])
    straight_distance = 20.0 + 2.0 * _SPEED * 60.0
    return of_map("fragments", 0.5 - end_gap / straight_distance, _ROUNDING, computed=end_gap).described(
        stated="growing radii of attraction keep the flock one",
        witness={"q(0)": q.tolist(), "p(0)": p.tolist()},
        detail=f"two pairs that fly apart: each agent has its flockmate, no radius grows, and they are {end_gap:.4g} m "
        f"apart after a minute, as in straight flight ({straight_distance:g})",
    )


@erratum(
    "J16", corrected=(), expected={"refuted": "at-walls fragments", "inconclusive": "circling", "verified": "growing"}
)
def theorem(tolerances: Tolerances) -> list[Claim]:
    """Remark 2 says that in a confined environment separated agents eventually reunite, and that otherwise radii of
    attraction may grow until a flockmate is found. Two agents that head for opposite walls at v^d come to rest there
    and never meet. Others run along the walls, one behind the other, which decides nothing about later times. Growing
    radii bring lone agents back, but leave fragments of two or more agents apart.
    """
    return [_at_walls(), _circling(), _growing_radii(), _pairs()]
