"""Levels in balls: those of the counts in floating point, with nothing left to a slack."""

from __future__ import annotations

import pytest
from flint import arb, ctx

from flockana import Algorithm1, AlphaInteraction, Gains
from flockana.certified import levels
from flockana.equilibria.barrier import collision_bounds
from flockana.theorems.olfati_saber.os_1 import disconnected_energy

LONG = AlphaInteraction(r=9.8)  # κ = 1.4: cliques of 4 in the plane


@pytest.mark.parametrize(("alpha", "m"), [(AlphaInteraction(), 2), (AlphaInteraction(), 1), (LONG, 2), (LONG, 3)])
def test_the_balls_are_about_the_bounds_in_floating_point(alpha, m):
    low, high = collision_bounds(alpha, 7, m)
    floor, state = levels.coincident_floor(alpha, 7, m), levels.coincident_state(alpha, 7, m)
    assert abs(floor - arb(low)) < 1e-12 * low
    assert abs(state - arb(high)) < 1e-12 * high
    assert floor.rad() < 1e-20


def test_two_agents_at_one_place_cost_c_star_and_no_more():
    with ctx.workprec(100):
        assert levels.coincident_floor(AlphaInteraction(), 2, 2).overlaps(
            levels.coincident_state(AlphaInteraction(), 2, 2)
        )


def test_a_length_at_which_a_pair_is_bound_is_not_called_too_short():
    par = levels.scaled(AlphaInteraction())
    with ctx.workprec(100):
        shortest = levels._shortest_bound(par)
        assert abs(float(shortest) - 6.568) < 1e-3
        value = levels.psi_alpha(levels.sigma_norm(arb(shortest), par.eps), par)
        assert value > levels.far_potential(par)
        assert value < levels.far_potential(par) + arb("1e-9")


def test_a_state_left_behind_has_the_energy_of_its_lattice_and_none_where_there_is_none():
    law = Algorithm1(gains=Gains(c1_alpha=3.0, c2_alpha=1.0))
    for n, m in ((7, 2), (4, 1), (5, 3)):
        ball = levels.gain(law) * levels.disconnected_state(law.alpha, n, m)
        stated = disconnected_energy(law, n, m)
        assert abs(ball - arb(stated)) < 1e-12 * stated
    assert levels.disconnected_state(AlphaInteraction(r=12.2), 7, 2) is None  # κ > √3
    assert levels.disconnected_state(AlphaInteraction(r=12.1), 7, 2) is not None
