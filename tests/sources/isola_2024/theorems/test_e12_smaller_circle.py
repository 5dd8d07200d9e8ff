"""Erratum E12: the gain of the centre of mass that follows a γ-agent."""

from dataclasses import replace
from math import pi

import numpy as np
import pytest

from flockana import Algorithm2, Gains, Tolerances, compose, scenario, simulate, theorem, verify
from flockana.base.errors import ArgumentError
from flockana.environment.targets import CircleTarget, RescaledVelocity, SineTarget, StaticTarget
from flockana.sources.isola_2024.laws import MSNDiscretisation
from flockana.sources.isola_2024.theorems.e12_smaller_circle import measured_ratio
from flockana.stability.centre_path import motion
from flockana.stability.centre_transfer import predicted_gain
from flockana.stability.tracking import response_ratio
from flockana.symbolic.parameter_symbols import GainSymbols
from flockana.symbolic.translational_dynamics import frequency_gain
from flockana.theorems.observed_run import Observed, observed
from tests.theorems.made_up import statuses


def examined(seen):
    return theorem("E12").examine(seen, Tolerances())[1]


OMEGA = 2 * pi * 0.025 / 0.045
STRONG = scenario("msn-case4").law.gains


@pytest.mark.parametrize(("factor", "gain"), [(0.009, 0.852), (1.0, 1.109)])
def test_gains_of_the_erratum_and_of_the_symbolic_transfer_function(factor, gain):
    found = predicted_gain(STRONG, OMEGA, factor=factor)
    assert found == pytest.approx(gain, abs=5e-4)
    symbols = GainSymbols(c1_gamma=STRONG.c1_gamma, c2_gamma=STRONG.c2_gamma)
    assert found == pytest.approx(float(frequency_gain(factor, gains=symbols, omega=OMEGA)), rel=1e-12)


@pytest.mark.parametrize("path", [CircleTarget((0.0, 0.0), 2.0, 0.5), SineTarget((0.0, 0.0), (3.0, 0.0), 2.0, 0.5)])
def test_e12_on_one_agent(path):
    law = Algorithm2(gains=Gains(c1_gamma=20.0, c2_gamma=9.0), target=RescaledVelocity(path, 0.25))
    run = simulate(law, [[1.0, 1.0]], [[0.0, 0.0]], (0.0, 20.0))
    assert response_ratio(run)[0] == pytest.approx(predicted_gain(law.gains, pi, factor=0.25), abs=1e-6)
    verdict = verify("E12", run)
    assert statuses(verdict) == {"predicted": "verified", "consistent": "verified", "printed": "refuted"}


class Ellipse(CircleTarget):
    """Half as high as wide: a circle by its class alone."""

    def position(self, t):
        return super().position(t) * [1.0, 0.5]

    def rate(self, t):
        return super().rate(t) * [1.0, 0.5]


def test_a_subclass_that_moves_otherwise_is_no_circle():
    path = Ellipse((0.0, 0.0), 2.0, 0.5)
    law = Algorithm2(gains=Gains(c1_gamma=20.0, c2_gamma=9.0), target=RescaledVelocity(path, 0.25))
    verdict = verify("E12", simulate(law, [[1.0, 1.0]], [[0.0, 0.0]], (0.0, 4.0)))
    assert set(statuses(verdict).values()) == {"vacuous"}
    assert law.target.harmonic is None  # what compiled code would have followed
    with pytest.raises(ArgumentError, match="expected a static, linear, sine or circle target"):
        motion(path)
    with pytest.raises(ArgumentError, match="expected a γ-agent of known acceleration"):
        compose(navigation=path, feedforward=True)


@pytest.mark.parametrize(("frequency", "proof"), [(0.95, "tracking-gain"), (1.05, None)])
def test_the_proof_is_of_targets_that_turn_slowly(frequency, proof):
    """The gain is above 1 for ω² < 2 c1γ, and below it for faster ones."""
    circle = CircleTarget((0.0, 0.0), 2.0, frequency * np.sqrt(40.0) / (2.0 * pi))
    law = Algorithm2(gains=Gains(c1_gamma=20.0, c2_gamma=9.0), target=RescaledVelocity(circle, 0.25))
    run = simulate(law, [[1.0, 1.0]], [[0.0, 0.0]], (0.0, 20.0))
    claim = verify("E12", run).claim("printed")
    assert (claim.disproof, claim.status) == (proof, "refuted" if proof else "verified")


def test_e12_does_not_pass_a_gain_that_is_wrong():
    law = Algorithm2(gains=Gains(c1_gamma=20.0, c2_gamma=9.0), target=CircleTarget((0.0, 0.0), 2.0, 0.5))
    run = simulate(law, [[1.0, 1.0]], [[0.0, 0.0]], (0.0, 20.0))
    mislabelled = replace(run, law=replace(law, target=RescaledVelocity(law.target, 0.25)))
    with pytest.raises(ArgumentError, match="made or changed by hand"):
        verify("E12", mislabelled)
    claims = {claim.name: claim.status for claim in examined(Observed.alone(mislabelled))}
    assert (claims["predicted"], claims["consistent"]) == ("refuted", "verified")


@pytest.mark.parametrize("periods", [1.0, 1.1, 2.5])
def test_e12_knows_what_is_left_of_the_start(periods):
    path = CircleTarget((0.0, 0.0), 2.0, 0.5)
    law = Algorithm2(gains=Gains(c1_gamma=20.0, c2_gamma=0.4), target=RescaledVelocity(path, 0.25))
    run = simulate(law, [[30.0, 1.0]], [[0.0, 0.0]], (0.0, 2.0 * periods))
    off = abs(response_ratio(run)[0] / predicted_gain(law.gains, pi, factor=0.25) - 1.0)
    assert off > 3.0 * Tolerances().agreement
    claims = verify("E12", run).claims
    assert [claim.status for claim in claims] == ["inconclusive", "inconclusive", "refuted"]
    assert claims[2].disproof == "tracking-gain"  # the numbers alone leave it open
    assert all(claim.error > abs(claim.margin) for claim in (claims[0], claims[2]))


@pytest.mark.parametrize("rtol", [1e-3, 1e-5, 1e-7, 1e-10])
def test_the_measured_ratio_encloses_the_gain_of_loose_runs_too(rtol):
    law = Algorithm2(gains=Gains(c1_gamma=20.0, c2_gamma=9.0), target=CircleTarget((0.0, 0.0), 2.0, 0.5))
    ratio = measured_ratio(observed(law, [[1.0, 1.0]], [[0.0, 0.0]], (0.0, 20.0), rtol=rtol))
    gain = predicted_gain(law.gains, pi)
    assert ratio.lo <= gain <= ratio.hi
    assert ratio.half_width < 30.0 * rtol


def test_e12_needs_damping_and_something_to_follow():
    path = CircleTarget((0.0, 0.0), 2.0, 0.5)
    for gains, factor, status in (
        (Gains(c1_gamma=pi**2, c2_gamma=0.0), 0.25, "vacuous"),  # in resonance
        (Gains(c1_gamma=0.0, c2_gamma=0.0), 0.25, "vacuous"),
        (Gains(c1_gamma=0.0, c2_gamma=2.0), 0.0, "inconclusive"),  # told no velocity, pulled nowhere: it comes to rest
    ):
        law = Algorithm2(gains=gains, target=RescaledVelocity(path, factor))
        verdict = verify("E12", simulate(law, [[1.0, 1.0]], [[0.0, 0.0]], (0.0, 8.0)))
        assert verdict.claim("predicted").status == status


def test_e12_is_vacuous_elsewhere():
    for target in (StaticTarget((0.0, 0.0)), CircleTarget((0.0, 0.0), 1.0, 1.0), CircleTarget((0.0, 0.0), 1.0, 0.1)):
        run = simulate(Algorithm2(target=target), [[1.0, 1.0]], [[0.0, 0.0]], (0.0, 2.0))
        assert verify("E12", run).status == "vacuous"
    with pytest.raises(ArgumentError, match="expected at least one period, 10"):
        response_ratio(run)


def test_ratios_of_the_map_are_those_of_the_erratum():
    """0.8375 (1.0907 with the true p_r) all at once; 0.794 to 0.797 (1.034 to 1.036) in place."""
    entry = scenario("msn-case4-printed")
    found = {}
    for consistent in (False, True):
        target = entry.law.target.target if consistent else entry.law.target
        for in_place in (True, False):
            law = MSNDiscretisation(replace(entry.law.law, target=target), 0.009, in_place=in_place)
            found[consistent, in_place] = response_ratio(simulate(law, entry.q0, entry.p0, entry.t_span))[0]
    assert found[False, False] == pytest.approx(0.8375, abs=5e-4)
    assert found[True, False] == pytest.approx(1.0907, abs=5e-4)
    # in place the ratio differs a little from start to start
    assert found[False, True] == pytest.approx(0.7955, abs=0.004)
    assert found[True, True] == pytest.approx(1.035, abs=0.006)


def test_the_verdict_on_case_4_itself():
    entry = scenario("msn-case4")
    verdict = verify("E12", entry.run(), tolerances=Tolerances(agreement=1e-5))
    assert verdict.claim("predicted").computed == pytest.approx(0.8518, abs=1e-4)
    assert verdict.claim("consistent").computed == pytest.approx(1.1093, abs=1e-4)
    assert entry.surprises(verdict) == ()
    assert np.isclose(verdict.claim("printed").margin, 1.0 - 1.1093, atol=1e-4)
