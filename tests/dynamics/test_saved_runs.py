"""Files of runs against damage: whatever happens to the bytes, the numbers are those that were saved, or none."""

import json
import os
from dataclasses import replace

import numpy as np
import pytest
import xarray

from flockana import Algorithm1, Trajectory, simulate
from flockana.base.errors import FileError
from flockana.base.integrity_seals import is_sealed

SERIES = ("t", "q", "p", "u")
RUN = simulate(Algorithm1(), [[0.0], [8.0], [15.0]], np.zeros((3, 1)), (0.0, 1.0), t_eval=np.linspace(0.0, 1.0, 5))


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    return RUN.save(tmp_path_factory.mktemp("saved") / "run.nc").read_bytes()


def same(run, other):
    assert all(np.array_equal(getattr(run, name), getattr(other, name)) for name in SERIES)
    assert all(np.array_equal(getattr(run.between, name), getattr(other.between, name)) for name in SERIES)
    assert np.array_equal(run.extra["work"], other.extra["work"])
    assert (run.law, run.status, run.message) == (other.law, other.status, other.message)
    assert dict(run.stats) == dict(other.stats)


def refused(path, content):
    """Whether such a file is refused; if not, it holds the same run."""
    path.write_bytes(content)
    try:
        run = Trajectory.load(path)
    except FileError as error:
        return "run the simulation again" in str(error) or "was it written by Trajectory.save" in str(error)
    same(run, RUN)
    return False


def test_no_flipped_bit_gives_other_numbers(whole, tmp_path):
    path, line = tmp_path / "run.nc", len(whole) - 90
    places = [*range(0, line, line // 250), *range(line, len(whole))]
    bits = np.random.default_rng(0).integers(8, size=len(places)).tolist()
    outcomes = []
    for place, bit in zip(places, bits, strict=True):
        flipped = bytearray(whole)
        flipped[place] ^= 1 << bit
        outcomes.append(refused(path, bytes(flipped)))
    assert all(outcomes[: len(outcomes) - 90])  # within the netCDF every one is seen
    assert sum(outcomes) >= len(outcomes) - 20  # in the line after it, those that leave it no such line do no harm


def test_no_shortened_or_longer_file_gives_other_numbers(whole, tmp_path):
    path = tmp_path / "run.nc"
    assert all(refused(path, whole[:length]) for length in range(0, len(whole) - 100, len(whole) // 40))
    assert all(refused(path, whole[:-cut]) for cut in range(1, 65))
    assert refused(path, whole + b"\n")
    assert refused(path, whole + whole)


@pytest.mark.slow
@pytest.mark.parametrize("bit", [0, 7, 31, 62])
def test_without_that_line_the_checksums_name_what_is_damaged(tmp_path, bit):
    """As where another program wrote the file anew."""
    RUN.save(tmp_path / "run.nc")
    with xarray.open_dataset(tmp_path / "run.nc", engine="h5netcdf") as opened:
        data = opened.load()
    path = tmp_path / "anew.nc"
    data.to_netcdf(path, engine="h5netcdf")
    same(Trajectory.load(path), RUN)
    data.q.values.view(np.int64)[2, 1, 0] ^= 1 << bit
    data.to_netcdf(path, engine="h5netcdf")
    with pytest.raises(FileError, match="is damaged: q not as saved, by the checksums"):
        Trajectory.load(path)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("change", "named"),
    [
        (lambda data: data.drop_vars("extra_work"), "extra"),
        (lambda data: data.drop_vars([f"between_{name}" for name in SERIES]), "between"),
        (lambda data: data.assign(extra_more=("time", data.time.values)), "extra"),
        (lambda data: data.assign_attrs(message="all is well"), "message"),
        (lambda data: data.assign_attrs(status="interrupted"), "status"),
        (lambda data: data.assign_attrs(law=data.attrs["law"].replace("7.0", "7.5")), "law"),
        (lambda data: data.assign_attrs(stats=data.attrs["stats"].replace("1e-08", "1e-07")), "stats"),
        (lambda data: data.assign_attrs(made_by="hand"), "made_by"),
        (lambda data: data.assign_attrs(seal=json.dumps({})), "between, extra, law, made_by, message, p, q, stats"),
        *((lambda data, name=name: data.assign({name: np.nextafter(data[name], 9.0)}), name) for name in "qpu"),
        (lambda data: data.assign(between_q=np.nextafter(data.between_q, 9.0)), "between"),
        (lambda data: data.assign_coords(time=np.nextafter(data.time, 9.0)), "t"),
    ],
)
def test_what_is_left_out_added_or_told_otherwise_is_named(tmp_path, change, named):
    RUN.save(tmp_path / "run.nc")
    with xarray.open_dataset(tmp_path / "run.nc", engine="h5netcdf") as opened:
        data = opened.load()
    change(data).to_netcdf(tmp_path / "changed.nc", engine="h5netcdf")
    with pytest.raises(FileError, match=f"is damaged: .*{named}.* not as saved"):
        Trajectory.load(tmp_path / "changed.nc")


@pytest.mark.parametrize(("taken", "message"), [("seal", "it has no seal"), ("made_by", "KeyError")])
def test_a_file_whose_seal_was_taken_out_is_refused(tmp_path, taken, message):
    data, path = RUN.to_xarray(), tmp_path / "run.nc"
    data.to_netcdf(path, engine="h5netcdf")
    same(Trajectory.load(path), RUN)
    del data.attrs[taken]
    data.to_netcdf(path, engine="h5netcdf")
    with pytest.raises(FileError, match=f"is damaged: {message}"):
        Trajectory.load(path)


def test_what_a_dataset_was_changed_to_is_validated_like_what_is_made(tmp_path):
    data, path = RUN.to_xarray(), tmp_path / "changed.nc"
    for values, message in ((np.nan, "expected finite"), (1e400, "expected finite")):
        edited = data.copy(deep=True)
        edited.q.values[1, 0, 0] = values
        edited.to_netcdf(path, engine="h5netcdf")
        with pytest.raises(FileError, match=message):
            Trajectory.load(path)
    data.isel(time=slice(None, None, -1)).to_netcdf(path, engine="h5netcdf")
    with pytest.raises(FileError, match="expected rising times"):
        Trajectory.load(path)
    data.isel(agent=slice(0, 0)).to_netcdf(path, engine="h5netcdf")
    with pytest.raises(FileError, match="expected T >= 1 samples of n >= 1 agents"):
        Trajectory.load(path)


def test_a_recording_is_saved_and_comes_back_as_one(tmp_path):
    """What was made or edited by hand: its numbers are whole, and it is no run before or after."""
    for made in (Trajectory(RUN.t, RUN.q, RUN.p, RUN.u, RUN.law), replace(RUN, q=2.0 * RUN.q)):
        again = Trajectory.load(made.save(tmp_path / "made.nc"))
        np.testing.assert_array_equal(again.q, made.q)
        assert not is_sealed(again)
    assert is_sealed(Trajectory.load(RUN.save(tmp_path / "run.nc")))


def test_what_is_no_file_is_left_alone(tmp_path):
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    with pytest.raises(FileError, match="it is no regular file; choose a file name and folder to write to"):
        RUN.save(pipe)
    assert pipe.is_fifo()
    with pytest.raises(FileError, match="no file"):
        Trajectory.load(pipe)
    for nothing in (None, 3, b"run.nc"):
        with pytest.raises(FileError, match="it is no path"):
            RUN.save(nothing)
        with pytest.raises(FileError, match="it is no path"):
            Trajectory.load(nothing)
    with pytest.raises(FileError, match="null byte"):
        Trajectory.load("a\0b")


def test_through_a_link_what_it_points_to_is_written(tmp_path):
    (tmp_path / "there").mkdir()
    target, link = tmp_path / "there" / "run.nc", tmp_path / "link.nc"
    target.write_bytes(b"before")
    link.symlink_to(target)
    assert RUN.save(link) == link
    assert link.is_symlink()
    same(Trajectory.load(target), RUN)
    (tmp_path / "a").symlink_to(tmp_path / "b")
    (tmp_path / "b").symlink_to(tmp_path / "a")
    with pytest.raises(FileError, match="cannot write"):
        RUN.save(tmp_path / "a")
    assert (tmp_path / "a").is_symlink()
