"""Tanner, Jadbabaie and Pappas (2007): potentials and velocity consensus along a fixed connected net."""

import numpy as np

from flockana.measures.nets import components
from flockana.sources.tanner_2007.laws import FixedNetFlocking
from flockana.sources.tanner_2007.theorems.common_claims import MATCHED, comes_to_rest, no_collision
from flockana.theorems.energy import balance
from flockana.theorems.theorem_toolkit import Checked, Observed, Tolerances, condition, law_is, run_theorem, unmet


@run_theorem(
    "tanner-fixed",
    title="A fixed connected net with potentials flocks",
    source="Tanner, Jadbabaie and Pappas 2007, on fixed networks",
    law=law_is("the law on a fixed net", FixedNetFlocking),
    claims=("energy", "no-collision", "velocities", "critical"),
    references=("tanner-2007",),
)
def theorem(seen: Observed, tolerances: Tolerances) -> Checked:
    """Let agents steer by u_i = -Σ (p_i - p_j) - Σ ∇V_ij over their neighbours in a fixed connected net, V being
    unbounded at contact and at infinity, with one minimum. Then velocities become the same, neighbours do not collide,
    and the flock tends to a state in which no force acts: the total potential is extremal. (The paper says that the
    potentials of all agents are minimised: erratum tanner-minimum.)
    """
    edges = np.array(seen.law.edges, dtype=np.int32).reshape(-1, 2)
    parts = 1 + int(components(seen.n, edges).max())
    if unmet(requirements := [condition("the net is connected", parts == 1, 1.5 - parts, f"{parts} component(s)")]):
        return requirements, []
    return requirements, [
        balance(seen, requirements, tolerances, name="energy", proof="tanner"),
        no_collision(seen, edges[:, 0], edges[:, 1], "tanner", requirements),
        *comes_to_rest(seen, requirements, ("velocities", "critical"), forces=MATCHED),
    ]
