"""Counter-based noise against SplitMix64 in whole numbers of Python, and its first moments."""

from fractions import Fraction

import numpy as np
import pytest

from flockana import Trajectory, ZoneFlocking, ZoneNoise, simulate
from flockana.kernels.random_noise import noise
from tests.refused import refused

ALL = 2**64 - 1


def uniform(*words):
    """The same number, exactly; its odd numerator shows that neither end is ever reached."""
    state = 0
    for word in words:
        state = (state + 0x9E3779B97F4A7C15 * (word + 1)) & ALL
        state = ((state ^ (state >> 30)) * 0xBF58476D1CE4E5B9) & ALL
        state = ((state ^ (state >> 27)) * 0x94D049BB133111EB) & ALL
        state ^= state >> 31
    exact = Fraction(2 * (state >> 12) + 1, 2**52) - 1
    assert -1 < exact < 1
    assert Fraction(float(exact)) == exact, "a float cannot hold it"
    return float(exact)


@pytest.mark.parametrize("words", [(0, 0, 0, 0, 0), (3, 10**6, 499, 498, 6), (2**63 - 1, 1, 2, 3, 4)])
def test_it_is_splitmix64(words):
    assert noise(*words) == uniform(*words)


def test_splitmix64_itself():
    """Its first output from state 0 is published: 0xE220A8397B1DCDAF."""
    z = 0x9E3779B97F4A7C15
    z = ((z ^ (z >> 30)) * 0xBF58476D1CE4E5B9) & ALL
    z = ((z ^ (z >> 27)) * 0x94D049BB133111EB) & ALL
    assert z ^ (z >> 31) == 0xE220A8397B1DCDAF


def test_every_word_counts_and_they_do_not_commute():
    words = (5, 4, 3, 2, 1)
    others = [tuple(w + (k == at) for k, w in enumerate(words)) for at in range(5)] + [(4, 5, 3, 2, 1), (5, 4, 2, 3, 1)]
    assert len({noise(*one) for one in [words, *others]}) == 8


@pytest.mark.parametrize("varied", range(5))
def test_moments_along_every_word(varied):
    """Mean 0, variance 1/3, no correlation with the next: of 20000 numbers each to six of its standard errors."""
    words = [7, 6, 5, 4, 3]
    found = []
    for k in range(20000):
        words[varied] = k
        found.append(noise(*words))
    x = np.array(found)
    error = 6.0 / np.sqrt(x.size)
    assert abs(x.mean()) < error / np.sqrt(3.0)
    assert abs((x**2).mean() - 1.0 / 3.0) < error * np.sqrt(4.0 / 45.0)
    assert abs((x[1:] * x[:-1]).mean()) < error / 3.0


def a_run(seed, law=ZoneFlocking):
    rng = np.random.default_rng(0)
    noisy = law(noise=ZoneNoise(weights=0.5, velocities=0.1, seed=seed))
    return simulate(noisy, rng.uniform(0.0, 10.0, (10, 2)), rng.uniform(0.0, 1.0, (10, 2)), (0.0, 30.0))


def test_runs_repeat_and_are_saved_with_their_noise(tmp_path):
    run, other = a_run(1), a_run(2)
    np.testing.assert_array_equal(run.q, a_run(1).q)
    assert np.abs(run.q[1] - other.q[1]).max() > 1e-4
    assert run.extra["step"].tolist() == list(range(301))
    again = Trajectory.load(run.save(tmp_path / "run.nc"))
    assert again.law == run.law
    assert again.law.noise.seed == 1
    k = 273  # from the middle of a saved run on: what the step needs is in its memory
    memory = {name: series[k] for name, series in again.extra.items()}
    np.testing.assert_array_equal(again.law.step(run.t[k], run.q[k], run.p[k], memory)[0], run.q[k + 1])


def test_no_noise_is_no_change():
    rng = np.random.default_rng(3)
    start = rng.uniform(0.0, 10.0, (10, 2)), rng.uniform(0.0, 1.0, (10, 2)), (0.0, 5.0)
    plain = simulate(ZoneFlocking(), *start)
    np.testing.assert_array_equal(simulate(ZoneFlocking(noise=ZoneNoise(seed=9)), *start).q, plain.q)
    assert set(plain.extra) == {"heading", "estimate"}


test_bad_noise = refused(
    ({"weights": 1.5}, "weights = 1.5: expected at most 1"),
    ({"velocities": -1.0}, "velocities = -1: expected a number >= 0"),
    ({"seed": -1}, "seed = -1: expected a whole number"),
    ({"seed": 2**63}, "expected a whole number"),
    ({"seed": 1.0}, "seed = 1.0: expected a whole number"),
    make=ZoneNoise,
)


test_the_law_wants_its_own_kind = refused(
    (lambda: ZoneFlocking(noise=0.5), r"noise = 0\.5: expected a ZoneNoise"),
    (lambda: ZoneFlocking(growth=-1.0), "growth = -1: expected a number >= 0"),
)
