"""Numbers that stand for 'not seen' are refused with both readings, or gaps where they are stated; positions stay."""

import numpy as np
import pytest

import flockana as fl
from flockana.base.errors import FlockanaError


def walks(low=0.0, size=1.0, m=2, count=120):
    """Four agents on random walks of small steps."""
    rng = np.random.default_rng(4)
    steps = np.cumsum(rng.normal(0.0, 0.01, (count, 4, m)), axis=0)
    return low + size * (0.2 + 0.6 * rng.random((1, 4, m)) + steps)


# value, samples, agents and axes where it stands, the walks
LOST = [
    (-9999.0, (slice(30, 40), 1), {}),
    (9999.0, (slice(0, 60), 2), {"low": 400.0, "size": 600.0}),
    (1e30, (50, [1, 2]), {}),
    (-999.25, (slice(30, 32), 1), {}),
    (-99.0, (70, 0), {}),  # once, along both axes
    (-1.0, (slice(30, 40), 1), {"low": 500.0, "size": 300.0}),
    (-1.0, (slice(None), 3), {"low": 500.0, "size": 300.0}),
    (0.0, (slice(30, 60), 1), {"low": -1.0, "size": 2.0, "m": 3}),
    (-9999.0, (slice(30, 33), 1, 2), {"m": 3}),  # the depth alone
    (-1.0, (slice(30, 40), 1), {"low": 5.0, "m": 1}),
    (0.0, (50, 1, 2), {"low": 2.0, "size": 8.0, "m": 3}),  # the depth alone, once
    (0.0, (0, 1, 2), {"low": 2.0, "size": 8.0, "m": 3}),  # at the first sample
    (-1.0, (119, 2, 1), {"low": 100.0}),  # at the last
    (-1.0, (slice(None), 3), {"low": -3.0, "size": 6.0}),  # where others are, too
    (-1.0, (slice(None), 3), {"low": 5.0, "m": 1}),
    (-1.0, (slice(None), slice(None)), {}),
    (-9999.0, (slice(None), slice(None)), {}),
]


@pytest.mark.parametrize(("value", "at", "how"), LOST)
def test_what_looks_like_not_seen_is_refused_and_the_argument_decides(value, at, how):
    q = walks(**how)
    q[at] = value
    with pytest.raises(FlockanaError, match="agents that were not seen, or be a position") as refused:
        fl.read_recording({"q": q}, dt=0.1)
    argument = f"missing={value!r}".removesuffix(".0")
    assert f"expected {argument}, or missing=() if" in str(refused.value)
    np.testing.assert_array_equal(fl.read_recording({"q": q}, dt=0.1, missing=()).q, q)
    if isinstance(at[0], slice) and at[0] == slice(None):
        return  # an agent that is never seen
    rec = fl.read_recording({"q": q}, dt=0.1, missing=value)
    assert (rec.q != value).all()
    assert rec.gaps == np.zeros(q.shape[:2])[at[:2]].size
    assert f"{rec.gaps} positions that are {value:g} are gaps" in rec.read_as


def test_several_numbers_velocities_and_a_flat_axis():
    q = walks(m=3)
    q[:, :, 2] = 0.0
    q[30:35, 1, :2], q[60:62, 0, :2] = -1.0, -9999.0
    p = np.gradient(q, axis=0)
    with pytest.raises(FlockanaError, match=r"q is -1 at 5 places"):
        fl.read_recording({"q": q}, dt=0.1, missing=-9999.0)
    rec = fl.read_recording({"q": q, "p": p}, dt=0.1, missing=[-1, -9999])
    assert rec.gaps == 7
    assert np.isnan(rec.p[30:35, 1]).all()
    p = np.gradient(walks(), axis=0)
    p[80:90, 2] = 9999.0
    with pytest.raises(FlockanaError, match=r"p is 9999 at 10 places.*or be a velocity"):
        fl.read_recording({"q": walks(), "p": p}, dt=0.1)
    assert np.isnan(fl.read_recording({"q": walks(), "p": p}, dt=0.1, missing=9999).p[80:90, 2]).all()
    for missing in ("a", [1.0, None]):
        with pytest.raises(FlockanaError, match="expected numbers that stand for"):
            fl.read_recording({"q": q}, dt=0.1, missing=missing)


def odometry(rng):
    """All robots stand at 0 for a while, then drive."""
    return np.cumsum(np.where(np.arange(90)[:, None, None] < 20, 0.0, rng.normal(0.05, 0.01, (90, 4, 2))), axis=0)


def beacon(rng):
    """An agent stands far away."""
    return np.where(np.arange(4)[None, :, None] == 3, 100.0, walks())


POSITIONS = {
    "odometry": odometry,
    "beacon": beacon,
    "origin": lambda rng: np.where(np.arange(4)[None, :, None] == 3, 0.0, walks(low=5.0)),
    "grid": lambda rng: rng.integers(0, 9, (1, 6, 2)) + np.cumsum(rng.integers(-1, 2, (200, 6, 2)), axis=0),
    "ring": lambda rng: np.mod(np.cumsum(rng.integers(-1, 2, (200, 6, 1)), axis=0), 10),
    "wrapped": lambda rng: np.mod(np.cumsum(rng.normal(0.0, 0.05, (200, 4, 2)), axis=0), 1.0),
    "parked": lambda rng: np.minimum(0.1 * np.arange(90.0)[:, None, None] + np.arange(3.0)[:, None], 5.0),
    "released": lambda rng: (1.0 - np.exp(-0.3 * np.arange(90.0)))[:, None, None] * rng.normal(size=(4, 2)),
    "a step": lambda rng: np.where(np.arange(60) < 40, 0.0, 200.0)[:, None, None] + [[0.0], [1.0]],
    "columns of an index": lambda rng: np.stack(np.broadcast_arrays(np.arange(9.0), np.arange(4.0)[:, None]), 2),
    "ground vehicle": lambda rng: np.where(np.arange(12).reshape(4, 3) == 2, 0.0, walks(low=10.0, m=3)),
    "take-off": lambda rng: np.maximum(np.arange(90.0) - 20.0, 0.0)[:, None, None] * 0.1 * rng.random((4, 3)),
    "a lattice at rest": lambda rng: np.tile(np.mgrid[-1:2, -1:2].reshape(2, 9).T, (20, 1, 1)),
    "an instant": lambda rng: np.array([[[0.0, 0.0], [1.0, 0.0], [100.0, 100.0]]]),
}


@pytest.mark.parametrize("kind", POSITIONS)
def test_positions_that_repeat_are_positions(kind):
    q = POSITIONS[kind](np.random.default_rng(1))
    np.testing.assert_array_equal(fl.read_recording({"q": q}, dt=0.1, axes="time agent axis").q, q)


def test_files_too(tmp_path):
    q = walks(low=100.0, size=500.0)
    q[10:14, 1] = -1.0
    rows = [f"{k},{i},{q[k, i, 0]},{q[k, i, 1]}" for k in range(len(q)) for i in range(4)]
    (tmp_path / "it.csv").write_text("t,id,x,y\n" + "\n".join(rows) + "\n")
    with pytest.raises(FlockanaError, match=r"it.csv: q is -1 at 4 places \(agent 1 at t = 10 first\)"):
        fl.read_recording(tmp_path / "it.csv")
    assert fl.read_recording(tmp_path / "it.csv", missing=-1).gaps == 4
    saved = fl.read_recording(tmp_path / "it.csv", missing=()).save(tmp_path / "it.npz")
    assert fl.read_recording(saved).gaps == 0  # its gaps are NaN
