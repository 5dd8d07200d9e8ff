"""Levels in balls: those of the counts in floating point, with nothing left to a slack."""

import numpy as np
import pytest
from flint import arb, ctx

import flockana as fl
from flockana import Algorithm1, AlphaInteraction, Gains
from flockana.certified import energies_in_balls as levels
from flockana.certified.pair_laws_in_series import PairNumbers
from flockana.certified.structural_energy import gain, structural_energy
from flockana.equilibria.energy_barrier import coincident_lattice, collision_bounds
from flockana.sources.olfati_saber_2006.theorems.any_potential import disconnected_energy

LONG = AlphaInteraction(r=9.8)  # κ = 1.4: cliques of 4 in the plane


@pytest.mark.parametrize(("alpha", "m"), [(AlphaInteraction(), 2), (AlphaInteraction(), 1), (LONG, 2), (LONG, 3)])
def test_the_balls_are_about_the_bounds_in_floating_point(alpha, m):
    low, high = collision_bounds(alpha, 7, m)
    floor, state = levels.coincident_floor(alpha, 7, m), levels.coincident_state(alpha, 7, m)
    assert abs(floor - arb(low)) < 1e-12 * low
    assert abs(state - arb(high)) < 1e-12 * high
    assert floor.rad() < 1e-20


def test_a_state_left_behind_has_the_energy_of_its_lattice_and_none_where_there_is_none():
    law = Algorithm1(gains=Gains(c1_alpha=3.0, c2_alpha=1.0))
    for n, m in ((7, 2), (4, 1), (5, 3)):
        ball = gain(law) * levels.disconnected_state(law.alpha, n, m)
        stated = disconnected_energy(law, n, m)
        assert abs(ball - arb(stated)) < 1e-12 * stated
    assert levels.disconnected_state(AlphaInteraction(r=12.2), 7, 2) is None  # κ > √3
    assert levels.disconnected_state(AlphaInteraction(r=12.1), 7, 2) is not None


HEAVY = Algorithm1(alpha=AlphaInteraction(unit=2.0), gains=Gains(c1_alpha=3.0, c2_alpha=1.0))
WEAK = AlphaInteraction(d=1.0, r=10.0)  # what holds a pair out to r costs more than what keeps it apart


def test_a_unit_of_length_counts_twice():
    """V with its gain is the energy of the law at the same state, in any unit."""
    assert gain(HEAVY) == 3
    q = coincident_lattice(HEAVY.alpha, 5, 2)
    found = gain(HEAVY) * levels.coincident_state(HEAVY.alpha, 5, 2)
    assert float(found) == pytest.approx(HEAVY.structural_energy(q, np.zeros_like(q)), rel=1e-12)


@pytest.mark.parametrize("n", [2, 9])
def test_where_pairs_cost_more_apart_than_together_only_the_coincident_pair_counts(n):
    with ctx.workprec(100):
        pair = PairNumbers.of_alpha(WEAK)
        assert pair.c_star < pair.far
        assert levels._shortest_bound(WEAK) is None
        assert levels._largest_clique(WEAK, 2) is None
        assert levels.coincident_floor(WEAK, n, 2).overlaps(pair.c_star)


@pytest.mark.parametrize("r", [7.5, 8.4, 12.0, 16.0, 18.0])
def test_below_the_shortest_length_of_a_bound_pair_a_pair_costs_more_than_one_apart(r):
    with ctx.workprec(100):
        pair, shortest = PairNumbers.of_alpha(AlphaInteraction(r=r)), levels._shortest_bound(AlphaInteraction(r=r))
        if shortest is None:
            assert not pair.c_star > pair.far
            return
        assert pair.potential(arb(shortest) ** 2) > pair.far
        assert pair.potential((arb(shortest) + arb("1e-9")) ** 2) < pair.far


def ratio_of(points):
    """The longest distance over the shortest."""
    i, j = np.triu_indices(len(points), 1)
    lengths = np.linalg.norm(np.asarray(points)[j] - np.asarray(points)[i], axis=1)
    return lengths.max() / lengths.min()


def ring(k, *more):
    return [*([np.cos(a), np.sin(a)] for a in 2.0 * np.pi * np.arange(k) / k), *more]


def test_the_least_ratios_are_those_of_the_best_sets_of_points():
    """A square, a pentagon, a pentagon and a hexagon about their centre; in space a triangle between two points."""
    best = {4: ring(4), 5: ring(5), 6: ring(5, [0.0, 0.0]), 7: ring(6, [0.0, 0.0])}
    found = levels._least_ratios(2)
    assert {k: float(ratio) for k, ratio in found.items()} == pytest.approx({k: ratio_of(x) for k, x in best.items()})
    half = np.sqrt(0.75)
    bipyramid = [[x, y, 0.0] for x, y in ring(3)] + [[0.0, 0.0, half], [0.0, 0.0, -half]]
    assert {k: float(ratio) for k, ratio in levels._least_ratios(3).items()} == pytest.approx({5: ratio_of(bipyramid)})
    assert levels._least_ratios(1) == {}


@pytest.mark.parametrize(
    ("r", "m", "most"), [(7.5, 1, 2), (9.8, 1, 2), (15.0, 1, 5), (7.5, 2, 3), (9.8, 2, 4), (7.5, 3, 4), (9.8, 3, 26)]
)
def test_so_many_points_fit(r, m, most):
    """Between the shortest distance of a bound pair and r: ratios of 1.10, 1.60 and 4.27."""
    with ctx.workprec(100):
        assert levels._largest_clique(AlphaInteraction(r=r), m) == most


def test_one_agent_alone_is_not_left_behind_and_of_two_one_is():
    alpha = AlphaInteraction()
    assert levels.disconnected_state(alpha, 1, 2) is None
    with ctx.workprec(100):
        assert levels.disconnected_state(alpha, 2, 2).overlaps(PairNumbers.of_alpha(alpha).far)


def test_on_a_line_a_lattice_is_exact_below_twice_its_length():
    """κ = 1.9: agents d apart hold to their neighbours alone; at κ = 2 they hold to the next as well."""
    alpha = AlphaInteraction(d=5.0, r=9.5)
    with ctx.workprec(100):
        far = PairNumbers.of_alpha(alpha).far
        assert levels.disconnected_state(alpha, 5, 1).overlaps(7 * far)  # 10 pairs less 3 bonds
    assert levels.disconnected_state(alpha, 5, 2) is None
    assert levels.disconnected_state(AlphaInteraction(d=5.0, r=10.0), 5, 1) is None


Q = np.array([[0.0, 0.0], [6.5, 0.5], [2.0, 7.5], [9.0, 6.0]])
P = np.array([[1.0, 0.0], [0.5, -1.0], [0.0, 2.0], [-0.5, 0.5]])


@pytest.mark.parametrize(
    "law", [fl.Algorithm1(), fl.Algorithm2(target=fl.StaticTarget(Q.mean(axis=0).tolist()))], ids=["1", "2"]
)
def test_it_is_the_energy_of_the_law_seen_from_the_centre(law):
    found = structural_energy(law, *([[arb(x) for x in row] for row in state.tolist()] for state in (Q, P)))
    assert float(found.mid()) == pytest.approx(law.energy(0.0, Q, P - P.mean(axis=0)), rel=1e-13)
    assert float(found.rad()) < 1e-20
