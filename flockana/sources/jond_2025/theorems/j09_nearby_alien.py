"""Erratum J9: an alien nearer than a_i exerts no force on an agent as printed, and passes through the flock."""

import numpy as np

from flockana.sources.jond_2025.environment.zone_world import Alien, ZoneWorld
from flockana.sources.jond_2025.interactions.zones import ZoneRadii, ZoneWeights
from flockana.sources.jond_2025.laws.zone_flocking import ZoneFlocking
from flockana.sources.jond_2025.theorems.random_starts import DURATION, runs_from_random_starts
from flockana.theorems.theorem_toolkit import Claim, Tolerances, always, erratum, observed, of_map

_ROUNDING = 1e-11  # relative: of a few hundred steps of one agent
_UNBOUNDED = 1e6  # an input bound that never acts
_WATCHFUL = ZoneRadii(1.5, c=3.0, a=5.0, s=6.0)
_STRONG = ZoneWeights(separation=20.0, cohesion_gain=0.5, alignment_gain=4.0)  # recommended for section 5.2


def _nearest_alien(surveillance: str) -> tuple[float, list[float]]:
    """Return (least signed gap of an agent heading for a resting alien, least alien distances by seed)."""
    resting_world = ZoneWorld((), None, (Alien((20.0, 0.0), detection=1e-3),))
    lone_law = ZoneFlocking(_WATCHFUL, ZoneWeights(), resting_world, surveillance=surveillance, u_max=_UNBOUNDED)
    head_on_run = observed(lone_law, [[0.0, 0.0]], [[3.0, 0.0]], (0.0, DURATION)).run
    hunting_world = ZoneWorld((), None, (Alien((16.0, 16.0)),))
    flock = ZoneFlocking(_WATCHFUL, _STRONG, hunting_world, surveillance=surveillance, u_max=10.0)
    gaps = [run.q[:, :, None] - run.extra["alien"][:, None] for run in runs_from_random_starts(flock)]
    nearest = [float(np.linalg.norm(gap, axis=3).min()) for gap in gaps]
    return float((20.0 - head_on_run.q[:, 0, 0]).min()), nearest


@erratum("J9", expected={"refuted": "printed flock", "verified": "corrected"})
def theorem(tolerances: Tolerances) -> list[Claim]:
    """N_i^s contains the aliens at a_i < d <= s_i: one that comes closer exerts no force and passes through the flock.
    With 0 < d <= s_i an agent stands off at s - v^d w^ga/w^ss.
    """
    (passing_distance, annulus), (gap, disc) = (_nearest_alien(name) for name in ("annulus", "disc"))
    stand_off = 6.0 - 3.0 * 5.0 / 5.0  # s − v^d w^ga/w^ss
    clear_count = sum(d > a for d, a in zip(disc, annulus, strict=True))
    return [
        of_map("printed", passing_distance / stand_off, _ROUNDING, about="all", disproof="stand-off").described(
            computed=passing_distance,
            stated="an agent keeps clear of an alien that it sees",
            witness={"alien": (20.0, 0.0), "q(0)": (0.0, 0.0), "p(0)": (3.0, 0.0)},
            detail="N_i^s ends at a_i: nearer than 5 m the alien exerts no force: an agent runs straight through it",
        ),
        of_map("corrected", 1e-3 - abs(gap / stand_off - 1.0), _ROUNDING, computed=gap, stated=stand_off).described(
            witness="the same agent and alien, 0 < d <= s_i",
            detail=f"with 0 < d <= s_i the agent stops at {gap:.4f} m, where s - v^d w^ga/w^ss = {stand_off:g}",
        ),
        always(
            "flock",
            [distance > 1.5 for distance in annulus],
            f"as printed ten agents keep more than 1.5 m from a hunting alien ({np.median(annulus):.2f} m in the "
            f"median; as corrected {np.median(disc):.2f} m, farther in {clear_count} of {len(disc)})",
            "the flock keeps more than 1.5 m from an alien that hunts it (share 1)",
        ).described(witness={"printed": annulus, "corrected": disc}),
    ]
