"""J6: the corrected Theorem 1 holds on a directed and on an undirected tree, in the plane and in space."""

import numpy as np

from flockana.measures.perception import both_ways
from flockana.sources.jond_2025.laws.minimal import MinimalFlocking
from flockana.sources.jond_2025.theorems import theorem_1_corrected as zone_1_corrected
from flockana.theorems.claims import counted, erratum
from flockana.theorems.observed_run import observed, with_resolution
from flockana.theorems.theorem import Claim, Tolerances, Verdict

_TREE = ((0, 1), (1, 2), (1, 3), (0, 4))


def _on_run(name: str, law: MinimalFlocking, m: int, tolerances: Tolerances) -> Claim:
    """Return one claim that the corrected Theorem 1 holds in a run of a five-agent tree in m dimensions."""
    corrected, rng = zone_1_corrected.theorem, np.random.default_rng(m)
    q, p = rng.uniform(-2.0, 2.0, (5, m)), rng.uniform(-0.5, 0.5, (5, m))
    observation = observed(law, q, p, (0.0, 80.0))
    verdict = Verdict(corrected.id, *with_resolution(*corrected.examine(observation, tolerances), observation))
    statuses = [claim.status for claim in verdict.claims]
    refuted_count, zeros = statuses.count("refuted"), (verdict.claim("spectrum").computed or {}).get("zero modes", "no")
    return counted(f"{name}-{m}", 0, refuted_count, refuted_count + statuses.count("inconclusive")).described(
        computed={claim.name: claim.status for claim in verdict.claims},
        stated=f"every claim of zone-1-corrected, with {4 * (m - 1)} zero modes",
        witness={"edges": _TREE, "q(0)": q.tolist(), "p(0)": p.tolist()},
        detail=f"{name} tree of five in {m} dimensions: {verdict.claim('lengths').detail}; {zeros} zero modes",
    )


@erratum(
    "J6",
    title="Theorem 1 as it can be saved",
    expected={"verified": "directed-2 directed-3 undirected-2 undirected-3"},
    author="corrected",
)
def theorem(tolerances: Tolerances) -> list[Claim]:
    """On frozen rooted out-trees with constant spacings, and on undirected trees with the reciprocal law, the edges
    take their desired lengths and velocities match, exponentially near a normally hyperbolic manifold of equilibria
    with (n - 1)(m - 1) zero modes.
    """
    # Theorem zone-1-corrected on runs of a directed and of an undirected tree of five, in the plane and in space.
    laws = {
        "directed": MinimalFlocking(edges=_TREE, spacing=(1.0, 1.5, 2.0, 1.0, 1.2), mu=2.0),
        "undirected": MinimalFlocking(edges=both_ways(_TREE), spacing=1.5, normalised=False),
    }
    return [_on_run(name, law, m, tolerances) for name, law in laws.items() for m in (2, 3)]
