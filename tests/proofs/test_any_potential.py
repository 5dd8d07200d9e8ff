"""The proofs for every potential and of convergence: what is false of wrong constants is not called proved."""

import pytest

pytest.importorskip("z3")  # the extra flockana[proofs]

import z3

from flockana.symbolic.errata import e1_identity
from proofs import any_potential as proof
from proofs import any_potential_limits as limits
from proofs import convergence, matched_velocities
from tests.proofs.steps import failing


@pytest.mark.parametrize("of", [proof, limits, convergence, matched_velocities])
def test_all_steps_hold_and_none_is_missing(of):
    steps = list(of.PROOF.steps())
    assert failing(steps) == []
    assert len(steps) == of.PROOF.size


@pytest.mark.parametrize(("count", "factor", "holds"), [(4, 4, True), (4, 3, False), (1, 1, True)])
def test_squares_over_a_path_need_the_number_of_its_links(count, factor, holds):
    assert matched_velocities.over_links(count, factor).holds is holds


@pytest.mark.parametrize(("less", "holds"), [(1, True), (0, False)])
def test_a_cut_of_one_agent_leaves_one_pair_less_than_there_are_agents(less, holds):
    assert proof.cut(less).holds is holds


@pytest.mark.parametrize(("factor", "holds"), [(2, True), (1, False)])
def test_the_radius_needs_twice_the_energy(factor, holds):
    assert proof.cohesive(factor).holds is holds


def test_a_potential_without_a_least_value_bounds_nothing(monkeypatch):
    monkeypatch.setattr(proof, "LOW", z3.BoolVal(True))
    assert proof.cohesive(2).holds is False


def test_the_printed_energy_of_e1_does_not_carry_the_argument(monkeypatch):
    monkeypatch.setattr(proof, "algorithm1_identity", lambda m: e1_identity(m))
    assert len(failing(proof.energy_falls())) == 3


@pytest.mark.parametrize(("room", "holds"), [(1, True), (3, False)])
def test_the_energy_that_converges_needs_a_small_constant(room, holds):
    names = z3.Reals("v grad_U c D_max M kappa fall")
    assert convergence.falls(*names[:2], tuple(names[2:]), z3.RealVal(room)).holds is holds
