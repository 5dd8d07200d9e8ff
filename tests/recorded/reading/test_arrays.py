"""Arrays in any order of axes, in dictionaries, MATLAB structures and the field's containers; periodic boxes."""

import numpy as np
import pandas as pd
import pytest
import xarray as xr
from scipy.io import savemat

import flockana as fl
from flockana.base.errors import FlockanaError
from flockana.recorded.complete_parts import largest_complete_part

Q = np.random.default_rng(0).random((7, 4, 2))


@pytest.mark.parametrize(
    ("axes", "turned"),
    [("space agent time", Q.transpose(2, 1, 0)), (("n", "T", "m"), Q.transpose(1, 0, 2)), ("Tnm", Q)],
)
def test_axes_that_are_named_come_in_any_order(axes, turned):
    rec = fl.read_recording({"positions": turned}, dt=0.1, axes=axes)
    np.testing.assert_array_equal(rec.q, Q)
    assert f"q from 'positions' {turned.shape}" in repr(rec)


def test_arrays_without_an_axis_need_a_word_on_the_others():
    assert fl.read_recording({"q": Q[:, 0]}, dt=0.1, axes="time axis").q.shape == (7, 1, 2)
    assert fl.read_recording({"q": Q[:, :, 0]}, dt=0.1, axes="time,agent").q.shape == (7, 4, 1)
    for source, how, message in (
        ({"q": Q[:, 0]}, {"dt": 0.1}, "say which axis is which by axes="),
        ({"q": Q.transpose(1, 2, 0)}, {"dt": 0.1}, "has 7 axes if read as"),
        ({"q": Q}, {"dt": 0.1, "axes": "time place"}, "expected time, agent and axis"),
        ({"q": Q}, {"dt": 0.1, "axes": "time axis"}, "axes= names 2"),
        ({"t": np.arange(7.0), "q": Q}, {"dt": 0.1}, "has times, and dt = 0.1 is given"),
        ({"q": Q, "tracks": Q}, {"dt": 0.1}, "'q', 'tracks' may each be q"),
    ):
        with pytest.raises(FlockanaError, match=message):
            fl.read_recording(source, **how)


def test_arrays_of_single_axes_are_joined_and_others_are_said():
    x, y = Q[:, :, 0], Q[:, :, 1]
    rec = fl.read_recording({"X": x, "Y": y, "vx": x + 1, "vy": y + 1, "goal": x}, dt=0.1)
    np.testing.assert_array_equal(rec.q, Q)
    np.testing.assert_array_equal(rec.p, Q + 1)
    assert "q from 'X', 'Y' (7, 4, 2)" in repr(rec)
    assert "not read: 'goal'" in repr(rec)
    for arrays, how in (
        ({"X": x.T, "Y": y.T}, {"axes": "agent time"}),
        ({"a": x, "b": y}, {"columns": {"q": ["a", "b"]}}),
    ):
        np.testing.assert_array_equal(fl.read_recording(arrays, dt=0.1, **how).q, Q)
    alone = fl.read_recording({"time": np.arange(7.0), "X": x[:, 0], "Y": y[:, 0]})
    np.testing.assert_array_equal(alone.q, Q[:, :1])
    for arrays, message in (
        ({"x": x, "y": y[1:]}, "x, y have other shapes"),
        ({"t": np.arange(4.0), "x": x, "y": y}, 'or axes="agent time"'),
        ({"t": np.arange(7.0), "q": Q.transpose(2, 1, 0)}, 'axes="axis agent time", which decides'),
    ):
        with pytest.raises(FlockanaError, match=message):
            fl.read_recording(arrays)


def test_masks_dimensions_frames_and_names_beside_arrays():
    rec = fl.read_recording({"q": np.ma.masked_where(Q > 0.9, Q)}, dt=0.1)
    assert rec.gaps == (Q > 0.9).any(axis=2).sum()
    rec = fl.read_recording({"q": Q, "v": Q, "frames": np.arange(0, 14, 2), "fps": 10.0, "time_ms": np.arange(7)}, m=1)
    np.testing.assert_array_equal(rec.p, Q[..., :1])
    assert rec.t.tolist() == pytest.approx(0.2 * np.arange(7))
    assert "t from 'frames' over fps = 10; not read: 'time_ms'; the first 1 of 2 axes, as m = 1" in repr(rec)
    assert "q from 'q' (7, 4, 2) as (time, agent, axis)" in rec.read_as
    columns = {"time": np.array([0.0, 0.0, 1.001, 1.003, 2.0, 2.0]), "id": [1, 2] * 3, "x": np.arange(6.0)}
    columns["y"] = columns["x"]
    assert fl.read_recording(columns, jitter=0.01, m=1).q[:, :, 0].tolist() == [[0.0, 1.0], [2.0, 3.0], [4.0, 5.0]]
    for how, message in (({"m": 3}, "m = 3: expected 1 to 2"), ({"columns": ["t", "q"]}, "has arrays by name")):
        with pytest.raises(FlockanaError, match=message):
            fl.read_recording({"q": Q}, dt=0.1, **how)


def test_a_second_axis_that_looks_like_the_time_is_asked_for():
    """Without times nothing but smoothness tells (agent, time, axis) from (time, agent, axis)."""
    steps = np.linspace(0.0, 1.0, 30)[:, None, None]
    turn = np.concatenate([np.sin(3 * steps + Q[:1, :3, :1]), np.cos(2 * steps + Q[:1, :3, 1:])], axis=2)
    turn[:4, 1] = np.nan
    assert fl.read_recording({"q": turn}, dt=0.1).q.shape == (30, 3, 2)
    for other in (turn.swapaxes(0, 1), np.moveaxis(turn, 2, 0)):
        with pytest.raises(FlockanaError, match=r'changes little along its second axis.* axes="agent time axis" or'):
            fl.read_recording({"q": other}, dt=0.1)
    lattice = fl.lattice.triangular(400, 7.0)  # neighbours are near in order, too
    for factor, speed in ((0.0, 300.0), (0.01, 0.0)):
        few = np.stack([lattice * (1.0 + factor * k) + speed * k for k in range(4)])
        assert len(fl.read_recording({"q": few}, dt=0.1).t) == 4


class Hostile:
    def __reduce__(self):
        return (print, ("run",))


def test_dictionaries_in_arrays_of_objects_are_read_and_run_nothing(tmp_path, capsys):
    path = tmp_path / "it.npy"
    np.save(path, np.array({"trajectories": Q, "frames_per_second": 20, "version": "6"}, dtype=object))
    rec = fl.read_recording(path)
    assert rec.t[1] == 0.05
    np.testing.assert_array_equal(rec.q, Q)
    np.save(path, np.array({"q": Hostile()}, dtype=object))
    with pytest.raises(FlockanaError, match=r"it holds builtins\.print"):
        fl.read_recording(path)
    assert capsys.readouterr().out == ""
    one, two = ({"name": x, "time": np.arange(4.0 - k), "pos": Q[: 4 - k, k]} for k, x in enumerate("ab"))
    np.save(path, np.array([one, two], dtype=object))
    rec = fl.read_recording(path)
    assert (rec.ids, rec.gaps) == (("a", "b"), 1)
    np.testing.assert_array_equal(rec.q[:3, 1], Q[:3, 1])


def test_files_of_arrays_hold_long_tables_and_structures_too(tmp_path):
    columns = {"time": np.repeat([0.0, 1.0, 2.0], 2), "robot": [1, 2] * 3, "x": np.arange(6.0), "y": np.arange(6.0)}
    np.savez(tmp_path / "it.npz", **columns)
    savemat(tmp_path / "it.mat", columns)
    for name in ("it.npz", "it.mat"):
        assert fl.read_recording(tmp_path / name).q[2, 1].tolist() == [5.0, 5.0]
    tracks = [{"t": [0.0, 1.0, 2.0], "x": [1.0, 2.0, 3.0], "dt": [1.0, 1.0]}, {"t": [1.0, 2.0], "x": [5.0, 6.0]}]
    tracks[1]["dt"] = [1.0]
    savemat(tmp_path / "s.mat", {"tracks": tracks})
    rec = fl.read_recording(tmp_path / "s.mat")
    assert rec.q[:, :, 0].tolist() == [[1.0, pytest.approx(np.nan, nan_ok=True)], [2.0, 5.0], [3.0, 6.0]]
    assert fl.read_recording(pd.DataFrame(columns)).n == 2


def poses(keypoints=("centre",), individuals="individuals", **attrs):
    names = (individuals[:-1] if attrs.pop("singular", False) else individuals), "keypoints"
    data = np.random.default_rng(1).random((5, 2, len(keypoints), 3))
    coords = {"time": np.arange(5) / 30.0, "space": ["x", "y"], names[1]: list(keypoints), names[0]: ["a", "b", "c"]}
    dims = ("time", "space", names[1], names[0])
    return xr.Dataset({"position": (dims, data)}, coords, {"fps": 30, "time_unit": "seconds", **attrs})


def test_datasets_of_movement_are_read_and_given_back(tmp_path):
    """Dimensions time, space, keypoints and individuals (from 0.17 on in the singular), as its pages name them."""
    for ds in (poses(), poses(singular=True)):
        rec = fl.read_recording(ds)
        np.testing.assert_array_equal(rec.q, ds.position.values[:, :, 0].swapaxes(1, 2))
        assert rec.ids == ("a", "b", "c")
    poses().to_netcdf(tmp_path / "it.nc", engine="h5netcdf")
    assert fl.read_recording(tmp_path / "it.nc").ids == ("a", "b", "c")
    with pytest.raises(FlockanaError, match=r"2 keypoints of each .* ds.sel\(keypoints='nose'\)"):
        fl.read_recording(poses(("nose", "tail")))
    other = xr.Dataset({"pos": (("agent", "time", "coord"), Q.swapaxes(0, 1))}, {"time": np.arange(7.0)})
    np.testing.assert_array_equal(fl.read_recording(other).q, Q)
    with pytest.raises(FlockanaError, match="position is over time, space_pol, individuals: expected time, agent and"):
        fl.read_recording(poses().isel(keypoints=0).rename(space="space_pol"))
    frames = poses(time_unit="frames").assign_coords(time=np.arange(5))
    del frames.attrs["fps"]
    with pytest.raises(FlockanaError, match="no times: expected t, or dt="):
        fl.read_recording(frames)
    assert fl.read_recording(frames, dt=0.5).t[-1] == 2.0
    for ds in (poses().sortby("space", ascending=False), poses().isel(keypoints=0).transpose("space", ...)):
        np.testing.assert_array_equal(fl.read_recording(ds).q, rec.q)  # y before x, and space before time
    axes = {name: (("id", "time"), rec.q[:, :, k].T) for k, name in enumerate("xy")}
    np.testing.assert_array_equal(fl.read_recording(xr.Dataset(axes, {"time": rec.t})).q, rec.q)
    back = fl.read_recording(rec.to_xarray())
    np.testing.assert_array_equal(back.q, rec.q)
    assert rec.to_xarray().position.dims == ("time", "space", "individuals")
    assert rec.to_xarray().attrs["fps"] == pytest.approx(30.0)


def test_positions_are_unwrapped_from_a_box_or_refused():
    rng = np.random.default_rng(2)
    true = rng.random((3, 2)) + np.cumsum(rng.normal([0.08, -0.05], 0.01, (60, 3, 2)), axis=0)
    wrapped = np.mod(true, [1.0, 0.7])
    rec = fl.read_recording({"q": wrapped}, dt=1.0, box=(1.0, 0.7))
    np.testing.assert_allclose(rec.q - rec.q[0], true - true[0], atol=1e-12)
    assert "unwrapped from a box of 1, 0.7" in repr(rec)
    one_way = np.stack([wrapped[..., 0], true[..., 1]], axis=2)
    tube = fl.read_recording({"q": one_way}, dt=1.0, box=(1.0, np.inf))
    np.testing.assert_allclose(tube.q - tube.q[0], true - true[0], atol=1e-12)
    with pytest.raises(FlockanaError, match="half of the period 1 or more"):
        fl.read_recording({"q": rng.random((60, 3, 2))}, dt=1.0, box=1.0)
    hidden = wrapped.copy()
    hidden[20:30, 1] = np.nan  # it may have gone round meanwhile
    with pytest.raises(FlockanaError, match=r"agent 1 may move by .* from t = 19 to 30"):
        fl.read_recording({"q": hidden}, dt=1.0, box=(1.0, 0.7))
    fast = np.cumsum(np.full((20, 1, 1), 0.8), axis=0)
    known = fl.read_recording({"q": np.mod(fast, 1.0), "p": np.full((20, 1, 1), 0.8)}, dt=1.0, box=1.0)
    np.testing.assert_allclose(known.q - known.q[0], fast - fast[0], atol=1e-12)
    with pytest.raises(FlockanaError, match=r"extend over .* along x: expected wrapped ones; give the box in the unit"):
        fl.read_recording({"q": wrapped}, dt=1.0, box=0.5)
    with pytest.raises(FlockanaError, match="box = 0: expected a period > 0"):
        fl.read_recording({"q": wrapped}, dt=1.0, box=0)


def test_the_complete_part_has_the_most_positions_of_all():
    """By trying every window and every set of agents that is there throughout."""
    rng = np.random.default_rng(3)
    for _ in range(40):
        present = rng.random((9, 5)) < 0.75
        window, agents = largest_complete_part(present)
        assert present[window][:, agents].all()
        most = max((b - a) * int(present[a:b].all(axis=0).sum()) for a in range(9) for b in range(a + 1, 10))
        assert (window.stop - window.start) * len(agents) == most


def test_visitors_are_measured_selected_and_left_out():
    t, q = np.arange(12.0), np.full((12, 3, 1), np.nan)
    q[:, 0, 0], q[:3, 1, 0], q[6:11, 2, 0] = 0.1 * t, 7.0, 5.0 + t[6:11]
    q[4, 0] = np.nan
    rec = fl.Recording(t, q, bound=1e-3, ids=("stays", "goes", "comes"))
    seen = rec.metrics(d=7.0, r=8.4)
    assert seen["agents"].values.tolist() == [2, 2, 2, 1, 0, 1, 2, 2, 2, 2, 2, 1]
    assert np.isnan(seen["cohesion_radius"].values[4])
    assert seen["cohesion_radius"].values[0] == pytest.approx(3.5)
    assert rec.window(5.0, 11.0).ids == ("stays", "comes")
    assert rec.select(agents=["goes"], samples=slice(0, 2)).n == 1
    with pytest.raises(FlockanaError, match="unknown agent 'nobody'"):
        rec.select(agents=["nobody"])
    part = rec.complete()
    assert (part.ids, part.t[0], part.t[-1]) == (("stays", "comes"), 6.0, 10.0)
