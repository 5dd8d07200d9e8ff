"""The design of gains: optima that are known, derivatives, what heterogeneity buys, and what specifications bind."""

from dataclasses import replace
from math import exp, pi, sqrt

import numpy as np
import pytest

from flockana import Algorithm2, AlphaInteraction, Gains, StaticTarget, find_equilibrium
from flockana.lattice import hexagonal_spiral
from flockana.stability.delay import delay_margin
from flockana.stability.design import design_gains
from flockana.stability.gain_problems import GainProblem, gain_problem
from flockana.stability.law_studies import delay_system, law_blocks
from flockana.stability.norms import disturbance_system, h2_norm
from flockana.stability.specifications import Specifications
from tests.refused import refused

ALPHA, GAINS, ORIGIN = AlphaInteraction(), Gains(), StaticTarget((0.0, 0.0))
Q = hexagonal_spiral(7, 7.0)
ALONE = GainProblem(np.zeros((1, 1)), np.zeros((1, 1)), np.zeros((1, 0)), 1)
ONE = gain_problem([[0.0]], alpha=ALPHA, gains=GAINS)


def problem(n=7, **options):
    return gain_problem(hexagonal_spiral(n, 7.0), alpha=ALPHA, gains=GAINS, **options)


def test_the_matrix_is_the_papers():
    gains = np.random.default_rng(0).uniform(0.0, 5.0, 14)
    law = Algorithm2(target=ORIGIN, gains=Gains(c1_gamma=gains[:7], c2_gamma=gains[7:]))
    whole = law_blocks(law, Q, strict=False).matrix()
    np.testing.assert_allclose(problem(rotation="counted").matrix(gains), whole, atol=1e-12)
    dropped = problem(form="simplified").matrix(gains)
    assert dropped.shape == (14, 14)
    np.testing.assert_allclose(dropped[7:, :7], -np.diag(gains[:7]))
    np.testing.assert_allclose(dropped[7:, 7:], whole[14::2, 14::2], atol=1e-12)


def test_a_turning_pair_has_an_angle_and_a_speed():
    """Without c2α, alike (9, 0.5): each motion has s² + s/2 + 9, the turning one s = −1/2 if its angle is neutral."""
    gains = np.repeat([9.0, 0.5], 2)
    found = {
        r: gain_problem([[0.0, 0.0], [7.0, 0.0]], alpha=ALPHA, gains=Gains(c2_alpha=0.0), rotation=r).eigenvalues(gains)
        for r in ("counted", "neutral", "apart")
    }
    swing = np.roots([1.0, 0.5, 9.0])
    assert [np.sum(np.abs(values - swing[0]) < 1e-6) for values in found.values()] == [3, 2, 2]
    assert [np.sum(np.abs(values + 0.5) < 1e-9) for values in found.values()] == [0, 1, 0]
    assert [values.size for values in found.values()] == [8, 7, 6]


@pytest.mark.parametrize("options", [{}, {"rotation": "neutral"}, {"rotation": "counted"}, {"form": "simplified"}])
def test_slopes_against_differences(options):
    own = problem(**options)
    gains = np.random.default_rng(2).uniform(0.5, 4.5, 14)
    values, slopes = own.slopes(gains)
    worst = int(np.argmax(values.real))
    for k in range(14):
        step = np.zeros(14)
        step[k] = 1e-6
        found = (own.abscissa(gains + step) - own.abscissa(gains - step)) / 2e-6
        assert slopes[worst, k] == pytest.approx(found, abs=1e-7)


def test_one_agent_is_damped_critically():
    """The best of s² + c2 s + c1 with c1 <= 5: −√5 at c2 = 2√5; with c2 <= 2 only −1."""
    found = design_gains(ALONE, starts=2)
    assert found.rate_homogeneous == pytest.approx(sqrt(5.0), abs=1e-3)  # a square-root cusp: √eps is what is reached
    assert found.homogeneous == pytest.approx([5.0, 2.0 * sqrt(5.0)], abs=1e-3)
    assert design_gains(ALONE, bounds=(0.0, 2.0), starts=1).rate_homogeneous == pytest.approx(1.0, abs=1e-6)


def test_two_independent_groups_find_their_own_gains():
    """K = diag(0, 3), no coupling: alike both must share c1, c2; apart each takes what is best for it, c2 <= 5."""
    two = GainProblem(np.diag([0.0, 30.0]), np.diag([0.0, 6.0]), np.zeros((2, 0)), 2)
    found = design_gains(two, starts=4, seed=1)
    assert found.rate_heterogeneous >= found.rate_homogeneous - 1e-12
    assert found.rate_heterogeneous == pytest.approx(sqrt(5.0), abs=2e-3)


def test_the_certificate_is_the_spectrum():
    found = design_gains(problem(4, rotation="counted"), starts=2)
    for gains, rate, values in (
        (found.homogeneous, found.rate_homogeneous, found.eigenvalues_homogeneous),
        (found.heterogeneous, found.rate_heterogeneous, found.eigenvalues_heterogeneous),
    ):
        assert gains.min() >= 0.0
        assert gains.max() <= 5.0
        assert -values.real.max() == rate
        spectrum = np.linalg.eigvals(found.problem.matrix(gains))
        assert spectrum.real.max() == pytest.approx(-rate, rel=1e-9)
    assert np.ptp(found.homogeneous[:4]) == np.ptp(found.homogeneous[4:]) == 0.0
    assert found.ratio > 1.02  # the search does move: alike is no optimum here
    again = design_gains(problem(4, rotation="counted"), starts=2)
    assert np.array_equal(again.heterogeneous, found.heterogeneous)  # by its seed


def test_gains_go_into_a_law():
    found = design_gains(problem(), starts=1)
    gains = found.gains(GAINS)
    assert gains.per_agent
    assert gains.c1_alpha == 30.0
    assert found.gains(GAINS, heterogeneous=False).c1_gamma == found.homogeneous[0]


ALIKE = np.repeat([5.0, 3.48027253], 30)  # found by design_gains, n = 30, bounds [0, 5]
CRITICAL = np.repeat([5.0, 2.0 * sqrt(5.0)], 30)
COUNTED, NEUTRAL, APART = np.full(60, 5.0), np.full(60, 5.0), np.full(60, 5.0)
COUNTED[[0, 2, 46, 49, 51, 54, 57, 59]] = 4.411, 1.029, 0.941, 0.0, 0.0, 0.832, 0.0, 0.0
NEUTRAL[[40, 44, 45, 46, 47, 54, 55, 59]] = 4.919, 4.772, 4.801, 3.745, 0.133, 0.239, 0.0, 4.772
APART[[37, 48, 49, 57, 58, 59]] = 0.515, 0.082, 0.515, 2.703, 4.551, 4.811


def test_thirty_agents_frozen():
    """What heterogeneity buys at the hexagonal spiral: 18 % with the rotation counted, 0.5 and 0.7 % without."""
    counted, neutral, apart = (problem(30, rotation=r) for r in ("counted", "neutral", "apart"))
    assert counted.abscissa(ALIKE) == pytest.approx(-1.740136, abs=1e-6)
    for own in (neutral, apart):
        assert own.abscissa(CRITICAL) == pytest.approx(-sqrt(5.0), abs=1e-6)
    assert counted.abscissa(COUNTED) == pytest.approx(-2.0606, abs=1e-3)  # gains rounded to 0.001
    assert neutral.abscissa(NEUTRAL) == pytest.approx(-2.2473, abs=2e-3)
    assert apart.abscissa(APART) == pytest.approx(-2.2514, abs=2e-3)
    # alike, no neighbour of the optimum is better
    for own, best in ((counted, ALIKE), (neutral, CRITICAL), (apart, CRITICAL)):
        for pair in ((4.9, best[30]), (5.0, best[30] - 0.05), (5.0, best[30] + 0.05)):
            assert own.abscissa(np.repeat(pair, 30)) > own.abscissa(best)


test_refusals = refused(
    (lambda: problem(form="none"), "unknown form 'none'"),
    (lambda: problem(rotation="maybe"), "unknown rotation 'maybe'"),
    (lambda: design_gains(problem(), bounds=(5.0, 0.0)), r"bounds = \(5, 0\): expected least < greatest"),
    (lambda: design_gains(problem(), bounds=3.0), "expected .least, greatest. gain"),
    (lambda: design_gains(problem(), bounds=(-1.0, 2.0)), "bounds = -1: expected a number >= 0"),
    (lambda: design_gains(problem(), starts=0), "starts = 0"),
    (lambda: design_gains("law"), "problem = 'law'"),
    (Specifications, "no specification is given"),
    (lambda: Specifications(decay=0.0), "decay = 0"),
    (lambda: design_gains(ONE, {"decay": 1.0}), "expected Specifications"),
    (lambda: design_gains(ONE, Specifications(decay=1.0), bounds=(2.0, 1.0)), "expected least < gr"),
    (lambda: design_gains(ONE, Specifications(decay=1.0), bounds=(0.0, 1.0)), "bounds = 0"),
    (lambda: design_gains(ONE, least="effort"), "least = 'effort': expected with Specifications"),
    (lambda: design_gains(ONE, Specifications(decay=1.0), least="decay"), "unknown least 'decay'"),
    (
        lambda: design_gains(ALONE, Specifications(decay=1.0)),
        "problem.law = None: expected a problem from gain_problem",
    ),
)


def test_decay_alone_wants_critical_damping_at_the_largest_gain():
    """Within c2γ <= 4 and c1γ <= 4 the rate is at most 2."""
    found = design_gains(ONE, Specifications(decay=1.0), bounds=(0.1, 4.0))
    assert found.reached["decay"] == pytest.approx(2.0, rel=0.02)
    assert (found.met, found.binding) == (True, "decay")


def test_decay_and_period_pull_apart_and_both_bind():
    """A hold bears 2/c2γ or 2 c2γ/c1γ, the rate is c2γ/2 at most: their product is at most 1."""
    found = design_gains(ONE, Specifications(decay=2.0, period=0.5))
    assert found.room["decay"] == pytest.approx(found.room["period"], abs=0.05)
    assert found.reached["decay"] * found.reached["period"] == pytest.approx(1.0, rel=0.05)


def test_overshoot_is_that_of_the_damping_ratio():
    found = design_gains(ONE, Specifications(overshoot=0.1, decay=0.5))
    ratio = found.gains.c2_gamma / (2.0 * sqrt(found.gains.c1_gamma))
    exact = exp(-pi * ratio / sqrt(1.0 - ratio**2)) if ratio < 1.0 else 0.0
    assert found.reached["overshoot"] == pytest.approx(exact)
    assert found.met


@pytest.mark.slow
def test_a_flock_does_what_is_said_of_it():
    pair = gain_problem([[0.0, 0.0], [7.0, 0.0]], alpha=ALPHA, gains=GAINS)
    found = design_gains(pair, Specifications(delay=0.01, h2=1.0), bounds=(0.5, 4.0))
    chosen = replace(pair.law, gains=found.gains)
    rest = find_equilibrium(chosen, pair.q).q
    assert found.reached["delay"] == pytest.approx(delay_margin(delay_system(chosen, rest)).delay, rel=1e-6)
    assert found.reached["h2"] == pytest.approx(h2_norm(disturbance_system(law_blocks(chosen, rest))), rel=1e-6)
    assert found.binding == min(found.room, key=found.room.get)


@pytest.mark.slow
def test_the_least_effort_that_decays_fast_enough():
    """Of s² + c2 s + c1 white noise asks for (c1 + c2²)/(2 c2) in power; with a rate of 1 that is least at (1, 2)."""
    least = design_gains(ONE, Specifications(decay=1.0), bounds=(0.2, 20.0), least="effort")
    c1, c2 = least.gains.c1_gamma, least.gains.c2_gamma
    assert least.reached["effort"] == pytest.approx(sqrt(0.5 * (c1 + c2**2) / c2), rel=1e-9)
    assert least.met
    assert (c1, c2) == pytest.approx((1.0, 2.0), rel=0.05)  # flat there: effort is within 1 %
    assert least.reached["effort"] == pytest.approx(sqrt(1.25), rel=0.01)
    rich = design_gains(ONE, Specifications(decay=1.0), bounds=(0.2, 20.0))
    assert rich.reached["decay"] > least.reached["decay"]


@pytest.mark.slow
def test_the_strain_of_a_squeezed_pair_binds():
    """c1γ pulls two agents together against one bond: its strain at rest is that of their equilibrium."""
    pair = gain_problem([[0.0, 0.0], [7.0, 0.0]], alpha=ALPHA, gains=GAINS)
    loose = design_gains(pair, Specifications(decay=0.5), bounds=(0.3, 20.0))
    tight = design_gains(pair, Specifications(decay=0.5, strain=0.005), bounds=(0.3, 20.0))
    chosen = replace(pair.law, gains=tight.gains)
    distance = np.linalg.norm(np.subtract(*find_equilibrium(chosen, pair.q).q))
    assert tight.reached["strain"] == pytest.approx(abs(distance / 7.0 - 1.0), rel=1e-6)
    assert 0.0 < tight.reached["strain"] <= 0.005
    assert tight.met
    assert tight.gains.c1_gamma < loose.gains.c1_gamma


def test_a_design_shows_itself_in_one_line():
    found = repr(design_gains(ALONE, starts=1))
    assert found == "<GainDesign of 1 agents: decay rates 2.2361 alike, 2.2361 per agent, ratio 1.000>"
