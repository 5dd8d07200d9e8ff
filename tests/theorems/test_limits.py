"""What may be said of a limit: planted decays, swings, powers, growth, plateaus and noise, each known beforehand."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from flockana.theorems.limits import TIME_CONSTANTS, Certificate, decay, limit_claim
from flockana.theorems.theorem import Hypothesis

FLOOR = 1e-6
seeds = st.integers(0, 2**32 - 1)
powers = st.floats(-3.0, 3.0).map(lambda x: 10.0**x)


def certified(t, x, floor=FLOOR):
    return decay(t, x, floor=floor).certificate.margin > 0.0


@given(st.floats(12.0, 60.0), st.integers(64, 2000), powers, powers)
def test_an_exponential_decay_is_certified_in_any_unit(constants, samples, time, length):
    """From 1 below the floor takes 13.8 time constants; the last half of them must be 5 at the windows' pace."""
    t = np.linspace(0.0, constants, samples)
    found = decay(time * t, length * np.exp(-t), floor=length * FLOOR)
    level = np.exp(-constants * 7.0 / 8.0)  # of the last eighth, up to a sample
    assume(abs(np.log(level / FLOOR)) > 0.2)
    assert (found.certificate.margin > 0.0) is bool(level < FLOOR)
    assert found.depth == pytest.approx(-np.log(level / FLOOR), abs=constants / samples + 1e-9)


@given(st.floats(0.3, 40.0), st.floats(0.0, 6.3), st.floats(1.0, 300.0), st.integers(4, 3000))
def test_what_swings_for_ever_is_never_certified(frequency, phase, until, samples):
    """Wherever it is cut, turning points included, and however it is sampled."""
    t = np.linspace(0.0, until, samples)
    swing = np.abs(np.cos(frequency * t + phase))
    assert not certified(t, swing)
    assert not certified(t, swing * np.abs(np.cos(0.5 * np.pi * t / until)))  # a beat that happens to end at its node


@given(st.floats(0.5, 3.0), st.floats(0.2, 5.0), st.floats(0.0, 6.3))
def test_a_damped_swing_is_certified_once_it_has_died_out(rate, frequency, phase):
    t = np.linspace(0.0, 60.0 / rate, 4000)
    swing = np.exp(-rate * t) * np.abs(np.cos(frequency * rate * t + phase))
    assert certified(t, swing, floor=1e-9)
    assert not certified(t, np.exp(-1e-3 * rate * t) * np.abs(np.cos(frequency * rate * t)))


@given(st.floats(0.2, 4.0), st.floats(-1.0, 12.0).map(lambda x: 10.0**x))
def test_a_power_is_no_steady_decay(exponent, until):
    """t^-k falls by k log 2 in the last half, below any floor or not."""
    t = np.linspace(1.0, 1.0 + until, 2000)
    assert not certified(t, t**-exponent, floor=1e300)
    assert not certified(t, t**-exponent)


@given(st.floats(-5.9, 0.0).map(lambda x: 10.0**x), st.floats(0.1, 10.0))
def test_a_plateau_above_the_floor_is_a_limit_that_is_not_0(plateau, rate):
    t = np.linspace(0.0, 200.0, 2000)
    assert not certified(t, np.exp(-rate * t) + plateau)


@given(seeds, st.floats(-14.0, -7.0).map(lambda x: 10.0**x), st.floats(0.4, 3.0))
def test_a_decay_that_ends_in_the_noise_of_its_integration_is_certified(seed, noise, rate):
    t = np.linspace(0.0, 100.0, 3000)
    x = np.exp(-rate * t) + noise * np.random.default_rng(seed).uniform(0.1, 1.0, t.size)
    assert certified(t, x)


@given(seeds, st.floats(-14.0, 0.0).map(lambda x: 10.0**x))
def test_noise_alone_never_is(seed, size):
    x = size * np.random.default_rng(seed).uniform(0.0, 1.0, 500)
    assert not certified(np.arange(500.0), x)


@given(st.floats(0.7, 3.0), st.floats(0.3, 2.0), st.floats(-9.0, -6.1))
def test_what_rises_again_is_not_certified(fall, rise, end):
    """Past a saddle: the state comes near, and leaves; stopped while it still is below the floor."""
    t = np.linspace(0.0, 60.0, 6000)
    x = np.exp(-fall * t) + 10.0**end * np.exp(rise * (t - t[-1]))
    level = x[t >= 52.5].max()
    assume(np.log(level / x.min()) > 4.5)
    assert not certified(t, x)


@pytest.mark.parametrize("power", [1.0, 2.0])
def test_a_start_from_rest_is_no_decay(power):
    """After 10⁻⁷ of a second from rest speeds are far below any floor; they rise all the same."""
    t = np.linspace(0.0, 1e-7, 20)
    assert not certified(t, (100.0 * t) ** power, floor=1e-3)


@pytest.mark.parametrize(
    "x",
    [np.zeros(50), np.full(50, 1e-30), np.full(50, np.nan), np.where(np.arange(50) == 7, np.nan, 1e-9), np.ones(50)],
    ids=["always 0", "always tiny", "NaN", "one NaN", "constant"],
)
def test_what_was_never_seen_to_fall_certifies_nothing(x):
    assert decay(np.arange(50.0), x, floor=FLOOR).certificate.margin < 0.0


@pytest.mark.parametrize("samples", [1, 2, 3, 8])
def test_few_samples_certify_nothing(samples):
    t = np.linspace(0.0, 50.0, 51)[-samples:]
    assert not certified(t, np.exp(-t))


@given(seeds)
def test_the_margin_moves_little_when_the_run_does(seed):
    rng = np.random.default_rng(seed)
    t = np.sort(rng.uniform(0.0, 40.0, 600))
    x = np.exp(-rng.uniform(0.3, 2.0) * t) * (1.2 + np.cos(t))
    one, two = (decay(t, y, floor=FLOOR).certificate.margin for y in (x, x * (1.0 + 1e-9 * rng.normal(size=t.size))))
    assert one == pytest.approx(two, abs=1e-6)
    assert -1.0 <= one <= 1.0


@pytest.mark.parametrize(("constants", "enough"), [(14.0, False), (14.5, True)])
def test_five_time_constants_are_asked_for(constants, enough):
    """The fall of exp(-Kt) ends e times above its last eighth, after 7K/8 - 1; of its last half seven eighths count."""
    t = np.linspace(0.0, 1.0, 80001)
    found = decay(t, np.exp(-constants * t), floor=1e9)
    assert found.time_constants == pytest.approx(7.0 / 16.0 * (7.0 / 8.0 * constants - 1.0), rel=1e-3)
    assert (found.time_constants > TIME_CONSTANTS) is enough
    assert (found.certificate.margin > 0.0) is enough


def test_a_limit_is_verified_or_open():
    good, bad, lost = Certificate(0.5, "falls"), Certificate(-1.0, "does not"), Certificate(float("nan"), "NaN")
    how = {"computed": 0.0, "stated": "-> 0", "detail": "x"}
    assert limit_claim("i", [], [bad, good], **how).status == "verified"
    assert limit_claim("i", [], [bad, good], **how).detail == "x; falls"
    assert limit_claim("i", [], [bad], **how).status == "inconclusive"
    assert limit_claim("i", [], [lost], **how).status == "inconclusive"
    assert limit_claim("i", [], [lost, good], **how).status == "verified"
    assert limit_claim("i", [Hypothesis("c", "unmet")], [good], **how).status == "vacuous"
