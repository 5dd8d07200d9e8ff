"""Erratum L7: velocities match within components only, and hard jumps of the force make contacts chatter."""

import numpy as np

from flockana.measures.metrics import spreads
from flockana.sources.li_dead_zone.interactions import DeadZoneInteraction
from flockana.sources.li_dead_zone.laws.dead_zone import DeadZoneFlocking
from flockana.sources.li_dead_zone.theorems.common_claims import final_components, settling
from flockana.sources.li_dead_zone.theorems.local_basin import hold
from flockana.sources.li_dead_zone.theorems.shared_runs import advance, parting_pair
from flockana.theorems.theorem_toolkit import (
    Claim,
    FloatArray,
    Tolerances,
    by_count,
    erratum,
    limit_claim,
    observed,
    of_map,
)

_SPREAD = 0.2  # of a ratio of two means of a chattering scheme: over starts they differ by 7 %


def _settled(law: DeadZoneFlocking, dt: float) -> tuple[FloatArray, FloatArray]:
    """Return positions and velocities of 12 agents at t = 200, by semi-implicit Euler steps."""
    generator = np.random.default_rng(0)
    q, p = generator.uniform(0.0, 12.0, (12, 2)), generator.uniform(-1.0, 1.0, (12, 2))
    return advance(law, q, p, dt, 200.0)


def _chatter(law: DeadZoneFlocking, dt: float) -> float:
    """Return √K̃, the velocity disagreement, averaged over t = 200 to 220."""
    velocities = law.semi_implicit(*_settled(law, dt), dt, round(20.0 / dt))[1]
    return float(np.sqrt(spreads(velocities) / velocities.shape[1]).mean())


@erratum(
    "L7",
    expected={"refuted": "printed", "verified": "components chatter sliding ramp"},
    corrected=("components", "ramp"),
    ours=("chatter", "sliding"),
)
def theorem(tolerances: Tolerances) -> list[Claim]:
    """Velocities match within connected components only. With the printed hard jumps contacts are sliding modes, and a
    scheme of fixed step chatters about them; with a ramp the mismatch vanishes.
    """
    # Velocities of a pair that parts, and of a flock whose contacts chatter with hard jumps and rest with a ramp.
    law, q, p = parting_pair()
    end = final_components(observed(law, q, p, (0.0, 10.0)), law)
    hard_law = DeadZoneFlocking(DeadZoneInteraction(ramp=0.0))
    coarse, fine = _chatter(hard_law, 0.01), _chatter(hard_law, 0.002)
    q, p = _settled(law, 0.01)
    certificate = hold(law, q, p, 0.01).certificate
    state = observed(hard_law, [[0.0, 0.0], [5.0, 0.0]], np.zeros((2, 2)), (0.0, 200.0)).given
    return [
        limit_claim("printed", [], escape=end.separation, stated="all velocities match").described(
            detail=f"two agents that separate keep the velocity mismatch {end.drift:.4g} permanently"
        ),
        limit_claim("components", [], [settling(end)], detail="each of the two components is one agent"),
        of_map("chatter", 1.0 - fine / coarse, _SPREAD, computed=[coarse, fine]).described(
            stated="the scheme chatters, the less the shorter its step",
            detail=f"with the printed jumps √K̃ stays at {coarse:.3g} with a step of 0.01 and at {fine:.3g} with 0.002",
        ),
        by_count("sliding", int("sliding" not in state.stats)).described(
            stated="a pair at d1 is held there in a sliding mode", detail=f"with every switch located: {state.message}"
        ),
        limit_claim("ramp", [], [certificate]).described(
            computed=float(np.sqrt(spreads(p[None])[0] / len(p))), detail="with a ramp of 0.25 the mismatch vanishes"
        ),
    ]
