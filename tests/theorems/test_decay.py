from math import sqrt

import numpy as np
import pytest

import flockana as fl
from flockana import DeadZoneFlocking, Gains, Trajectory, find_equilibrium, linearise, rescale, simulate
from flockana.base.errors import ArgumentError
from flockana.base.integrity_seals import sealed
from flockana.environment.targets import LinearTarget, StaticTarget
from flockana.lattice import hexagonal_patch
from flockana.laws.olfati_saber import Algorithm1, Algorithm2
from flockana.stability import decay as module
from flockana.stability.decay import (
    LinearRange,
    decay,
    linear_motion,
    linear_range,
    logarithmic_slopes,
    slowest_seen,
    velocity_mismatch,
)
from flockana.theorems import Tolerances, verify


@pytest.fixture(scope="module")
def hexagon():
    law = Algorithm1()
    return linearise(law, find_equilibrium(law, hexagonal_patch(1, 7.0)))


@pytest.fixture(scope="module")
def verdict():
    return verify("linearised-decay")


def test_a_bond_decays_as_its_spring_and_damper_say():
    """λ² + 2 c2α a λ + 2 k = 0 along the bond: the rate is c2α a, with a the weight of the link at d."""
    law = Algorithm1()
    weight = float(law.alpha.adjacency(law.alpha.d_alpha))
    found = decay(linearise(law, [[0.0], [7.0]]), name="bond")
    assert found.predicted == pytest.approx(law.gains.c2_alpha * weight, rel=1e-12)
    assert found.measured == pytest.approx(found.predicted, rel=1e-4)  # O(amplitude)
    assert (found.name, found.law, found.n, found.m) == ("bond", "Algorithm1", 2, 1)


def test_the_slope_of_a_decaying_swing_is_exact_and_the_mismatch_relative_to_the_centre():
    """K̃ = e^(−2σt)(1 + b cos 2ωt) has the slope −2σ over its half periods, however deep it swings."""
    rate, half = 0.7, 0.25
    t = np.arange(5 * module._SAMPLES + 1) * half / module._SAMPLES
    mismatch = np.exp(-2.0 * rate * t) * (1.0 + 0.999 * np.cos(2.0 * np.pi * t / half))
    np.testing.assert_allclose(logarithmic_slopes(mismatch, half), -2.0 * rate, rtol=1e-12)
    assert velocity_mismatch(np.array([[[1.0], [3.0]], [[5.0], [5.0]]])).tolist() == [1.0, 0.0]


def test_the_linear_solution_is_the_matrix_exponential(hexagon):
    from scipy.linalg import expm

    rng = np.random.default_rng(1)
    dq, dp = rng.standard_normal((2, 7, 2))
    t = np.linspace(0.0, 0.6, 4)
    q, p = linear_motion(hexagon, dq, dp, t)
    expected = expm(0.6 * hexagon.A) @ np.concatenate([dq.ravel(), dp.ravel()])
    np.testing.assert_allclose(np.concatenate([q[-1].ravel(), p[-1].ravel()]), expected, atol=1e-12)
    np.testing.assert_array_equal(q[0], dq)


def test_translations_are_not_what_the_mismatch_sees():
    law = Algorithm2(target=StaticTarget((0.0, 0.0)))
    found = linearise(law, find_equilibrium(law, hexagonal_patch(1, 7.0)))
    assert found.modes[0].name.startswith("translation")
    mode = slowest_seen(found)
    assert mode.name == "breathing"
    assert mode.decay_rate == found.structural_decay_rate


def test_random_starts_tend_to_the_slowest_mode(hexagon):
    found = decay(hexagon, seed=3)
    assert found.random_measured == pytest.approx(found.random_linear, rel=1e-3)
    assert found.predicted <= found.random_linear < 1.2 * found.predicted  # others are still there, and faster


@pytest.mark.parametrize("n", [2, 3, 6])
@pytest.mark.parametrize("time", [1e-3, 1.0, 1e3])
def test_what_does_not_decay_is_refused(n, time):
    law = rescale(Algorithm1(gains=Gains(c2_alpha=0.0)), time=time)
    found = linearise(law, 7.0 * np.arange(float(n))[:, None])
    assert not found.stable
    assert all(abs(mode.decay_rate) <= mode.error < 1e-10 * mode.frequency for mode in found.modes)
    with pytest.raises(ArgumentError, match=r"decay rate .*rounding alone may make .*expected a stable flock"):
        decay(found)


def test_what_hardly_decays_is_refused_before_memory_runs_out():
    found = linearise(Algorithm1(gains=Gains(c2_alpha=1e-9)), [[0.0], [7.0]])
    assert found.stable  # the rate is a millionth of a millionth of the frequency, and yet far above rounding
    with pytest.raises(ArgumentError, match=r"mode breathing swings .* times until .*expected at most 2000 times"):
        decay(found)
    run = simulate(found.law, [[0.0], [7.001]], [[0.0], [0.0]], (0.0, 0.5))
    verdict = verify("linearised-decay-terminal", run)
    assert (verdict.status, verdict.hypotheses[0].status) == ("inconclusive", "met")
    assert decay(linearise(Algorithm1(gains=Gains(c2_alpha=1.0)), [[0.0], [7.0]])).difference < 1e-3


def test_one_agent_has_no_shape():
    law = Algorithm2(target=StaticTarget((0.0,)))
    with pytest.raises(ArgumentError, match=r"n = 1: expected a mode of the shape"):
        slowest_seen(linearise(law, [[0.0]]))
    verdict = verify("linearised-decay-terminal", law=law, q0=[[0.1]], p0=[[0.0]], t_span=(0.0, 1.0))
    assert verdict.status == "inconclusive"
    assert "expected a mode of the shape" in verdict.claim("decay").detail


def test_the_range_of_a_bond(hexagon):
    found = linear_range(linearise(Algorithm1(), [[0.0], [7.0]]), amplitudes=[1e-4, 2e-4, 0.2])
    assert found.exponent == pytest.approx(2.0, abs=0.01)
    # each agent moves by a; the bond stretches by 2 a and breaks at r = 1.2 d
    assert found.margin == pytest.approx(0.1, rel=1e-9)
    assert found.net_changes.tolist() == [False, False, True]
    with pytest.raises(ArgumentError, match="expected rising numbers"):
        linear_range(hexagon, amplitudes=[0.1, 0.1])


def test_limits_are_interpolated():
    sizes = np.array([1e-3, 1e-2, 1e-1])
    found = LinearRange("x", sizes, 2.0 * sizes, np.zeros(3, bool), 1.0)
    assert found.limit(0.01) == pytest.approx(0.005)
    assert (found.limit(1.0), found.limit(1e-4)) == (0.1, 0.0)


def test_the_table_of_the_catalogue(verdict):
    assert verdict.status == "verified"
    rows = verdict.claim("decay").computed
    assert len(rows) == 9
    assert {one["law"] for one in rows.values()} == {"Algorithm1", "Algorithm2", "Algorithm3"}
    for name, one in rows.items():
        assert one["measured"] == pytest.approx(one["predicted"], rel=5e-4), name
        assert one["random, measured"] == pytest.approx(one["random, linear"], rel=1e-3), name
        assert one["error"] < 2e-3 * one["predicted"], name
    largest = max(one["error"] / one["predicted"] for one in rows.values())
    errors = [verdict.claim(name).error for name in ("decay", "random")]
    assert 0.0 < largest == pytest.approx(errors[0], rel=1e-12) == pytest.approx(errors[1], rel=1e-12)
    assert rows["hexagon 7, Algorithm 1"]["predicted"] == pytest.approx(1.96374976, rel=1e-8)
    random = verdict.claim("random")
    worst = rows[random.witness]
    assert (random.computed, random.stated) == (worst["random, measured"], worst["random, linear"])
    assert random.margin == pytest.approx(0.02 - abs(random.computed / random.stated - 1.0), abs=1e-12)
    assert random.margin > 0.019


def test_the_range_ends_where_the_force_bends_not_where_links_break(verdict):
    claim = verdict.claim("range")
    alpha = Algorithm1().alpha
    # σ-norm's slope at d is d/√(1 + ε d²); its argument is 1 at that inverse
    assert claim.witness["σ₁ bends at"] == pytest.approx(sqrt(1.0 + alpha.eps * 49.0) / 49.0, rel=1e-12)
    for one in claim.computed.values():
        assert one["exponent"] == pytest.approx(2.0, abs=0.05)
        below = one["amplitudes"] < 0.05
        assert not one["net changes"][below].any()
        assert one["deviations"][below].max() > 0.05
        assert one["margin"] > 0.25


def test_tight_tolerances_refute_what_they_should(hexagon):
    law = Algorithm1()
    run = simulate(law, hexagon.q + 0.01, 0.0 * hexagon.q, (0.0, 0.1))
    found = verify("linearised-decay-terminal", run, tolerances=Tolerances(agreement=1e-9))
    assert found.claim("decay").status == "inconclusive"
    assert verify("linearised-decay-terminal", run).status == "verified"


def test_the_last_state_counts_and_the_target_is_held():
    law = Algorithm2(target=LinearTarget((0.0, 0.0), (2.0, 0.0)))
    q = hexagonal_patch(1, 6.9)
    run = simulate(law, q, np.tile([2.0, 0.0], (7, 1)), (0.0, 1.0))
    found = verify("linearised-decay-terminal", run)
    assert found.status == "verified"
    assert found.claim("decay").computed["n = 7, last state"]["predicted"] == pytest.approx(3.056333, rel=1e-6)


def test_what_cannot_be_linearised_is_vacuous():
    q = [[0.0, 0.0], [9.0, 0.0]]
    apart, other = (
        verify("linearised-decay-terminal", law=law, q0=q, p0=np.zeros((2, 2)), t_span=(0.0, 0.1))
        for law in (Algorithm1(), DeadZoneFlocking())  # the first has no link: nothing decays
    )
    many = np.zeros((2, 201, 2))
    flock = sealed(Trajectory(np.array([0.0, 1.0]), many, many, many, Algorithm1()))
    large = verify("linearised-decay-terminal", flock)
    assert [v.status for v in (apart, other, large)] == ["vacuous"] * 3
    assert "DeadZoneFlocking has no equilibria" in other.hypotheses[0].detail
    assert "n = 201: more than 200" in large.hypotheses[0].detail


@pytest.mark.slow
def test_a_pair_that_is_damped_much_is_measured_while_it_is_above_the_errors_of_the_run():
    """s² + 2 a s + 2 k with ζ = 0.82: within six half swings K̃ falls by 10²³, of which a run shows 10¹²."""
    pair = fl.pair_law("(1 - exp(1 - s))**2*(1 - s/3)**3", adjacency="(1 - s/3)**2", range=3.0, length=1.0)
    law = Algorithm1(pair)
    rest = find_equilibrium(law, [[0.0, 0.0], [1.01, 0.0]])
    flock = linearise(law, rest)
    rates = decay(flock)
    assert flock.modes[0].damping_ratio == pytest.approx(0.8165, abs=1e-3)
    assert rates.difference < 1e-4
    assert rates.random_difference < 1e-4
    run = simulate(law, [[0.0, 0.0], [1.1, 0.0]], [[0.0, 0.01], [0.0, 0.1]], (0.0, 1.0))
    assert {c.status for c in verify("linearised-decay-terminal", run).claims} == {"verified"}
