"""A run of a map that was edited anywhere is refused; one that was not is judged, whatever machine computed it."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

import flockana as fl
from flockana import SemiImplicitEuler, Trajectory
from flockana.base.errors import ArgumentError
from flockana.base.integrity_seals import sealed
from flockana.theorems.map_steps import ensure_steps_of_map

_NEAR, _TURNED = [[1.0, 1.0], [1.0, 1.0], [2.0, 2.0]], [[0.1, 0.0], [0.0, 0.1], [-0.1, 0.0]]


@cache
def runs():
    """Runs of headings, and of the dead zone sampled each 25th step: the steps between two samples were not kept."""
    places, speeds = [[0.0, 0.0], [5.0, 0.0], [3.0, 6.0]], [[1.0, 0.0], [0.0, 2.0], [-1.0, 0.0]]
    law = SemiImplicitEuler(fl.DeadZoneFlocking(), dt=0.02)
    headings = fl.simulate(fl.HeadingAveraging(1.0, 0.1), _NEAR, _TURNED, (0, 100))
    return headings, fl.simulate(law, places, speeds, (0.0, 20.0), t_eval=np.arange(0.0, 20.1, 0.5))


def test_a_map_that_is_another_function_each_time_is_told():
    for run, k in zip((*runs(), runs()[0]), (1, 1, -1), strict=True):
        q = run.q.copy()
        q[k] += 1e-5
        with pytest.raises(ArgumentError, match=r"q at t = .* is off by .* expected a law that is the same function"):
            fl.verify("dead-zone-1-printed", sealed(replace(run, q=q)))


def test_one_that_was_saved_is_as_good(tmp_path):
    for run in runs():
        run.save(tmp_path / "run.nc")
        ensure_steps_of_map(Trajectory.load(tmp_path / "run.nc"))


def test_rounding_that_grows_between_samples_accuses_nobody():
    law, q, p = SemiImplicitEuler(fl.Algorithm1(), dt=0.05), np.array([[0.0], [5.0], [9.0]]), np.zeros((3, 1))
    t, states = np.arange(0.0, 3.0, 0.5), [(q, p, np.zeros((3, 1)))]
    for k in range(50):
        q, p, u, _ = law.step(0.05 * k, q, p, {})
        q = q * (1.0 + 1e-15 * (-1.0) ** k)
        if k % 10 == 9:
            states.append((q, p, u))
    made = [np.stack(series) for series in zip(*states, strict=True)]
    ensure_steps_of_map(Trajectory(t, *made, law))
