"""Theorem 5 on lattices, on nets that are none, and on the ends of runs."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from flockana import Algorithm1, Law, Tolerances, lattice, simulate, verify
from flockana.sources.olfati_saber_2006.theorems import theorem_5_planar_nets as os_5
from flockana.sources.olfati_saber_2006.theorems.theorem_5_planar_nets import CLAIMS, Net, uncrossed
from flockana.theorems.theorem import Hypothesis
from tests.theorems.made_up import statuses

D, R = 7.0, 8.4


def expected(**found: str) -> dict[str, str]:
    """All claims are vacuous but those given; an underscore stands for a hyphen."""
    return dict.fromkeys(CLAIMS, "vacuous") | {name.replace("_", "-"): status for name, status in found.items()}


PLANE = expected(
    i="verified", i_graph="verified", ii="verified", ii_sharp="verified", iii="verified",
    extension="verified", extension_lengths="verified", extension_links="verified",
)  # fmt: skip


@pytest.mark.parametrize("q", [lattice.hexagonal_spiral(37, D), lattice.square(5, 6, D), lattice.honeycomb(3, 4, D)])
def test_planar_lattices(q):
    verdict = verify("os-5", q=q, d=D, r=R)
    assert statuses(verdict) == PLANE
    assert verdict.status == "verified"
    assert all(h.status == "met" for h in verdict.hypotheses)


SPACE = lattice.fcc(2, 2, 2, D), lattice.hcp(3, 2, 2, D), lattice.simple_cubic(3, 3, 3, D)


@pytest.mark.parametrize(("q", "kappa"), [*((q, 1.2) for q in SPACE), (lattice.bcc(3, 3, 3, D), 1.1)])
def test_in_space_edges_do_not_cross_whatever_the_graph(q, kappa):
    true = dict.fromkeys(("i", "iii", "extension", "extension-lengths"), "verified")
    assert statuses(verify("os-5", q=q, d=D, r=kappa * D)) == expected(i_graph="refuted") | true


def test_on_a_line_only_iii_and_the_extension_speak():
    said = expected(extension="verified", extension_lengths="verified")
    assert statuses(verify("os-5", q=lattice.line(5, D), d=D, r=R)) == said | {"iii": "verified"}
    assert statuses(verify("os-5", q=lattice.line(2, D), d=D, r=R)) == said


@pytest.mark.parametrize(("n", "iii"), [(3, "vacuous"), (4, "verified")])
def test_iii_needs_more_than_a_simplex(n, iii):
    verdict = verify("os-5", q=lattice.hexagonal_spiral(n, D), d=D, r=R)
    assert verdict.claim("iii").status == iii
    if n == 4:
        assert verdict.claim("iii").computed == 1
        i, j = verdict.claim("iii").witness
        assert [min(i, j), max(i, j)] not in lattice.links(lattice.hexagonal_spiral(4, D), R).tolist()


def test_ii_needs_three_agents_and_says_so():
    verdict = verify("os-5", q=lattice.hexagonal_spiral(2, D), d=D, r=R)
    claim = verdict.claim("ii")
    assert (claim.status, claim.computed, claim.margin) == ("vacuous", 1, -0.5)
    assert verdict.claim("ii-sharp").status == "verified"


def test_margins_are_the_distances_from_the_bounds():
    verdict = verify("os-5", q=lattice.hexagonal_spiral(20, D), d=D, r=R)
    assert verdict.claim("ii").margin == 54 - lattice.harborth(20) + 0.5
    assert verdict.claim("ii-sharp").margin == 0.5
    by_name, apart = {h.name: h.margin for h in verdict.hypotheses}, "all pairs are farther apart than "
    assert by_name["κ = r/d > 1"] == pytest.approx(0.2)
    assert by_name[f"{apart}r/√2"] == pytest.approx(7.0 - 8.4 / np.sqrt(2.0))
    assert by_name[f"{apart}ℓ/√2, ℓ the longest link"] == pytest.approx(7.0 - 7.0 / np.sqrt(2.0))


def test_a_strained_lattice_leaves_the_printed_theorem_vacuous_and_the_extension_not():
    q = lattice.hexagonal_spiral(37, D) + np.random.default_rng(0).uniform(-0.2, 0.2, (37, 2))
    verdict = verify("os-5", q=q, d=D, r=R)
    assert statuses(verdict) == expected(extension="verified", extension_lengths="verified", extension_links="verified")
    unmet = [h for h in verdict.hypotheses if h.status == "unmet"]
    assert [h.name for h in unmet] == ["q is an α-lattice"]
    assert unmet[0].detail.startswith("quasi-α-lattice")
    assert verify("os-5", q=q, d=D, r=R, tolerances=Tolerances(lattice=0.1)).claim("i").status == "verified"


def test_a_square_with_its_diagonals_is_the_limit_case_of_the_quantitative_form():
    verdict = verify("os-5", q=lattice.square(2, 2, D), d=D, r=1.5 * D)
    claim = verdict.claim("extension-quantitative")
    assert statuses(verdict) == expected(extension_quantitative="verified")
    assert claim.margin == 1.0  # none of the pairs fails
    assert "closer than ℓ/√2 by" in claim.detail
    assert sorted(map(sorted, claim.witness)) == [[0, 3], [1, 2]]
    assert verdict.claim("i").computed == 1


def test_coincident_agents_are_not_distinct():
    q = np.concatenate([lattice.hexagonal_spiral(7, D), [[0.0, 0.0]]])
    verdict = verify("os-5", q=q, d=D, r=R)
    unmet = [h.name for h in verdict.hypotheses if h.status == "unmet"]
    assert unmet[:2] == ["distinct positions", "q is an α-lattice"]
    assert statuses(verdict) == expected(extension_quantitative="verified")


def test_the_crossings_of_a_collapsed_flock_are_counted_in_full():
    q = np.random.default_rng(0).normal(size=(40, 2))
    verdict, count = verify("os-5", q=q, d=D, r=R), len(lattice.crossings(q, lattice.links(q, R)))
    assert count > 10_000
    for name in ("i", "extension", "extension-lengths", "extension-quantitative"):
        assert verdict.claim(name).computed == count
    assert f"{count} pairs of 780 links cross" in verdict.claim("extension-quantitative").detail
    assert verdict.claim("extension-quantitative").status == "verified"
    assert verdict.claim("iii").status == "vacuous"


def test_more_crossings_than_are_listed_are_said_to_be_at_least_so_many(monkeypatch):
    monkeypatch.setattr(os_5, "LISTED", 100)
    verdict = verify("os-5", q=np.random.default_rng(0).normal(size=(40, 2)), d=D, r=R)
    for name in ("i", "extension", "extension-quantitative"):
        assert verdict.claim(name).computed == "at least 100"
    assert "at least 100 pairs of 780 links cross" in verdict.claim("extension-quantitative").detail


@pytest.mark.slow
@given(st.integers(0, 2**32 - 1), st.sampled_from([1, 2, 3]))
def test_the_quantitative_form_is_decided_as_by_fractions(seed, m):
    """Every pair of links that cross, of nets on a grid where ℓ = √2 times the least distance happens often."""
    rng = np.random.default_rng(seed)
    q = rng.integers(0, 4, (9, m)) * D / 3.0
    net = os_5.Net(q, D, R)
    longest, shortest = os_5.crossing_lengths(net)
    exact = [os_5.holds_exactly(net, net.links[pair]) for pair in net.crossings]
    assert all(exact)
    assert (longest - 2.0 * shortest >= -1e-12 * longest).all()


def test_in_space_only_a_clearance_above_rounding_is_believed():
    """Two links of 7 within 1e-14 of each other: nobody knows whether they cross."""
    q = D * np.array([[-0.5, 0.0, 0.0], [0.5, 0.0, 0.0], [0.0, -0.5, 1e-14], [0.0, 0.5, 1e-14]])
    net = Net(q, D, R)
    assert len(net.crossings) == 0
    open_ = Hypothesis("the proof applies", "assumed")  # so that numbers alone decide
    assert uncrossed(net, [open_], "i").status == "inconclusive"
    q[3, 2] = q[2, 2] = 1e-3
    assert uncrossed(Net(q, D, R), [open_], "i").status == "verified"
    q[2:, 2] = 0.0
    claim = uncrossed(Net(q, D, R), [], "i")
    assert (claim.margin, claim.contradicts) == (-1.0, "theorem5-crossings")


def test_a_run_is_judged_by_its_last_state():
    q0 = lattice.hexagonal_spiral(7, D) + np.random.default_rng(1).uniform(-0.3, 0.3, (7, 2))
    run = simulate(Algorithm1(), q0, np.zeros_like(q0), (0.0, 20.0))
    verdict = verify("os-5-terminal", run)
    assert statuses(verdict) == statuses(verify("os-5", q=run.q[-1], d=D, r=R)) == PLANE
    assert verdict.claim("i").error > 0.0
    early = statuses(verify("os-5-terminal", run.window(0.0, 0.01)))
    assert early == expected(extension="verified", extension_lengths="verified", extension_links="verified")


def test_a_law_without_a_range():
    class Free(Law):
        """No interaction."""

        def flow(self, t, q, p):
            return np.zeros_like(q), float("nan")

    verdict = verify("os-5-terminal", simulate(Free(), np.zeros((2, 2)), np.ones((2, 2)), (0.0, 1.0)))
    assert statuses(verdict) == expected()
    assert verdict.hypotheses[0].detail == "Free"


@pytest.mark.parametrize(("r", "status"), [(D, "unmet"), (np.nextafter(D, 8.0), "met"), (0.9 * D, "unmet")])
def test_the_ratio_is_above_one(r, status):
    need = next(h for h in verify("os-5", q=[[0.0, 0.0], [D, 0.0]], d=D, r=r).hypotheses if h.name.startswith("κ"))
    assert (need.status, need.margin) == (status, pytest.approx(r / D - 1.0, abs=1e-15))
