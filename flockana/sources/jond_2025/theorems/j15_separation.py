"""Erratum J15: separation ensures no minimum distance c_i, since cohesion pulls within the zone of conflict."""

import numpy as np

from flockana.measures.metrics import min_distance
from flockana.sources.jond_2025.interactions.zones import ZoneRadii, ZoneWeights
from flockana.sources.jond_2025.laws.zone_flocking import ZoneFlocking
from flockana.sources.jond_2025.theorems.random_starts import runs_from_random_starts, separated_start
from flockana.theorems.theorem_toolkit import Claim, FloatArray, Tolerances, always, erratum, of_map

_SAME, _ROUNDING = 1e-6, 1e-11  # relative: distances that differ by less are the same; of a thousand steps
_C = 3.0
_RADII = ZoneRadii(1.5, c=_C, a=5.0)
_UNBOUNDED = 1e6  # an input bound that never acts
_STEPS = 1000
_CASES = ((5.0, 1.0), (5.0, 0.25), (20.0, 0.5), (2.0, 1.5))  # (w^ls, g_c), with g_c <= w^ls (c/r - 1)
_STRONG, _FINE = (5.0, 10.0), 0.005  # stronger cohesion; a time step
_SLIDES = 5e-3  # relative distance from r at which the pair slides


def _distances(separation: float, cohesion: float, start: float = 3.5, *, dt: float = 0.1) -> FloatArray:
    """Return the distance over time of two initially resting agents without a desired speed."""
    weights = ZoneWeights(separation=separation, speed=0.0, cohesion_gain=cohesion, alignment_gain=4.0)
    law = ZoneFlocking(_RADII, weights, u_max=_UNBOUNDED, dt=dt)
    q, p = np.array([[0.0, 0.0], [start, 0.0]]), np.zeros((2, 2))
    return np.diff(law.iterate(0.0, q, p, law.start(q, p), _STEPS)[0][:, :, 0], axis=1)[:, 0]


def _rest(separation: float, cohesion: float, start: float = 3.5) -> float:
    """Return the distance at which two agents come to rest."""
    return float(_distances(separation, cohesion, start)[-1])


def _sliding() -> Claim:
    """Return the claim that strong cohesion, off below r, makes a pair chatter at the distance r."""
    late, r = _distances(*_STRONG, dt=_FINE)[_STEPS // 2 :], float(np.max(_RADII.r))
    deviation = float(np.abs(late / r - 1.0).max())
    return of_map("sliding", _SLIDES - deviation, _ROUNDING, computed=[float(late.min()), float(late.max())]).described(
        stated=f"beyond g_c = w^ls (c/r - 1) a pair slides at r = {r:g}",
        witness={"w^ls": _STRONG[0], "g_c": _STRONG[1], "dt": _FINE},
        detail=f"with g_c = {_STRONG[1]:g} the balance would be at {_C * _STRONG[0] / sum(_STRONG):.3g} m, nearer "
        f"than r, where cohesion is off: the pair stays within {deviation:.1%} of r",
    )


def _pair() -> list[Claim]:
    rows = {f"w^ls = {w:g}, g_c = {g:g}": [_C * w / (w + g), _rest(w, g)] for w, g in _CASES}
    error = float(np.max([abs(stated_value - value) for stated_value, value in rows.values()]))
    printed_value, lone_distance = next(iter(rows.values()))[1], _rest(5.0, 0.0, 2.0)
    return [
        of_map("printed", printed_value / _C - 1.0, _ROUNDING, computed=printed_value).described(
            stated=f"a separation of at least c = {_C:g} m is maintained",
            witness={"w^ls": 5.0, "w^lc": "any, as it cancels", "c": _C},
            detail=f"cohesion acts in the zone of conflict as well: a pair as printed rests {printed_value:.4g} "
            f"m apart, not {_C:g}",
        ),
        of_map("rest", _SAME - error / _C, _ROUNDING).described(
            computed={case: pair[1] for case, pair in rows.items()},
            stated={case: pair[0] for case, pair in rows.items()},
            witness="two agents at rest, 3.5 m apart at first",
            detail=f"a pair rests at c w^ls/(w^ls + g_c), which is r or more, in {len(rows)} cases (off by {error:.1g} "
            "m): below c for any cohesion",
        ),
        _sliding(),
        of_map("alone", _SAME - abs(lone_distance / _C - 1.0), _ROUNDING, computed=lone_distance, stated=_C).described(
            witness={"g_c": 0.0, "q(0)": "2 m apart"},
            detail="without cohesion (6) drives a pair towards c, where it vanishes, as the paper says",
        ),
    ]


@erratum(
    "J15",
    expected={"refuted": "printed flock", "verified": "rest sliding alone"},
    corrected=("rest", "sliding"),
    ours=("alone",),
)
def theorem(tolerances: Tolerances) -> list[Claim]:
    """(6) is said to drive distances to c_i and so to ensure a minimum separation of c_i. In the zone of conflict
    cohesion acts as well: a pair rests at c w^ls/(w^ls + g_c), which is below c whenever there is cohesion, as long as
    it is r or more, g_c <= w^ls (c/r - 1). A stronger cohesion, which is off at distances up to r, makes the pair slide
    at r. (Before that agents come closer still: J12.)
    """
    distances = [min_distance(run.q[-1]) for run in runs_from_random_starts(ZoneFlocking(_RADII), separated_start)]
    return [
        *_pair(),
        always(
            "flock",
            [distance >= _C for distance in distances],
            f"after 20 s ten agents are c apart ({np.median(distances):.3g} m in the median)",
            f"a settled flock keeps its agents c = {_C:g} m apart",
        ).described(witness={"least distance by seed": distances}),
    ]
