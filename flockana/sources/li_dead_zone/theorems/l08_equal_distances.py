"""Erratum L8: not all pairs of a flock can have one distance, and contacts sit at r_b - δ, not at r_b."""

from flockana.sources.li_dead_zone.interactions import DeadZoneInteraction
from flockana.sources.li_dead_zone.theorems.common_claims import PROOF
from flockana.theorems.theorem_toolkit import Claim, Tolerances, erratum, exact, spectral

_ROUNDING = 1e-11  # m: of the root of a force


@erratum("L8", expected={"refuted": "printed balance-distance", "verified": "contact"})
def theorem(tolerances: Tolerances) -> list[Claim]:
    """All pairs at one distance d is impossible for n > 3 in the plane. Contacts sit where repulsion ends, at r_b - δ,
    not at the balance distance r_b.
    """
    # n equidistant points span n − 1 dimensions; and two agents rest at d1, not at r_b.
    import sympy as sp
    from scipy.optimize import brentq

    rank = (sp.eye(3) / 2 + sp.ones(3, 3) / 2).rank()  # Gram matrix of q_k − q_0 over d², k = 1, 2, 3: no rounding
    pair = DeadZoneInteraction()
    contact = float(brentq(pair.force, pair.d1 - pair.ramp, pair.d1))
    off_r_b, off_d1 = (abs(contact - at) / pair.ramp for at in (pair.r_b, pair.d1))
    return [
        exact("printed", rank <= 2, disproof=PROOF, computed=rank).described(
            stated="all pairs of a flock at distance d",
            detail=f"four points at equal distances have a Gram matrix of rank {rank}, but the plane has 2 dimensions",
        ),
        spectral("balance-distance", 1.0 - off_r_b, _ROUNDING / pair.ramp, disproof=PROOF, computed=contact).described(
            stated="r_b", detail=f"two agents rest {contact:.5g} apart, not at the balance distance r_b = {pair.r_b:g}"
        ),
        spectral("contact", 1.0 - off_d1, _ROUNDING / pair.ramp, computed=contact, stated="r_b - δ").described(
            detail=f"two agents rest {pair.d1 - contact:.2g} below r_b - δ = {pair.d1:g}, on the ramp of repulsion"
        ),
    ]
