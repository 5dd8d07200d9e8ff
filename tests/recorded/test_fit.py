"""Gains fitted to recordings: to the last digits of exact ones, within their stated intervals of noisy ones."""

from dataclasses import replace

import numpy as np
import pytest

import flockana as fl
from flockana.base.errors import ArgumentError, UnknownNameError

TRUE = fl.Gains(c1_alpha=20.0, c2_alpha=6.0, c1_gamma=1.5, c2_gamma=1.0)
NAMES = ("c1_alpha", "c2_alpha", "c1_gamma", "c2_gamma")


def made(n, seconds, noise, seed):
    rng = np.random.default_rng(seed)
    q0 = fl.lattice.triangular(n, 7.0) + rng.normal(0.0, 1.0, (n, 2))
    law = fl.Algorithm2(gains=TRUE, target=fl.StaticTarget((10.0, 10.0)))
    t = np.arange(round(seconds / 0.02) + 1) * 0.02
    run = fl.simulate(law, q0, rng.normal(0.0, 1.0, (n, 2)), (0.0, t[-1]), t_eval=t)
    q = run.q + rng.normal(0.0, noise, run.q.shape)
    return law, run, fl.Recording(t, q, sd=noise) if noise else fl.Recording(t, q, run.p, bound=1e-8)


def test_gains_of_an_exact_recording_are_found_from_sample_to_sample():
    law, _, rec = made(5, 1.0, 0.0, 0)
    found = fl.fit(rec, replace(law, gains=fl.Gains()))
    for name in NAMES:
        assert found.values[name] == pytest.approx(getattr(TRUE, name), rel=1e-6)
        assert getattr(found.law.gains, name) == found.values[name]
    assert found.untold == ()
    guess = replace(law, alpha=fl.AlphaInteraction(d=6.7, r=8.4))
    assert fl.fit(rec, guess, free=("alpha.d",)).values["alpha.d"] == pytest.approx(7.0, rel=1e-6)


def test_gains_of_noisy_positions_lie_within_a_few_standard_errors():
    law, _, rec = made(7, 2.0, 0.07, 1)
    found = fl.fit(rec, replace(law, gains=fl.Gains()))
    off = [(found.values[name] - getattr(TRUE, name)) / found.errors[name] for name in NAMES]
    assert np.abs(off).max() < 3.5
    assert found.misfit == pytest.approx(1.0, abs=0.15)
    assert found.errors["c1_alpha"] < 0.2 * TRUE.c1_alpha
    assert np.ptp(found.intervals["c1_alpha"]) == pytest.approx(2.0 * 1.96 * found.errors["c1_alpha"], rel=0.02)


def test_what_the_data_cannot_tell_is_said():
    """Agents far apart never feel each other: the pair gains are not told, the pull is."""
    t = np.linspace(0.0, 1.0, 21)
    law = fl.Algorithm2(gains=TRUE, target=fl.StaticTarget((0.0, 0.0)))
    run = fl.simulate(law, [[0.0, 0.0], [900.0, 0.0], [0.0, 900.0]], np.zeros((3, 2)), (0.0, 1.0), t_eval=t)
    rec = fl.Recording(t, run.q + np.random.default_rng(0).normal(0.0, 0.01, run.q.shape), sd=0.01)
    found = fl.fit(rec, law, free=("c1_gamma",))
    assert found.values["c1_gamma"] == pytest.approx(1.5, rel=0.01)
    unseen = fl.fit(rec, law, free=("c1_alpha", "c1_gamma"))
    assert any("do not tell c1_alpha" in text for text in unseen.untold)


def test_wrong_names_and_maps_are_refused():
    law, _, rec = made(5, 0.2, 0.0, 0)
    with pytest.raises(UnknownNameError, match="c1_alfa"):
        fl.fit(rec, law, free=("c1_alfa",))
    with pytest.raises(ArgumentError, match="expected names of parameters, each once"):
        fl.fit(rec, law, free=("c1_alpha", "c1_alpha"))
    with pytest.raises(ArgumentError, match="TaylorStep is a map"):
        fl.fit(rec, fl.TaylorStep(law, 0.02))
    with pytest.raises(ArgumentError, match="expected a parameter that is one number"):
        fl.fit(rec, law, free=("target",))


@pytest.mark.attack  # a hundred fits of four seconds
@pytest.mark.timeout(2300)
def test_of_100_seeds_89_to_99_are_inside_each_95_percent_interval():
    """5 s of 30 agents, a sample every 0.02 s, noise 0.01 d: the intervals hold the truth as often as they say."""
    inside = dict.fromkeys(NAMES, 0)
    for seed in range(100):
        law, _, rec = made(30, 5.0, 0.07, seed)
        intervals = fl.fit(rec, law).intervals
        for name in NAMES:
            low, high = intervals[name]
            inside[name] += low <= getattr(TRUE, name) <= high
    assert all(89 <= count <= 99 for count in inside.values()), inside
