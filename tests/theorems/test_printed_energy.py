"""What it takes to refute a printed energy by a run."""

from __future__ import annotations

import numpy as np
import pytest

from flockana.laws.olfati_saber import Algorithm1
from flockana.simulate import simulate
from flockana.theorems.printed_energy import identity_claim, run_claim


@pytest.fixture(scope="module")
def run():
    return simulate(Algorithm1(), [[0.0], [8.0]], [[0.0], [0.0]], (0.0, 2.0))


def test_an_excess_that_makes_it_rise_refutes_it(run):
    claim = run_claim(run, 10.0 * (run.energy()[0] - run.energy()), "two agents")
    assert claim.status == "refuted"
    assert claim.computed == pytest.approx(9.0 * (run.energy()[0] - run.energy()[-1]), rel=1e-9)


def test_an_energy_that_falls_is_not_refuted(run):
    assert run_claim(run, np.zeros(len(run.t)), "two agents").status == "inconclusive"


def test_a_true_energy_that_rises_proves_nothing(run):
    backwards = run.__class__(run.t, run.q[::-1], run.p[::-1], run.u[::-1], run.law, run.extra)
    assert run_claim(backwards, np.zeros(len(run.t)), "two agents").status == "inconclusive"


def test_an_identity_is_judged_by_its_residual():
    assert identity_claim("x", 0, "", "").status == "verified"
    assert identity_claim("x", 1, "", "").status == "refuted"
