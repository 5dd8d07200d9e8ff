"""What it takes to refute a printed energy by a run."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from flockana.dynamics.simulate import simulate
from flockana.laws.olfati_saber import Algorithm1
from flockana.theorems.slides.claims_on_energy import run_claim
from flockana.theorems.theorem import Hypothesis


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
    backwards = replace(run, q=run.q[::-1], p=run.p[::-1], u=run.u[::-1])
    assert run_claim(backwards, np.zeros(len(run.t)), "two agents").status == "inconclusive"


def test_a_rise_from_any_sample_on_counts(run):
    """An excess that falls first and then climbs: above its start it never is."""
    excess = np.where(run.t < 1.0, -5.0 * run.t, -5.0 + 30.0 * (run.t - 1.0))
    claim = run_claim(run, np.minimum(excess, -0.1), "two agents")
    assert claim.status == "refuted"


@pytest.mark.parametrize("size", [1e-3, 1e3])
def test_a_rise_within_the_error_of_the_balance_is_left_open(run, size):
    """An energy rise of 5.4 with an error of 211 was called verified elsewhere: here neither verdict is given."""
    rough = replace(run, extra={"work": run.extra["work"] + size * np.sin(run.t)})
    excess = 0.3 * size * run.t + (run.energy()[0] - run.energy())
    claim = run_claim(rough, excess, "two agents")
    assert claim.error > claim.computed > 0.0
    assert claim.status == "inconclusive"


def test_an_unmet_hypothesis_makes_it_vacuous(run):
    unmet = Hypothesis("the γ-agent is at rest", "unmet")
    assert run_claim(run, 10.0 * (run.energy()[0] - run.energy()), "two agents", [unmet]).status == "vacuous"
