"""Bounds on a flock between samples, against the same run looked at a thousand times as often."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import flockana as fl
from flockana.lattice import hexagonal_patch
from flockana.theorems.sampling import mismatch_between, stretch_between

COARSE = np.linspace(0.0, 3.0, 7)


@pytest.fixture(scope="module")
def runs():
    """(a few samples of a flock that swings, many of the same)."""
    law = fl.Algorithm2(gains=fl.Gains(c2_alpha=0.1, c2_gamma=0.0), target=fl.StaticTarget((0.0, 0.0)))
    q = 1.1 * hexagonal_patch(1, 7.0)
    p = np.random.default_rng(0).normal(0.0, 2.0, q.shape)
    fine = np.linspace(0.0, 3.0, 3001)
    return tuple(fl.simulate(law, q, p, (0.0, 3.0), t_eval=times) for times in (COARSE, fine))


def largest(series):
    """In each interval between the coarse samples."""
    return np.array([series[500 * k : 500 * (k + 1) + 1].max() for k in range(6)])


def test_the_mismatch_is_bounded_and_not_by_much(runs):
    coarse, fine = runs
    true, bound = largest(fine.metric("normalised_velocity_mismatch")), mismatch_between(coarse)
    assert np.all(bound >= true * (1.0 - 1e-9))
    assert np.all(bound <= 1.05 * true)
    at_ends = coarse.metric("normalised_velocity_mismatch")
    assert np.any(true > 1.2 * np.maximum(at_ends[:-1], at_ends[1:]))  # which samples alone would miss


def test_no_distance_strays_further_than_its_bound(runs):
    coarse, fine = runs
    i, j = np.triu_indices(coarse.n, 1)
    lengths = np.linalg.norm(fine.q[:, i] - fine.q[:, j], axis=2)
    for k, bound in enumerate(stretch_between(coarse)):
        part = lengths[500 * k : 500 * (k + 1) + 1]
        low, high = np.minimum(part[0], part[-1]), np.maximum(part[0], part[-1])
        assert max((low - part).max(), (part - high).max()) <= bound


def test_where_steps_were_not_kept_speeds_are_unknown(runs):
    coarse, _ = runs
    slack = np.zeros((len(coarse.path.t) - 1, coarse.n))
    slack[0, 3] = 1e-12
    thin = replace(coarse, between=replace(coarse.between, slack=slack))
    bound = mismatch_between(thin)
    assert bound[0] == np.inf
    np.testing.assert_array_equal(bound[1:], mismatch_between(coarse)[1:])
