"""The bearing-distance Theorem 1 as printed and as corrected, on runs that meet its hypotheses and runs that do not."""

import numpy as np
import pytest

from flockana import Algorithm2, MinimalFlocking, StaticTarget, Tolerances, simulate, theorem, verify
from flockana.measures.perception import both_ways, edge_vectors, random_out_tree
from flockana.sources.jond_2025.theorems import theorem_1_corrected as zone_1_corrected
from flockana.sources.jond_2025.theorems.tree_case import characteristic_residual, tree_case
from flockana.sources.jond_2025.theorems.tree_limits import edge_shares, state
from flockana.sources.jond_2025.theorems.tree_spectrum import Spectrum
from flockana.theorems.observed_run import Observed
from tests.theorems.made_up import statuses

TREE = ((0, 1), (1, 2), (1, 3), (0, 4))
CORRECTED = ("lengths", "velocities", "spectrum", "exponential", "root-edge", "energy", "no-collision")


def run_on(edges, *, m=2, seed=0, end=80.0, size=2.0, speed=0.5, **options):
    law = MinimalFlocking(edges=edges, **({"spacing": 1.0} | options))
    n = 1 + max(map(max, edges))
    rng = np.random.default_rng(seed)
    return simulate(law, rng.uniform(-size, size, (n, m)), rng.uniform(-speed, speed, (n, m)), (0.0, end))


def claim_of(name, run, claim):
    return next(c for c in theorem(name).examine(Observed.of(run), Tolerances())[1] if c.name == claim)


@pytest.fixture(scope="module")
def directed():
    return run_on(TREE)


@pytest.fixture(scope="module")
def undirected():
    return run_on(both_ways(TREE), normalised=False)


def test_as_printed_it_is_refuted_with_its_counterexample(directed):
    verdict = verify("zone-1-printed", directed)
    assert verdict.status == "refuted"
    wrong = dict.fromkeys(("equilibrium", "edges", "hurwitz"), "refuted")
    assert statuses(verdict) == wrong | {"velocities": "verified"}
    assert all(h.status == "met" for h in verdict.hypotheses)
    # the witness, run anew, stays where it is, with every edge one unit long
    q = np.array(verdict.claim("equilibrium").witness["q"])
    again = simulate(directed.law, q, 0.0 * q, (0.0, 50.0))
    assert np.abs(again.q - q).max() < 1e-9
    np.testing.assert_allclose(np.linalg.norm(edge_vectors(again.q[-1], TREE), axis=1), 1.0, atol=1e-9)


def test_a_limit_is_not_refuted_before_the_certificate_bites():
    """At the start V is far above μρ²/2 on both edges from the root: no bound, and no verdict on the limit."""
    run = run_on(TREE, end=0.1, size=9.0)
    assert edge_shares(tree_case(run.law, 5), state(run.q[-1], run.p[-1])).min() > 1.0
    assert verify("zone-1-printed", run).claim("edges").status == "inconclusive"
    assert verify("zone-1-corrected", run).claim("lengths").status == "inconclusive"


@pytest.mark.parametrize(("m", "seed"), [(1, 0), (2, 1), (3, 2)])
def test_as_corrected_it_holds_on_directed_trees(m, seed):
    run = run_on(random_out_tree(6, np.random.default_rng(seed)), m=m, seed=seed, end=100.0, mu=1.3)
    verdict = verify("zone-1-corrected", run)
    assert verdict.status == "verified"
    assert verdict.claim("spectrum").computed["zero modes"] == 5 * (m - 1)
    assert verdict.claim("lengths").computed < 1e-6


def test_as_corrected_it_holds_on_undirected_trees(undirected):
    verdict = verify("zone-1-corrected", undirected)
    assert verdict.status == "verified"
    assert verdict.claim("energy").computed <= 0.0
    assert verdict.claim("spectrum").computed["zero modes"] == 4
    assert verify("zone-1-printed", undirected).status == "vacuous"


@pytest.mark.parametrize(
    ("options", "missing"),
    [
        ({"edges": ((0, 2), (1, 2), (3, 2), (4, 2))}, "the graph is a spanning tree"),  # an in-tree: nobody reaches all
        ({"edges": ((0, 1), (1, 2), (2, 0), (0, 3), (0, 4))}, "the graph is a spanning tree"),
        ({"edges": both_ways(TREE)}, "the graph is a spanning tree"),  # means: not reciprocal
        ({"edges": TREE, "mu": 0.0}, "μ > 0"),
        ({"edges": TREE, "sigma": 0.0}, "alignment weights are positive"),
    ],
)
def test_what_is_not_met_makes_it_vacuous(options, missing):
    verdict = verify("zone-1-corrected", run_on(**options, end=1.0))
    assert verdict.status == "vacuous"
    assert [h.name for h in verdict.hypotheses if h.status == "unmet"] == [missing]


def test_a_perceived_graph_may_change_and_another_law_is_another_law(directed):
    start = directed.q[0], directed.p[0], (0.0, 1.0)
    verdict = verify("zone-1-corrected", simulate(MinimalFlocking(3.0), *start))
    assert verdict.status == "vacuous"
    assert verdict.hypotheses[1].detail == "perceived"
    other = simulate(Algorithm2(target=StaticTarget((0.0, 0.0))), *start)
    for name in ("zone-1-printed", "zone-1-corrected"):
        assert verify(name, other).status == "vacuous"
    assert {c.name for c in verify("zone-1-corrected", other).claims} == set(CORRECTED)


def test_another_spectrum_contradicts_its_proof_and_leaves_the_rate_open(directed, monkeypatch):
    monkeypatch.setattr(zone_1_corrected, "tree_spectrum", lambda case, q: Spectrum(5, 0.5, 0.0, -1.0, 1e-9))
    spectrum = claim_of("zone-1-corrected", directed, "spectrum")
    assert (spectrum.status, spectrum.contradicts) == ("inconclusive", "bearing-distance")
    assert "at fault" in spectrum.detail
    assert claim_of("zone-1-corrected", directed, "exponential").status == "inconclusive"


def test_the_rate_is_half_the_slowest_of_the_spectrum(directed):
    """s² + s + 1: ½; it follows once the flock certainly settles, and not before."""
    claim = claim_of("zone-1-corrected", directed, "exponential")
    assert (claim.status, claim.about, claim.computed) == ("verified", "limit", pytest.approx(0.5))
    assert claim_of("zone-1-corrected", run_on(TREE, end=0.1, size=9.0), "exponential").status == "inconclusive"


def test_a_wrong_energy_is_caught(monkeypatch):
    right = MinimalFlocking.hamiltonian

    def wrong(self, t, q, p):
        kinetic = 0.5 * float(np.sum((p - p.mean(axis=0)) ** 2))
        return kinetic + 1.01 * (right(self, t, q, p) - kinetic)

    monkeypatch.setattr(MinimalFlocking, "hamiltonian", wrong)
    run = run_on(both_ways(TREE), normalised=False)
    claim = verify("zone-1-corrected", run).claim("energy")
    assert (claim.status, claim.contradicts) == ("inconclusive", "bearing-distance")
    line = run_on(both_ways(TREE), normalised=False, m=1)  # of which the proof says nothing
    assert verify("zone-1-corrected", line).claim("energy").status == "refuted"


def test_characteristic_residual_tells_polynomials_apart():
    A = np.array([[0.0, 1.0], [-2.0, -3.0]])
    assert characteristic_residual(A, [(3.0, 2.0)]) < 1e-14
    assert characteristic_residual(A, [(3.0, 2.001)]) > 1e-6
    assert characteristic_residual(A, [(0.0, 2.0)]) > 0.1  # of the same determinant
