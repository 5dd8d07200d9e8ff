"""Definition 5 from a tube: what it says of its window is what a run of the same start does there, step by step."""

import numpy as np
import pytest

from flockana import Algorithm1, Algorithm2, StaticTarget, Tolerances, enclose, simulate, verify

SPAN = (1.0, 1.5)
LED = Algorithm2(target=StaticTarget((1.0, 0.0)))
START = np.array([[0.0, 0.0], [6.5, 0.0], [3.0, 6.0]]), np.array([[0.3, 0.0], [0.0, -0.4], [0.0, 0.1]])


@pytest.fixture(scope="module")
def tube():
    return enclose(LED, *START, SPAN, order=12)


def window(tube, tolerances):
    """Times between the ends of the steps that are judged, and the run there."""
    begin = tube.t[0] + tolerances.settle * (tube.t[-1] - tube.t[0])
    first = max(t for t in tube.t if t <= begin)
    return simulate(LED, *START, SPAN, rtol=1e-12, t_eval=np.union1d(np.linspace(first, SPAN[1], 2001), SPAN))


@pytest.mark.slow
@pytest.mark.parametrize("settle", [0.5, 0.9])
@pytest.mark.parametrize(
    ("claim", "measure", "unit"),
    [
        ("deviation", "normalised_deviation_energy", 1.0),
        ("mismatch", "normalised_velocity_mismatch", LED.scales.energy),
    ],
)
def test_what_is_largest_over_the_window_is_what_a_run_has_there(tube, claim, measure, unit, settle):
    tolerances = Tolerances(settle=settle)
    said = verify("alpha-flocking", tube, tolerances=tolerances).claim(claim)
    found = window(tube, tolerances).metric(measure)[1:].max() / unit
    assert found <= said.computed * (1.0 + 1e-9)
    assert said.computed <= 1.1 * found
    bound = tolerances.deviation if claim == "deviation" else tolerances.mismatch
    assert bound - said.computed <= said.margin + 1e-12
    assert said.margin <= bound - found / 1.1


@pytest.mark.slow
def test_the_radius_is_compared_with_what_it_is_when_the_window_begins(tube):
    tolerances = Tolerances(settle=0.5, cohesion=1.5)
    run = window(tube, tolerances)
    radius = run.metric("cohesion_radius")[1:]
    said = verify("alpha-flocking", tube, tolerances=tolerances).claim("cohesive")
    assert radius.max() <= said.computed <= radius.max() * 1.05
    assert said.margin == pytest.approx(1.5 * radius[0] - radius.max(), rel=0.1)
    assert said.status == "verified"
    tight = Tolerances(settle=0.5, cohesion=1.0)
    assert verify("alpha-flocking", tube, tolerances=tight).claim("cohesive").status != "verified"


@pytest.mark.slow
@pytest.mark.parametrize(
    ("far", "flock", "outside"),
    [
        ([[0.0, 0.0], [7.0, 0.0], [3.5, 6.0], [30.0, 0.0]], "refuted", 1.0),
        ([[0.0, 0.0], [7.0, 0.0], [3.5, 6.0], [10.5, 6.0]], "verified", 0.0),
        ([[0.0, 0.0], [7.0, 0.0], [30.0, 0.0], [37.0, 0.0]], "refuted", 2.0),
    ],
)
def test_links_are_counted_that_certainly_are(far, flock, outside):
    """More than 3/4 of four agents are all of them, if 3/4 falls short by rounding too; more than 0.7, at least 3."""
    still = enclose(Algorithm1(), far, np.zeros((4, 2)), (0.0, 0.03125))
    for share, most in ((0.7, 1.0), (0.75 - 1e-13, 0.0)):
        giant = verify("alpha-flocking", still, tolerances=Tolerances(giant=share)).claim("giant")
        assert (giant.computed, giant.margin) == (outside, pytest.approx(most + 0.5 - outside))
        assert giant.status == ("verified" if outside <= most else "refuted")
    verdict = verify("alpha-flocking-strict", still).claim("flock")
    assert verdict.status == flock
    assert verdict.margin == pytest.approx(1.5 - verdict.computed)
    assert verdict.computed == (1.0 if flock == "verified" else 2.0)


def test_a_pair_at_its_range_leaves_the_number_of_components_open():
    edge = enclose(Algorithm1(), [[0.0], [Algorithm1().alpha.r]], [[0.0], [0.0]], (0.0, 0.03125), radius=1e-9)
    claim = verify("alpha-flocking-strict", edge).claim("flock")
    assert claim.status == "inconclusive"
    assert "the margin is between -0.5 and 0.5" in claim.detail
    assert "2 at most" in claim.detail


def test_a_tube_without_steps_in_the_window_says_nothing():
    broken = enclose(LED, *START, SPAN, steps=2)
    for name in ("alpha-flocking", "alpha-flocking-strict"):
        verdict = verify(name, broken)
        assert {claim.status for claim in verdict.claims} <= {"vacuous", "inconclusive"}
        assert any("it took 2 steps" in need.detail for need in verdict.hypotheses)
