"""A run of a map that was edited anywhere is refused; one that was not is judged, whoever computed it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import flockana as fl
from flockana.base.errors import ArgumentError
from flockana.dynamics.trajectory import Trajectory
from flockana.laws.semi_implicit import SemiImplicitEuler
from flockana.theorems.map_steps import ensure_steps_of_map

_HEADINGS = fl.simulate(
    fl.HeadingAveraging(1.0, 0.1), [[1.0, 1.0], [1.0, 1.0], [2.0, 2.0]], [[0.1, 0.0], [0.0, 0.1], [-0.1, 0.0]], (0, 100)
)
_DEAD_ZONE = fl.simulate(
    SemiImplicitEuler(fl.DeadZoneFlocking(), dt=0.02),
    [[0.0, 0.0], [5.0, 0.0], [3.0, 6.0]],
    [[1.0, 0.0], [0.0, 2.0], [-1.0, 0.0]],
    (0.0, 20.0),
    t_eval=np.arange(0.0, 20.1, 0.5),  # every 25th step: between two samples are steps that were not kept
)


def edited(run: Trajectory, name: str, k: int, by: float) -> Trajectory:
    series = (run.extra[name] if name in run.extra else getattr(run, name)).copy()
    series[k].flat[0] += by
    if name in run.extra:
        return replace(run, extra={**run.extra, name: series})
    return replace(run, **{name: series})


@pytest.mark.parametrize("k", [1, 7, 25, 40])
@pytest.mark.parametrize("by", [1e-5, 1.0, 1e3])
@pytest.mark.parametrize(
    ("run", "name"), [(_HEADINGS, name) for name in ("q", "p", "u", "heading")] + [(_DEAD_ZONE, name) for name in "qpu"]
)
def test_an_edit_of_any_number_of_any_sample_is_told(run, name, k, by):
    with pytest.raises(ArgumentError, match=r"at t = [\d.]+ is off by .* leads from the sample at t = .* edited"):
        ensure_steps_of_map(edited(run, name, k, by))


def test_an_edit_of_the_last_and_of_the_first_sample_is_told():
    for run in (_HEADINGS, _DEAD_ZONE):
        for k in (0, -1):
            with pytest.raises(ArgumentError, match="is off by"):
                ensure_steps_of_map(edited(run, "q", k, 1e-3))


def test_times_between_steps_and_a_lost_memory_are_told():
    t = _DEAD_ZONE.t.copy()
    t[5] += 0.01
    with pytest.raises(ArgumentError, match=r"2 and 2.51 are 25.5 steps of 0.02 apart, and between its steps a map"):
        ensure_steps_of_map(replace(_DEAD_ZONE, t=t))
    with pytest.raises(ArgumentError, match=r"no extra\['heading'\], which HeadingAveraging remembers"):
        ensure_steps_of_map(replace(_HEADINGS, extra={}))


def test_a_verdict_that_an_edit_would_turn_is_not_given():
    assert fl.verify("jlm-headings", _HEADINGS).status == "verified"
    with pytest.raises(ArgumentError, match=r"heading at t = 25 is off by 0\.3"):
        fl.verify("jlm-headings", edited(_HEADINGS, "heading", 25, 0.3))


def test_one_that_was_saved_is_as_good(tmp_path):
    for run in (_HEADINGS, _DEAD_ZONE):
        run.save(tmp_path / "run.nc")
        ensure_steps_of_map(Trajectory.load(tmp_path / "run.nc"))


def test_rounding_that_grows_between_samples_accuses_nobody():
    """As other machine code makes it, which rounds otherwise in each step, where the map forgets nothing."""
    law, q, p = SemiImplicitEuler(fl.Algorithm1(), dt=0.05), np.array([[0.0], [5.0], [9.0]]), np.zeros((3, 1))
    t, states = np.arange(0.0, 3.0, 0.5), [(q, p, np.zeros((3, 1)))]
    for k in range(50):
        q, p, u, _ = law.step(0.05 * k, q, p, {})
        q = q * (1.0 + 1e-15 * (-1.0) ** k)
        if k % 10 == 9:
            states.append((q, p, u))
    made = [np.stack(series) for series in zip(*states, strict=True)]
    ensure_steps_of_map(Trajectory(t, *made, law))
