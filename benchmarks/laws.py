"""Time per pair of every kind of pair law, in the plane and in space, against Algorithm 2 in the plane."""

from __future__ import annotations

import numpy as np

from benchmarks.flocks import NEIGHBOURS, Flock
from benchmarks.rows import Found, Row
from benchmarks.timing import interleaved, ratio
from flockana.environment.obstacles import Sphere
from flockana.environment.targets import StaticTarget
from flockana.kernels.neighbours import pair_blocks
from flockana.laws.algorithm3 import Algorithm3
from flockana.laws.law import Law
from flockana.laws.olfati_saber import Algorithm1, Algorithm2
from flockana.sources.jond_2025.laws.minimal import MinimalFlocking
from flockana.sources.li_dead_zone.laws.dead_zone import DeadZoneFlocking

STUDY = "Time per pair, law by law"
N = 10_000
RADIUS = 10.0  # of perception, in the minimal model


def study(*, quick: bool) -> Found:
    """One evaluation each, of a gas with 12 neighbours within the law's own range."""
    calls, pairs = {}, {}
    for name, (law, m, reach) in _laws().items():
        q, p = _gas(reach, m)
        pairs[name] = sum(i.size for i, _ in pair_blocks(q, reach))
        calls[name] = lambda law=law, q=q, p=p: law.flow(0.0, q, p)
    found = interleaved(calls, rounds=3 if quick else 9)
    per_pair = {name: 1e9 * seconds / pairs[name] for name, seconds in found.items()}
    first, *others = per_pair
    rows = [Row(STUDY, first, N, float(np.median(per_pair[first])), "ns per pair")]
    rows += [
        Row(
            STUDY,
            name,
            N,
            float(np.median(per_pair[name])),
            "ns per pair",
            first,
            ratio(per_pair[name], per_pair[first]),
        )
        for name in others
    ]
    return Found(rows)


def _laws() -> dict[str, tuple[Law, int, float]]:
    """By name: a law, the dimension, and how far its agents see."""
    plane, space = StaticTarget((0.0, 0.0)), StaticTarget((0.0, 0.0, 0.0))
    two, dead = Algorithm2(target=plane), DeadZoneFlocking()
    three = Algorithm3(target=plane, obstacles=(Sphere((-50.0, 0.0), 10.0), Sphere((-80.0, 40.0), 5.0)))
    r, reach = two.alpha.range, dead.interaction.range
    return {
        "Algorithm 2": (two, 2, r),
        "Algorithm 1": (Algorithm1(), 2, r),
        "Algorithm 3 with two discs": (three, 2, r),
        "dead zone": (dead, 2, reach),
        "minimal model": (MinimalFlocking(radius=RADIUS), 2, RADIUS),
        "Algorithm 2 in space": (Algorithm2(target=space), 3, r),
        "dead zone in space": (dead, 3, reach),
        "minimal model in space": (MinimalFlocking(radius=RADIUS), 3, RADIUS),
    }


def _gas(reach: float, m: int) -> Flock:
    rng = np.random.default_rng(0)
    ball = np.pi * reach**2 if m == 2 else 4.0 / 3.0 * np.pi * reach**3
    return rng.uniform(0.0, (ball * N / NEIGHBOURS) ** (1.0 / m), (N, m)), rng.uniform(-1.0, 1.0, (N, m))
