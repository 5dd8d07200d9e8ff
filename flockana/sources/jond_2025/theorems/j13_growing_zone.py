"""Erratum J13: an obstacle zone growing with speed causes no earlier reaction, as (8) measures from c_i."""

import numpy as np

from flockana.sources.jond_2025.environment.zone_obstacles import Box
from flockana.sources.jond_2025.environment.zone_world import ZoneWorld
from flockana.sources.jond_2025.interactions.zones import ZoneRadii, ZoneWeights
from flockana.sources.jond_2025.laws.zone_flocking import ZoneFlocking
from flockana.theorems.theorem_toolkit import Claim, FloatArray, Tolerances, erratum, of_map, of_state

_ROUNDING = 1e-11  # relative: of a few hundred steps
_R, _C, _A, _V_MAX, _SIDE = 1.5, 3.0, 5.0, 4.0, 50.0
_RADII = ZoneRadii(_R, c=_C, a=_A)
_UNBOUNDED = 1e6  # an input bound that never acts
_DRIVE, _WEIGHT, _DESIRED = 5.0, 12.0, 3.0
_STEP, _STEPS = 0.02, 2000  # s; with the zone's own the approach is damped, and with 0.1 s it would overshoot
_PLACE, _HEADING = (30.0, 0.5 * _SIDE), (_DESIRED, 0.0)  # of an agent that runs head on at a wall
_NEAR = 1e-3  # relative: on either side of where the zone ends


def _law(zone_length: str, obstacle_force: str = "repulsive") -> ZoneFlocking:
    return ZoneFlocking(
        _RADII,
        ZoneWeights(obstacle=_WEIGHT, speed=_DRIVE),
        ZoneWorld(box=Box((0.0, 0.0), (_SIDE, _SIDE))),
        u_max=_UNBOUNDED,
        v_max=_V_MAX,
        dt=_STEP,
        zone_length=zone_length,
        obstacle_force=obstacle_force,
    )


def _braking(law: ZoneFlocking, distance: float, speed: float) -> float:
    """Return the obstacle-avoidance deceleration of an agent heading for a wall, divided by w^oa c."""
    force = law.behaviours([[_SIDE - distance, 0.5 * _SIDE]], [[speed, 0.0]])["obstacle"][0, 0]
    return -float(force) / (_WEIGHT * _C)


def _head_on(law: ZoneFlocking) -> FloatArray:
    """Return the distance over time of an agent from the wall that the agent heads for."""
    q, p = np.array([_PLACE]), np.array([_HEADING])
    return _SIDE - law.iterate(0.0, q, p, law.start(q, p), _STEPS)[0][:, 0, 0]


def _letter() -> Claim:
    middle_distance = 0.5 * (_C + _A)
    braking = _braking(_law("attraction", "literal"), middle_distance, _DESIRED)
    return of_state("letter", braking, _ROUNDING, computed=braking).described(
        stated="with an altitude of a_i an agent is repelled by what comes within it",
        witness={"distance from the wall": middle_distance, "c": _C, "a": _A},
        detail=f"(8) is w (d - c): at d = {middle_distance:g}, beyond c = {_C:g}, it attracts, by {-braking:.3g} w c",
    )


def _clamped() -> Claim:
    long, short = (_head_on(_law(name)) for name in ("attraction", "conflict"))
    different = np.flatnonzero(np.abs(long - short) > _ROUNDING * _SIDE).size
    return of_map("clamped", different - 0.5, 0.0).described(
        computed={"steps in which the two runs differ": different},
        stated="more reaction space: with the altitude a_i an agent brakes earlier than with c_i",
        witness={"q(0)": _PLACE, "p(0)": _HEADING, "steps": long.size},
        detail=f"with min(0, d - c) nothing acts beyond c: head on the runs with a_i and with c_i are the same in "
        f"{long.size - different} of {long.size} steps (oblique to a wall it acts longer, not farther off)",
    )


def _reaching() -> Claim:
    """Return the claim that an agent brakes just inside its speed-dependent obstacle zone, and not outside."""
    law = _law("speed", "reaching")
    deviations, rows = [], {}
    for speed in (0.5, 1.0, 2.0, 3.0, _V_MAX):
        reach = _R + (_A - _R) * min(1.0, speed / _V_MAX)
        inner_distance, outer_force = (_braking(law, (1.0 + side * _NEAR) * reach, speed) for side in (-1.0, 1.0))
        expected = _NEAR * reach / _C  # of w (h − d) over w c
        deviations += [abs(inner_distance / expected - 1.0), abs(outer_force) / expected]
        rows[speed] = reach
    return of_state(
        "reaching",
        1e-6 - float(np.max(deviations)),
        1e-8,  # relative: of a difference of positions, a thousandth of their distance
        computed=rows,
        stated="an agent at speed v reacts from h = r + (a - r) v/v^max on",
        witness={"speeds": list(rows), "force": "w min(0, d - h)"},
        detail=f"measured from the zone's end, w min(0, d - h), the reaction begins at h(v): {_R:g} m when slow, "
        f"{_A:g} m at v^max",
    )


def _slow() -> Claim:
    """Return the claim that an agent braked at a wall has the short zone and stops at r − v^d w^ga/w^oa."""
    measured = float(_head_on(_law("speed", "reaching"))[-1])
    stated_value = _R - _DESIRED * _DRIVE / _WEIGHT
    return of_map("stand-off", 1e-6 - abs(measured - stated_value) / _C, _ROUNDING, computed=measured).described(
        stated=stated_value,
        witness={"w^ga": _DRIVE, "w^oa": _WEIGHT, "v^d": _DESIRED},
        detail=f"braked, the zone contracts to r: the agent stops {measured:.4f} m from the wall, at "
        "r - v^d w^ga/w^oa, nearer than at c - v^d w^ga/w^oa",
    )


@erratum(
    "J13", expected={"refuted": "letter clamped", "verified": "reaching stand-off"}, corrected=("reaching", "stand-off")
)
def theorem(tolerances: Tolerances) -> list[Claim]:
    """The altitude of the obstacle zone may extend to a_i at speed, for more reaction space, and contract to r_i when
    slow. But (8) measures from c_i: beyond it the force attracts, or, cut off there, is zero, so that the longer zone
    changes nothing in a head-on approach. If (8) measures from the zone's own end, the zone does what the paper says.
    """
    return [_letter(), _clamped(), _reaching(), _slow()]
