"""Erratum J12: repulsion pulls inwards inside an obstacle or beyond a wall, and the printed weights allow contact."""

import numpy as np

from flockana.environment.polygon import SimplePolygon
from flockana.sources.jond_2025.environment.zone_obstacles import Box
from flockana.sources.jond_2025.environment.zone_world import ZoneWorld
from flockana.sources.jond_2025.interactions.zones import ZoneRadii, ZoneWeights
from flockana.sources.jond_2025.laws.zone_flocking import ZoneFlocking
from flockana.theorems.theorem_toolkit import Claim, Tolerances, erratum, observed, of_map, of_state

_ROUNDING = 1e-11  # relative: of a few hundred steps
_RADII = ZoneRadii(1.5, c=3.0, a=5.0)
_UNBOUNDED = 1e6  # an input bound that never acts
_OBSTACLE = SimplePolygon([(10.0, -5.0), (20.0, -5.0), (20.0, 5.0), (10.0, 5.0)])
_BOX = Box((0.0, 0.0), (50.0, 50.0))
# (w^ga, w) with w^ga² > 4 w before a wall and > 8 w before another agent: no overshoot turns it round
_AT_WALLS = ((5.0, 6.0), (10.0, 20.0), (10.0, 15.0))
_AT_AGENTS = ((10.0, 12.0), (12.0, 15.0))


def _outward(law: ZoneFlocking, point: tuple[float, float], outward: tuple[float, float]) -> float:
    """Return the obstacle-avoidance acceleration of an agent at a point, along a given direction."""
    force = law.behaviours([point], [[1e-3, 0.0]])["obstacle"][0]
    return float(np.dot(force, outward))


def _inside(reading: str) -> tuple[float, float, float]:
    """Return (outward force in an obstacle, inward force beyond a wall, distance beyond the wall after 3 s)."""
    weights = ZoneWeights(speed=0.0)
    obstacle_law = ZoneFlocking(_RADII, weights, ZoneWorld((_OBSTACLE,)), inside=reading, u_max=_UNBOUNDED)
    walled_law = ZoneFlocking(_RADII, weights, ZoneWorld(box=_BOX), inside=reading, u_max=_UNBOUNDED)
    q, p = np.array([[50.1, 25.0]]), np.array([[1e-3, 0.0]])
    memory = walled_law.start(q, p)
    inward_force = _outward(walled_law, (50.1, 25.0), (-1.0, 0.0))
    for k in range(30):
        q, p, _, memory = walled_law.step(k * walled_law.dt, q, p, memory)
    return _outward(obstacle_law, (10.5, 0.3), (-1.0, 0.0)), inward_force, float(q[0, 0]) - 50.0


def _head_on(law: ZoneFlocking) -> tuple[float, float]:
    """Return the final and the least signed gap of two agents that run head on at each other."""
    run = observed(law, [[0.0, 0.0], [20.0, 0.0]], [[3.0, 0.0], [-3.0, 0.0]], (0.0, 60.0)).run
    gap = run.q[:, 1, 0] - run.q[:, 0, 0]
    return float(gap[-1]), float(gap.min())


def _at_wall(speed: float, weight: float) -> float:
    """Return the distance from the wall at which an approaching agent comes to rest."""
    law = ZoneFlocking(_RADII, ZoneWeights(speed=speed, obstacle=weight), ZoneWorld(box=_BOX), u_max=_UNBOUNDED)
    return 50.0 - float(observed(law, [[25.0, 25.0]], [[3.0, 0.0]], (0.0, 60.0)).run.q[-1, 0, 0])


def _separation_only(speed: float, weight: float) -> ZoneFlocking:
    """Return the zone-based law with separation and desired speed only."""
    weights = ZoneWeights(speed=speed, separation=weight, cohesion_gain=0.0, alignment_gain=0.0)
    return ZoneFlocking(_RADII, weights, u_max=_UNBOUNDED)


def _stand_offs() -> tuple[float, dict[str, list[float]]]:
    """Return (largest error, [predicted, measured] by case) of the stand-off from a wall and from an agent."""
    rows = {f"wall, w^ga = {g:g}, w^oa = {w:g}": [3.0 - 3.0 * g / w, _at_wall(g, w)] for g, w in _AT_WALLS}
    rows |= {
        f"agents, w^ga = {g:g}, w^ls = {w:g}": [3.0 - 3.0 * g / w, _head_on(_separation_only(g, w))[0]]
        for g, w in _AT_AGENTS
    }
    return max(abs(a - b) for a, b in rows.values()), rows


@erratum("J12", expected={"refuted": "printed contact", "verified": "corrected stand-off"}, ours=("stand-off",))
def theorem(tolerances: Tolerances) -> list[Claim]:
    """Inside an obstacle or beyond a wall b - p_i reverses, and (8) pushes an agent deeper in. Outside, where weights
    damp the approach, (w^ga)² > 4w (8w for two agents), an agent that runs head on at a wall or another agent comes to
    c - v^d w^ga/w from it. At the printed 5, 5, 3, 3 that is 0 at a wall, and two agents pass through each other.
    """
    outward, inward, outer_distance = _inside("literal")
    mended_outward, mended_inward, mended_beyond = _inside("outward")
    error, stand_offs = _stand_offs()
    at_wall, (_, least_gap) = _at_wall(5.0, 5.0), _head_on(_separation_only(5.0, 5.0))
    force, c = 5.0 * _RADII.reach[1], _RADII.reach[1]  # w^oa c and c: the scales of force and length
    printed_value, clearance = max(outward, inward) / force, min(at_wall, least_gap) / c
    mended_ratio = min(mended_outward / force, mended_inward / force, -mended_beyond / c)
    return [
        of_state("printed", printed_value, _ROUNDING, disproof="stand-off").described(
            computed={"outward force in an obstacle": outward, "inward force beyond a wall": inward},
            stated="(8) repels an agent from an obstacle and from a wall",
            witness={"in an obstacle": (10.5, 0.3), "beyond the wall x = 50": (50.1, 25.0)}
            | {"beyond it after 3 s": outer_distance},
            detail=f"inside, b - p_i points outwards and (8) pushes in: {outward:.3g} in an obstacle, {inward:.3g} "
            f"beyond a wall, and after 3 s the agent is {outer_distance:.3g} m beyond it",
        ),
        of_map("corrected", mended_ratio, _ROUNDING).described(
            computed={"outward force in an obstacle": mended_outward, "inward force beyond a wall": mended_inward},
            stated="with d + c along b - p_i it is pushed out of obstacles and back behind walls",
            witness="the same agents",
            detail=f"an agent inside is pushed out by {mended_outward:.3g}, one beyond a wall back by "
            f"{mended_inward:.3g}: after 3 s it is {-mended_beyond:.3g} m inside the wall",
        ),
        of_map("stand-off", 1e-6 - error / c, _ROUNDING).described(
            computed={case: pair[1] for case, pair in stand_offs.items()},
            stated={case: pair[0] for case, pair in stand_offs.items()},
            witness="head on, inputs unbounded, weights that damp the approach",
            detail="agents that run head on at a wall, or at each other, come to c - v^d w^ga/w in "
            f"{len(stand_offs)} cases (off by {error:.1g} m)",
        ),
        of_map("contact", clearance, _ROUNDING).described(
            computed={"distance from the wall": at_wall, "least signed gap of two agents": least_gap},
            stated="w^oa = w^ls = 5 keep agents off walls and each other",
            witness={"w^ga": 5.0, "w": 5.0, "c": 3.0, "v^d": 3.0, "stand-off": 0.0},
            detail=f"with the printed 5, 5, 3, 3 the stand-off is 0: an agent comes to rest {abs(at_wall):.1g} m from "
            "the wall, and two that meet head on pass through each other",
        ),
    ]
