"""Erratum L4: nothing keeps the flock together: two agents may separate, and wide starts do not connect."""

import numpy as np

from flockana.measures.metrics import connectivity, min_distance
from flockana.sources.li_dead_zone.laws.dead_zone import DeadZoneFlocking
from flockana.sources.li_dead_zone.theorems.common_claims import PROOF, final_components
from flockana.sources.li_dead_zone.theorems.shared_runs import advance, parting_pair
from flockana.theorems.random_start_shares import INTERVAL_ERROR, interval
from flockana.theorems.theorem_toolkit import Claim, Tolerances, erratum, limit_claim, observed, of_map

_SEEDS = 10  # of each box


def connected_count(box: float, *, seeds: int, n: int = 50, t_end: float = 60.0) -> int:
    """Return the number of seeds from which a flock ends connected, with q(0) uniform in [0, box]²."""
    law, count = DeadZoneFlocking(), 0
    for seed in range(seeds):
        generator = np.random.default_rng(seed)
        q, p = generator.uniform(0.0, box, (n, 2)), generator.uniform(-1.0, 1.0, (n, 2))
        count += connectivity(advance(law, q, p, 0.01, t_end)[0], law.interaction.r) == 1.0
    return count


@erratum("L4", expected={"refuted": "printed", "verified": "wide-starts"}, ours=("wide-starts",))
def theorem(tolerances: Tolerances) -> list[Claim]:
    """No leader appears in (9), and nothing keeps the net connected: two agents 14 m apart that leave each other at 12
    m/s separate, and from wide starts the share of connected flocks falls towards 0.
    """
    # Check a pair of agents that separates, and the share of flocks that end connected by the width of their start.
    law, q, p = parting_pair()
    observation = observed(law, q, p, (0.0, 10.0))
    end = final_components(observation, law)
    narrow, wide = (connected_count(box, seeds=_SEEDS) for box in (40.0, 150.0))
    smallest, maximum = interval(narrow, _SEEDS)[0], interval(wide, _SEEDS)[1]
    radius = 0.5 * min_distance(observation.end.q)
    return [
        limit_claim("printed", [], escape=end.separation, disproof=PROOF, computed=radius).described(
            stated="no agent farther than r from the leader",
            detail=f"two agents {q[1, 0]:g} apart that leave each other at {2.0 * p[1, 0]:g} separate: at t = 10 "
            f"they are {radius:.4g} from their centre",
        ),
        of_map("wide-starts", smallest - maximum, INTERVAL_ERROR, computed=[narrow, wide]).described(
            stated="the share of connected flocks falls with the box",
            detail=f"of {_SEEDS} starts in a box of 40 m {narrow} end connected, of {_SEEDS} in one of 150 m {wide}: "
            f"shares of at least {smallest:.2f} and at most {maximum:.2f} (95 %)",
        ),
    ]
