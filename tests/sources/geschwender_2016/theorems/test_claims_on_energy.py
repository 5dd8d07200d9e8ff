"""What it takes to refute a printed energy by a run."""

import numpy as np
import pytest

from flockana import Algorithm1, Trajectory
from flockana.sources.geschwender_2016.theorems.claims_on_energy import rises, run_claim
from flockana.theorems.theorem_toolkit import Enclosure, Hypothesis, Observed, observed


@pytest.fixture(scope="module")
def seen():
    return observed(Algorithm1(), [[0.0], [8.0]], [[0.0], [0.0]], (0.0, 2.0))


def lost(run):
    return run.energy()[0] - run.energy()


def test_an_excess_that_makes_it_rise_refutes_it_and_a_fall_verifies_nothing(seen):
    claim = run_claim(seen, lambda run: 10.0 * lost(run), "two agents")
    assert claim.status == "refuted"
    assert claim.computed == pytest.approx(9.0 * lost(seen.run)[-1], rel=1e-9)
    assert run_claim(seen, lambda run: np.zeros(len(run.t)), "two agents").status == "inconclusive"


def test_a_rise_from_any_sample_on_counts(seen):
    def excess(run):
        return np.minimum(np.where(run.t < 1.0, -5.0 * run.t, -5.0 + 30.0 * (run.t - 1.0)), -0.1)

    assert run_claim(seen, excess, "two agents").status == "refuted"


@pytest.mark.parametrize("size", [1e-12, 1e-6, 1.0, 1e6])
@pytest.mark.parametrize(("times", "status"), [(1.9, "inconclusive"), (300.0, "refuted")])
def test_a_rise_within_what_two_runs_differ_by_is_left_open(seen, size, times, status):
    def excess(run):
        return lost(run) + size * (times * run.t / 2.0 + (run is seen.other))

    floor = 2.0 * seen.floors.work + 1e-9
    claim = run_claim(seen, excess, "two agents")
    assert claim.status == (status if size > floor else "inconclusive")


def test_of_a_failed_run_nothing_is_known_and_an_unmet_hypothesis_makes_it_vacuous(seen):
    given = seen.given
    failed = Trajectory(given.t, given.q, given.p, given.u, given.law, extra=given.extra, status="failed")
    assert run_claim(Observed.of(failed), lambda run: 10.0 * lost(run), "two agents").status == "inconclusive"
    unmet = Hypothesis("the γ-agent is at rest", "unmet")
    assert run_claim(seen, lambda run: 10.0 * lost(run), "two agents", [unmet]).status == "vacuous"


def test_how_far_a_series_is_above_its_least_value_so_far():
    above = rises(Enclosure.around([3.0, 1.0, 2.0, 0.0], 0.25))
    assert above.mid.tolist() == [0.0, 0.0, 1.0, 0.0]
    assert above.lo.tolist() == pytest.approx([-0.5, -0.5, 0.5, -0.5])
