"""Erratum J6: which trees are run, and that one claim stands for all of the corrected theorem."""

from types import SimpleNamespace

import numpy as np
import pytest

from flockana.measures.perception import both_ways
from flockana.sources.jond_2025.laws.minimal import MinimalFlocking
from flockana.sources.jond_2025.theorems import j06_corrected_theorem as j06
from flockana.theorems import Claim, Tolerances, theorem

TREE = ((0, 1), (1, 2), (1, 3), (0, 4))
LAWS = {
    "directed": MinimalFlocking(edges=TREE, spacing=(1.0, 1.5, 2.0, 1.0, 1.2), mu=2.0),
    "undirected": MinimalFlocking(edges=both_ways(TREE), spacing=1.5, normalised=False),
}
CASES = [("directed", 2), ("directed", 3), ("undirected", 2), ("undirected", 3)]


def corrected(statuses, modes):
    named = [Claim(f"c{k}", status) for k, status in enumerate(statuses)]
    computed = None if modes is None else {"zero modes": modes}
    claims = (*named, Claim("lengths", "verified", detail="as long"), Claim("spectrum", "verified", computed=computed))
    return SimpleNamespace(id="made-up", examine=lambda seen, tolerances: ((), claims))


@pytest.mark.parametrize(
    ("statuses", "status"),
    [((), "verified"), (("vacuous",), "verified"), (("refuted", "verified"), "refuted"),
     (("inconclusive", "verified"), "inconclusive")],
)  # fmt: skip
@pytest.mark.parametrize("modes", [4, None])
def test_one_claim_stands_for_all(monkeypatch, statuses, status, modes):
    runs = []

    def noted(*given):
        runs.append(given)
        return SimpleNamespace(doubt="", unresolved="", is_map=False)

    monkeypatch.setattr(j06, "observed", noted)
    monkeypatch.setattr(j06, "zone_1_corrected", SimpleNamespace(theorem=corrected(statuses, modes)))
    claims = theorem("J6").examine(Tolerances())[1]
    assert [claim.name for claim in claims] == [f"{name}-{m}" for name, m in CASES]
    for claim, (law, q, p, span), (name, m) in zip(claims, runs, CASES, strict=True):
        rng = np.random.default_rng(m)
        np.testing.assert_array_equal(q, rng.uniform(-2.0, 2.0, (5, m)))
        np.testing.assert_array_equal(p, rng.uniform(-0.5, 0.5, (5, m)))
        assert span == (0.0, 80.0)
        assert law == LAWS[name]
        assert claim.status == status
        assert claim.computed["spectrum"] == "verified"
        assert claim.stated == f"every claim of zone-1-corrected, with {4 * (m - 1)} zero modes"
        assert claim.witness == {"edges": TREE, "q(0)": q.tolist(), "p(0)": p.tolist()}
        assert claim.detail == f"{name} tree of five in {m} dimensions: as long; {modes or 'no'} zero modes"
