"""Erratum J4: two wrong signs on the way to (34) cancel, and the closed loop holds D_in Dᵀ, not D Dᵀ."""

import numpy as np

from flockana.measures.perception import edge_vectors, incidence, receivers
from flockana.sources.jond_2025.laws.minimal import MinimalFlocking
from flockana.theorems.theorem_toolkit import Claim, Tolerances, equal, erratum, of_state

_TREE = ((0, 1), (1, 2), (1, 3), (0, 4))
_PROOF = "bearing-distance-printed"
_SAME, _ROUNDING = 1e-9, 1e-13  # relative: forces that differ by less are the same; their rounding


def _identity(name: str, stated: str, detail: str, **backed: str) -> Claim:
    """Return the claim that an identity of separation forces holds on a directed tree of five, by algebra."""
    from flockana.sources.jond_2025.symbolic.spanning_trees import separation_forms

    residuals = separation_forms(_TREE)[name].residuals
    return equal(name, residuals, stated=stated, detail=detail, **backed)


def _loop() -> Claim:
    """Return the claim that the closed loop (35) agrees with the law for D_in Dᵀ, and not for D Dᵀ."""
    rng = np.random.default_rng(0)
    q, p = rng.uniform(-3.0, 3.0, (5, 2)), rng.uniform(-1.0, 1.0, (5, 2))
    law = MinimalFlocking(edges=_TREE, spacing=1.3, mu=0.7)
    D, D_in = incidence(5, _TREE), receivers(5, _TREE)
    w = 0.7 * (1.0 - 1.3 / np.linalg.norm(edge_vectors(q, _TREE), axis=1))
    u = law.acceleration(0.0, q, p)
    # W^a = I on a tree
    error, undirected = (float(np.abs(-L * w @ D.T @ q - L @ D.T @ p - u).max()) for L in (D_in, D))
    return of_state("loop", _SAME - error / float(np.abs(u).max()), _ROUNDING, computed=error).described(
        stated="u = -D_in W^s Dᵀ p - D_in W^a Dᵀ v, with D_in where the text says 'like the incidence matrix'",
        witness={"with D in place of D_in": undirected},
        detail=f"(35) with D_in agrees with the law to {error:.1g}; with D, as L = D Dᵀ would have it, it is off by "
        f"{undirected:.3g}",
    )


@erratum("J4", expected={"refuted": "28 identity", "verified": "34 loop"}, corrected=("loop",))
def theorem(tolerances: Tolerances) -> list[Claim]:
    """(28) adds q where it must be subtracted, and the identity before (34) has the sign of q wrong as well: together
    they cancel, and (34), (35) are right. L = D Dᵀ is the undirected Laplacian; the loop holds D_in Dᵀ, where D_in
    keeps the receivers' entries alone.
    """
    signs = "(28) as printed has the wrong sign before q", "the identity before (34) has the wrong sign, too"
    return [
        _identity("28", "separation = -(d W Dᵀ) p + (d W) q", signs[0], disproof=_PROOF),
        _identity("identity", "(d W) q = α r (d W W^q Dᵀ) p", signs[1], disproof=_PROOF),
        _identity("34", "separation = -(d W (I - α r W^q) Dᵀ) p", "the two errors cancel: (34) is right", proof=_PROOF),
        _loop(),
    ]
