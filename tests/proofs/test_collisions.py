"""The proofs about collisions: what is false, or not certain, of a wrong constant is not called proved."""

from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest

pytest.importorskip("z3")  # the extra flockana[proofs]

import z3
from flint import arb, ctx
from scipy.linalg import expm

from flockana import scenario, simulate, verify
from flockana.certified.balls import AlphaParameters
from flockana.certified.scalar_functions_in_balls import c_star, far_potential
from flockana.environment.targets import LinearTarget, StaticTarget
from flockana.equilibria.energy_barrier import (
    bound_range,
    energy_floor,
    lattice_reach,
    least_infeasible_size,
    turan_pairs,
)
from flockana.equilibria.energy_barrier import largest_clique as numeric_clique
from flockana.interactions import AlphaInteraction, Gains
from flockana.lattice import hexagonal_spiral
from flockana.laws.algorithm3 import Algorithm3
from flockana.laws.olfati_saber import Algorithm1, Algorithm2
from flockana.measures.path_bounds import contacts
from proofs import barrier, collisions, distinct_pairs, n_max, point_ratios
from proofs.distinct_pairs import Start, crossings, free, is_the_scenario, onward, potential

SETS = {
    ("7", "8.4", "0.1", "0.2", "5", "5"): (23, 14),
    ("15", "18", "0.1", "0.1", "3", "3"): (26, 16),
    ("1.9", "2.8", "0.1", "0.4", "7", "9"): (11, 5),
    ("1.7", "2.5", "0.01", "0.2", "7", "15"): (12, 6),
}


@pytest.fixture(autouse=True)
def digits():
    with ctx.workdps(20):
        yield


@pytest.mark.parametrize(
    ("more", "gain", "holds"), [(1, collisions.C1, True), (2, collisions.C1, False), (1, 1, False)]
)
def test_an_energy_for_one_pair_more_lets_one_more_coincide_and_the_gain_counts(more, gain, holds):
    k = z3.Real("k")
    assert collisions.at_most(k, "at most k", budget=(k + more) * gain * collisions.C_STAR).holds is holds


def test_without_the_sign_of_the_other_pairs_nothing_follows(monkeypatch):
    unsigned = tuple(fact for fact in collisions.STATE if not fact.eq(collisions.REST >= 0))
    assert len(unsigned) == len(collisions.STATE) - 1
    monkeypatch.setattr(collisions, "STATE", unsigned)
    k = z3.Real("k")
    assert collisions.at_most(k, "x", budget=(k + 1) * collisions.C1 * collisions.C_STAR).holds is False


def test_the_crossings_of_the_erratum_are_enclosed():
    found = crossings(Start())
    case = scenario("three-agents-1d")
    run = simulate(case.law, case.q0, case.p0, (0.0, 0.03))
    met = {(c.i, c.j): c.time for c in contacts(run.t, run.q, run.p, run.u, tol=1e-8)}
    assert set(met) == {(0, 1), (0, 2)}
    for pair, enclosure in (((0, 1), found.first), ((0, 2), found.second)):
        assert enclosure.contains(arb(met[pair]))
        assert float(enclosure.rad()) < 1e-4
    assert [round(time, 5) for time in met.values()] == [0.00841, 0.02745]


def test_the_enclosed_energy_is_that_of_the_run():
    start = Start()
    case = scenario("three-agents-1d")
    assert float(start.energy()) == pytest.approx(float(case.law.structural_energy(case.q0, case.p0)), rel=1e-12)
    assert round(float(start.energy() / c_star(start.par)), 3) == 1.909
    assert is_the_scenario(start)
    assert not is_the_scenario(replace(start, boost="5.7"))
    assert not is_the_scenario(replace(start, c2_alpha="2"))


def test_another_target_law_or_time_is_another_run(monkeypatch):
    case = scenario("three-agents-1d")
    others = [
        replace(case, law=replace(case.law, target=StaticTarget((1.0,)))),
        replace(case, law=replace(case.law, target=LinearTarget((0.0,), (1.0,)))),
        replace(case, law=Algorithm3(case.law.alpha, case.law.gains, StaticTarget((0.0,)))),
        replace(case, t_span=(0.0, 0.01)),
    ]
    for other in others:
        monkeypatch.setattr(distinct_pairs, "scenario", lambda name, other=other: other)
        assert not is_the_scenario(Start())
    monkeypatch.setattr(distinct_pairs, "scenario", lambda name: case)
    assert is_the_scenario(Start())


@pytest.mark.parametrize(
    ("change", "first", "second"),
    [
        ({"boost": "3.9"}, False, False),  # ¼ of it is less than c* - ψ_α(r_α): no way through
        ({"c2_alpha": "20"}, True, False),  # through the first, with too little left for the second
        ({"positions": (-12, 0, 15)}, True, None),  # the third within range of the two: not certain, so not claimed
        ({"slack": "300"}, False, False),
    ],
)
def test_no_crossing_is_claimed_that_is_not_certain(change, first, second):
    found = crossings(replace(Start(), **change))
    assert (found.first is not None) is first
    assert (found.second is not None) is bool(second)


def test_agents_out_of_range_move_in_closed_form():
    start = replace(Start(), c1_gamma="2", c2_gamma="0.5")
    s, v = free((arb(3), arb(-1)), arb("0.7"), start)
    exact = expm(0.7 * np.array([[0.0, 1.0], [-2.0, -0.5]])) @ (3.0, -1.0)
    assert (float(s), float(v)) == pytest.approx(tuple(exact), abs=1e-13)


def test_a_step_encloses_time_and_energy_of_two_agents_alone():
    start = replace(Start(), c1_gamma="0.5", c2_gamma="0.3", c2_alpha="40")
    here = distinct_pairs.Passage(arb(-8), arb(0), potential(arb(-8), start) + 250000)  # w = 1000
    gains = Gains(c1_alpha=1.0, c2_alpha=40.0, c1_gamma=0.5, c2_gamma=0.3)
    law = Algorithm2(AlphaInteraction(a=5e4, b=5e4), gains, StaticTarget((0.0,)))
    run = simulate(law, [[-8.0], [0.0]], [[1000.0], [0.0]], (0.0, 1e-3), rtol=1e-11, atol=1e-9)
    x, w = (run.q[-1, 0, 0] - run.q[-1, 1, 0]), run.p[-1, 0, 0] - run.p[-1, 1, 0]
    pieces = 64
    for k in range(1, pieces + 1):
        here = onward(here, arb(-8) + (arb(x) + 8) * k / pieces, start)
    assert here.time.contains(arb(1e-3))
    assert float(here.time.rad()) < 2e-5
    assert (here.energy - potential(here.x, start)).contains(arb(w) ** 2 / 4)
    assert float(here.energy.rad()) < 1e-2 * float(here.energy.mid())


def test_the_pull_of_the_target_is_part_of_the_energy():
    start = replace(Start(), c1_gamma="900", c2_gamma="1e-9")
    here = distinct_pairs.Passage(arb(-30), arb(0), potential(arb(-30), start) + 250000)
    for k in range(1, 201):
        here = onward(here, arb(-30) + arb(k) / 10, start)
    x, w = free((arb(-30), arb(1000)), here.time, start)  # the difference moves as one agent does
    assert x.overlaps(arb(-10))
    assert w.overlaps(distinct_pairs.speed(here.energy, potential(here.x, start)))
    assert float(here.time.rad()) < 1e-4


def test_the_third_agent_must_be_out_of_range_of_both():
    start, pace = Start(), (arb(-30), arb(1700))
    assert distinct_pairs.passage(pace, (arb(0), arb(0)), (arb(20), arb(0)), -20, start)[-1][0].x == -20
    assert distinct_pairs.passage(pace, (arb(0), arb(0)), (arb(8), arb(0)), -20, start) == []
    assert distinct_pairs.passage(pace, (arb(0), arb(0)), (arb(-38), arb(0)), -20, start) == []


def test_the_two_separate_into_their_difference_and_sum():
    start = Start()
    state = distinct_pairs.Passage(arb(10), arb(0), potential(arb(10), start) + 250000)
    (q, p), (s, v) = distinct_pairs.separate(state, (arb(4), arb(1200)), start)
    assert [float(x) for x in (q, p, s, v)] == pytest.approx([7.0, 1100.0, -3.0, 100.0])


@pytest.mark.parametrize(("values", "sizes"), SETS.items(), ids=lambda value: "-".join(map(str, value)))
def test_the_proved_sizes_are_the_numeric_ones(values, sizes):
    par, alpha = AlphaParameters(*values), AlphaInteraction(*map(float, values))
    _, ratio = n_max.bound_lengths(par)
    assert f"for n >= {sizes[0]}" in n_max.every_state(par, 2, ratio).text
    assert f"an α-lattice of {sizes[1]} agents has V < c*" in n_max.every_lattice(par, 2).text
    assert (least_infeasible_size(alpha), lattice_reach(alpha)) == sizes
    assert f"an α-lattice of {lattice_reach(alpha, 1)} agents has V < c*" in n_max.every_lattice(par, 1).text
    shortest = n_max.shortest_bound(par)
    assert 0 < bound_range(alpha)[0] - float(shortest) < 1.001 / n_max.PARTS
    for m in (1, 2, 3):
        clique = point_ratios.largest_clique(ratio, m)
        assert clique == numeric_clique(alpha.r / bound_range(alpha)[0], m)
        for n in (clique, clique + 6, clique + 17, clique + 28):  # without whole numbers it is below Turán's count
            assert float(n_max.floor_of(n, clique, par)) <= energy_floor(alpha, n, m) * (1 + 1e-12)
            assert Fraction(n * n, 2 * clique) - Fraction(n, 2) <= n * (n - 1) // 2 - turan_pairs(n, clique)


def test_a_stronger_count_than_turan_is_refuted():
    assert n_max.missing("as it is").holds is True
    assert n_max.missing("one pair fewer", bound_to_all=1).holds is False


BEST = {  # m + 2 points of the least ratio: halves of a segment, a square, a triangle between two poles
    1: [[-1.0], [0.0], [1.0]],
    2: [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]],
    3: [[0.0, 0.0, 1.0], [0.0, 0.0, -1.0], [4 / 12**0.5, 0.0, 0.0], [-(3**-0.5), 1.0, 0.0], [-(3**-0.5), -1.0, 0.0]],
}


@pytest.mark.parametrize(("m", "square"), {1: 4, 2: 2, 3: Fraction(12, 7)}.items())
def test_the_least_ratio_of_points_is_attained(m, square):
    assert point_ratios.least_square(m) == square
    assert [step.holds for step in point_ratios.radon_points(m)] == [True, True, True]
    lengths = [np.linalg.norm(np.subtract(a, b)) for k, a in enumerate(BEST[m]) for b in BEST[m][:k]]
    assert len(BEST[m]) == m + 2
    assert max(lengths) / min(lengths) == pytest.approx(float(point_ratios.least_ratio(m + 2, m)), abs=1e-4)


def test_too_wide_a_range_of_lengths_is_not_decided():
    wide = AlphaParameters(h="0.9", r=14)  # a ratio above 2
    assert n_max.every_state(wide, 2, n_max.bound_lengths(wide)[1]).holds is None
    assert point_ratios.largest_clique(arb("1.41"), 2) == 3
    assert point_ratios.largest_clique(arb("1.415"), 2) == 5
    assert point_ratios.largest_clique(arb(2), 2) is None
    assert [point_ratios.largest_clique(arb(x), 1) for x in ("1.99", "2", "2.01")] == [2, 3, 3]
    assert point_ratios.largest_clique(arb("1.309"), 3) == 4
    assert point_ratios.largest_clique(arb("1.31"), 3) == numeric_clique(1.31, 3) == 17
    assert point_ratios.largest_clique(arb("inf"), 1) is None


def test_the_energies_of_lattices_are_those_of_the_kernels():
    par, alpha = AlphaParameters(), AlphaInteraction()
    for n in (7, 14, 19):
        energy = alpha.potential_energy(hexagonal_spiral(n, 7.0))
        assert float(n_max.lattice_energy(n, par)) == pytest.approx(energy, rel=1e-12)
    assert float(far_potential(par)) == pytest.approx(alpha.far_potential, rel=1e-14)


def test_claims_name_these_proofs():
    case = scenario("three-agents-1d")
    run = simulate(case.law, case.q0, case.p0, (0.0, 0.03))
    named = {claim.name: (claim.proof, claim.disproof) for claim in verify("E13", run).claims}
    assert named == {"printed": (None, "distinct-pairs"), "corrected": ("collisions", None)}
    other = simulate(case.law, case.q0, 1.01 * case.p0, (0.0, 0.03))
    assert verify("E13", other).claim("printed").disproof is None
    names = {claim.name: claim.proof for claim in verify("os-3", run).claims}
    assert (names["iv-printed"], names["iv-instant"], names["iv-none"]) == (None, "collisions", "collisions")


def test_the_induction_counts_what_the_library_counts(monkeypatch):
    assert barrier.counts_agree(30, 3)
    assert barrier.unbound(7, 3) == 21 - turan_pairs(7, 3) == 5
    monkeypatch.setattr(barrier, "turan_pairs", lambda n, clique: turan_pairs(n, clique) + 1)
    assert not barrier.counts_agree(30, 3)


def test_the_claim_below_the_barrier_names_its_proof():
    named = {}
    for law in (Algorithm1(), Algorithm1(AlphaInteraction(h=0.3))):
        run = simulate(law, [[0.0, 0.0], [7.0, 0.0]], [[0.0, 0.0], [0.0, 0.0]], (0.0, 0.2))
        named[law.alpha.h] = verify("os-1", run).claim("iii-barrier").proof
    assert named == {0.2: "barrier", 0.3: None}
