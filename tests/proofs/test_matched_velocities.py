"""The proof that velocities match: what is false of wrong constants, or of another law, is not called proved."""

from __future__ import annotations

import pytest

pytest.importorskip("z3")  # the extra flockana[proofs]


from flockana.symbolic.energy import algorithm1_identity
from flockana.symbolic.errata import e1_identity
from proofs import matched_velocities as proof
from tests.proofs.steps import failing


def test_all_steps_hold():
    assert failing(proof.PROOF.steps()) == []


@pytest.mark.parametrize(("less", "holds"), [(1, True), (0, False)])
def test_a_cut_of_one_agent_leaves_one_pair_less_than_there_are_agents(less, holds):
    assert proof.cut(less).holds is holds


@pytest.mark.parametrize(("count", "factor", "holds"), [(4, 4, True), (4, 3, False), (1, 1, True)])
def test_squares_over_a_path_need_the_number_of_its_links(count, factor, holds):
    assert proof.over_links(count, factor).holds is holds


def test_the_printed_energy_of_e1_does_not_carry_the_argument(monkeypatch):
    monkeypatch.setattr(proof, "algorithm1_identity", lambda m: e1_identity(m))
    assert [text for text in failing(proof.PROOF.steps()) if text.startswith("Algorithm 1, m = ")]
    assert algorithm1_identity(2).holds


def test_an_energy_that_may_be_negative_bounds_no_integral():
    broken = proof.implication(
        "no bound from below",
        proof.C * proof.TOTAL <= proof.H0,
        proof.C > 0,
        proof.H <= proof.H0 - proof.C * proof.TOTAL,
    )
    assert broken.holds is False
