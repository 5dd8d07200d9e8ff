"""Files of recordings: whole ones are read as written, damaged ones are refused in one line that says where."""

import io
import time

import numpy as np
import pandas as pd
import pytest
from scipy.io import savemat

import flockana as fl
from flockana.base.errors import ArgumentError, FileError, FlockanaError

T = np.array([0.0, 0.25, 0.5])
Q = np.arange(12.0).reshape(3, 2, 2) / 7.0
P = Q[::-1] * 3.0


def long_table(gap=False):
    rows = [(t, f"b{i}", *Q[k, i].tolist(), *P[k, i].tolist()) for k, t in enumerate(T.tolist()) for i in (1, 0)]
    frame = pd.DataFrame(rows, columns=["Time (s)", "ID", "X [m]", "Y [m]", "vx", "vy"])
    return frame.drop(index=[2]) if gap else frame


def written(path, frame, **options):
    frame.to_csv(path, index=False, float_format="%.17g", **options)
    return path


def ensure_same(rec):
    np.testing.assert_array_equal(rec.t, T)
    np.testing.assert_array_equal(rec.q, Q)
    np.testing.assert_array_equal(rec.p, P)


@pytest.mark.parametrize("sep", [",", ";", "\t"])
def test_a_long_table_is_read_to_the_bit_whatever_the_order_of_its_rows(tmp_path, sep):
    frame = long_table().sample(frac=1.0, random_state=0)
    rec = fl.read_recording(written(tmp_path / "flock.csv", frame, sep=sep), bound=0.0)
    ensure_same(rec)
    assert rec.ids == ("b0", "b1")


def test_a_row_that_is_missing_is_a_gap_and_so_is_an_empty_cell(tmp_path):
    assert fl.read_recording(written(tmp_path / "it.csv", long_table(gap=True))).gaps == 1
    frame = long_table()
    frame.loc[1, "Y [m]"] = np.nan
    rec = fl.read_recording(written(tmp_path / "it.csv", frame))
    assert rec.gaps == 1
    assert np.isnan(rec.q[0, 0]).all()


@pytest.mark.parametrize("names", ["{}{}", "{}_{}", "robot{1}_{0}"])
def test_wide_tables_hold_columns_for_each_agent(tmp_path, names):
    data = {"t": T}
    for i in range(2):
        for k, axis in enumerate("xy"):
            data[names.format(axis, i + 1)] = Q[:, i, k]
            data[names.format("v" + axis, i + 1)] = P[:, i, k]
    ensure_same(fl.read_recording(written(tmp_path / "wide.csv", pd.DataFrame(data))))


def test_frames_arrays_and_files_of_arrays_are_read_alike(tmp_path):
    arrays = {"t": T, "q": Q, "p": P}
    ensure_same(fl.read_recording(arrays))
    ensure_same(fl.read_recording(long_table()))
    np.savez(tmp_path / "it.npz", time=T, positions=Q, velocities=P)
    ensure_same(fl.read_recording(tmp_path / "it.npz"))
    np.save(tmp_path / "it.npy", Q)
    np.testing.assert_array_equal(fl.read_recording(tmp_path / "it.npy", dt=0.25).q, Q)
    savemat(tmp_path / "it.mat", {"t": T, "pos": Q, "vel": P})
    ensure_same(fl.read_recording(tmp_path / "it.mat"))
    run = fl.simulate(fl.Algorithm1(), [[0.0], [8.0]], [[0.0], [0.0]], (0.0, 1.0))
    run.save(tmp_path / "run.nc")
    back = fl.read_recording(tmp_path / "run.nc", bound=1e-6)
    np.testing.assert_array_equal(back.q, run.q)
    np.testing.assert_array_equal(back.t, run.t)


def test_headers_are_respected_and_columns_may_be_named(tmp_path):
    path = tmp_path / "it.csv"
    path.write_text("id,x,y\n1,0.5,2\n2,8,3\n")
    rec = fl.read_recording(path)
    assert rec.m == 2
    assert rec.q.tolist() == [[[0.5, 2.0], [8.0, 3.0]]]
    path.write_text("x,y,vx\n1,2,3\n")
    with pytest.raises(ArgumentError, match="expected vy too"):
        fl.read_recording(path)
    path.write_text("when,who,east,north\n0,1,2,3\n")
    with pytest.raises(ArgumentError, match=r"expected time, id, x, y .long."):
        fl.read_recording(path)
    rec = fl.read_recording(path, columns={"t": "when", "id": "who", "q": ["east", "north"]})
    assert rec.q.tolist() == [[[2.0, 3.0]]]
    path.write_text("0,1,2,3\n0.1,1,2,4\n")
    with pytest.raises(FileError, match="expected a header such as"):
        fl.read_recording(path)
    assert fl.read_recording(path, columns=["t", "id", "x", "y"]).q[1, 0].tolist() == [2.0, 4.0]


def test_names_in_order_replace_a_header_that_says_the_same_or_nothing(tmp_path):
    path = tmp_path / "it.csv"
    path.write_text("when,kite,east,north\n0,a,1,2\n1,a,2,b\n")
    with pytest.raises(FileError, match="line 3, column 'y': 'b'"):
        fl.read_recording(path, columns=["t", "id", "x", "y"])
    path.write_text("when,kite,east,north\n0,a,1,2\n1,a,2,3\n")
    rec = fl.read_recording(path, columns=["t", "id", "x", "y"])
    assert rec.q[:, 0].tolist() == [[1.0, 2.0], [2.0, 3.0]]
    assert "columns= replaces the header: 'when' is 't', 'kite' is 'id', 'east' is 'x', 'north' is 'y'" in rec.read_as
    with pytest.raises(ArgumentError, match=r"line 1 has 4 columns, 'when', .* and columns= has 3 names"):
        fl.read_recording(path, columns=["t", "x", "y"])
    path.write_text("time,px,py,robot\n0,1,2,a\n1,2,3,a\n")
    with pytest.raises(ArgumentError, match="the header says 'robot' where columns= says 'vx': expected names in the"):
        fl.read_recording(path, columns=["t", "x", "y", "vx"])
    assert fl.read_recording(path, columns=["t", "x", "y", "id"]).ids == ("a",)
    path.write_text("0,a,,\n1,a,2,3\n")  # a gap, no header
    rec = fl.read_recording(path, columns=["t", "id", "x", "y"])
    assert (rec.gaps, "there is no header: columns= names the columns" in rec.read_as) == (1, True)


def test_frames_need_a_step_and_dates_a_unit(tmp_path):
    path = tmp_path / "it.csv"
    path.write_text("frame,id,x\n0,a,1\n4,a,2\n")
    with pytest.raises(ArgumentError, match="expected dt="):
        fl.read_recording(path)
    assert fl.read_recording(path, dt=0.5).t.tolist() == [0.0, 2.0]
    path.write_text("time,id,x\n2024-05-01T12:00:00,a,1\n2024-05-01T12:01:30,a,2\n")
    with pytest.raises(ArgumentError, match="is a date: expected clock="):
        fl.read_recording(path)
    assert fl.read_recording(path, clock=60.0).t.tolist() == [0.0, 1.5]


MESSAGES = [
    ("t,id,x\n0,1,a\n", r"line 2, column 'x': 'a'; expected a finite number"),
    ("t,id,x\n0,1,1\n0.1,1,inf\n", r"line 3, column 'x'"),
    ("t,id,x\n\n0,1,1\n\n0.1,1,b\n", r"line 5, column 'x': 'b'"),
    ("t,id,x\n0,1\n", r"line 2: 2 values, expected 3"),
    ("t,id,x\n0,1,2,3\n", r"line 2: 4 values, expected 3"),
    ("t,id,x\n0,1,2\n0,1,3\n", r"line 3: agent 1 at t = 0 a second time"),
    ("t,id,x\n,1,2\n", r"line 2, column 't': no time"),
    ("t,id,x\n0,,2\n", r"line 2, column 'id': no name"),
    ("t,id,x\n", "a header and no rows"),
    ("", "is empty"),
    ("t,x,x\n0,1,2\n", "the column 'x' is given twice"),
    ("t,id,x,z\n0,1,2,3\n", "expected y too"),
    ("t,id,y\n0,1,2\n", "expected x too"),
    ("t,x\n0,1\n0,2\n", "several rows at one time and no column id"),
    ("t,x1,y1,x2\n0,1,2,3\n", "expected y too|other columns for agent"),
    ("x1,x2\n0,1\n", "has no times"),
    ("id,x\n1,2\n1,3\n", "several times and no times"),
    ('t,id,"x\n[m]"\n0,1,2\n', "line 1: .* has an open quote; expected a header in one line"),
]


@pytest.mark.parametrize(("text", "message"), MESSAGES)
def test_wrong_tables_are_refused_with_row_column_and_remedy(tmp_path, text, message):
    path = tmp_path / "it.csv"
    path.write_text(text)
    with pytest.raises(FlockanaError, match=message):
        fl.read_recording(path)


@pytest.mark.parametrize(
    ("source", "how", "message"),
    [
        (long_table().set_axis(["t", "id", "x", "x", "y", "vx"], axis=1), {}, "the column 'x' is given twice"),
        (long_table().iloc[:0], {}, "the frame has no rows"),
        (long_table().assign(vx=1j), {}, "row 0, column 'vx': '1j'; expected a finite number"),
        (long_table(), {"columns": ["t", "id"]}, "the frame has 6 columns, .* and columns= has 2 names"),
        (long_table(), {"columns": "t,id"}, "columns = 't,id': expected names in order, or by meaning"),
        (long_table(), {"columns": {"t": "Time (s)", "q": None}}, "the frame has no column None"),
        (pd.DataFrame({"t": pd.to_datetime(["2024-05-01", None]), "x": [0.0, 1.0]}), {"clock": 1.0}, "row 1.*no time"),
        ({"q": Q}, {"dt": 0.0}, "dt = 0: expected a number > 0"),
        ({"t": T, "q": [[[0.0]], [[1.0], [2.0]]]}, {}, "q has rows of different lengths"),
        ({"t": T, "q": Q}, {"columns": {"q": ["x", "y"]}}, "has no array 'x': expected one of t, q"),
    ],
)
def test_wrong_frames_and_arrays_are_refused_in_one_line(source, how, message):
    with pytest.raises(FlockanaError, match=message) as refused:
        fl.read_recording(source, **how)
    assert "\n" not in str(refused.value)


def test_arrays_and_frames_may_be_named():
    ensure_same(fl.read_recording({"a": T, 1: 0, "b": Q, "c": P}, columns={"t": "a", "q": "b", "p": "c"}))
    frame = long_table()
    ensure_same(fl.read_recording(frame.set_index(["Time (s)", "ID"])))
    ensure_same(fl.read_recording(frame.set_axis(range(6), axis=1), columns=list(frame)))


def test_wrong_bytes_and_files_are_refused(tmp_path):
    path, bad = tmp_path / "it.csv", tmp_path / "bad.npz"
    for data, message in ((b"t,x\n0,\xff\n", "line 2: byte 0xff"), (b"\xff\xfet\0", "UTF-16"), (b"t\0", "null bytes")):
        path.write_bytes(data)
        with pytest.raises(FileError, match=message):
            fl.read_recording(path)
    for source, message in (
        (tmp_path / "nothing.csv", "no file"),
        (tmp_path, "no regular file"),
        (3, "expected a file, a pandas frame, an xarray dataset, or arrays by name"),
        ({"t": T, "q": np.zeros((5, 2, 3))}, 'expected .T, n, m., or axes="agent axis time", which decides'),
    ):
        with pytest.raises(FlockanaError, match=message):
            fl.read_recording(source)
    named = {"t": T, "q": Q, "ids": ["a", "b"], "source": "it"}
    for arrays, message in (
        ({"q": np.array([None])}, "as npz"),
        (named | {"estimated": np.zeros(3)}, r"estimated = .*expected True or False"),
    ):
        np.savez(bad, **arrays)
        with pytest.raises(FlockanaError, match=message):
            fl.read_recording(bad)


def test_a_wrapped_dump_is_unwrapped(tmp_path):
    """Two agents 1 apart that cross a periodic face: their cohesion radius is 0.5, and 9.5 where places are wrapped."""
    path, box = tmp_path / "it.dump", "ITEM: BOX BOUNDS pp pp pp\n0 20\n0 20\n-0.5 0.5\n"
    head = f"ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n2\n{box}"
    path.write_text(head + "ITEM: ATOMS id x y ix iy\n1 19.5 3 0 0\n2 0.5 3 1 0\n")
    rec = fl.read_recording(path, dt=0.01, m=2)
    assert fl.cohesion_radius(rec.q[0]) == pytest.approx(0.5)
    path.write_text(head + "ITEM: ATOMS id x y\n1 19.5 3\n2 0.5 3\n")
    with pytest.raises(ArgumentError, match="the box is periodic in x"):
        fl.read_recording(path, dt=0.01)
    first = path.read_text()
    path.write_text(first + first.replace("STEP\n0", "STEP\n100").replace("1 19.5", "1 0.25"))
    assert fl.read_recording(path, dt=0.01, m=2, box=20.0).q[:, 0, 0].tolist() == [19.5, 20.25]


def damaged(rng, tables):
    """A file of a recording, damaged somewhere."""
    kind = rng.choice(list(tables))
    data = bytearray(tables[kind])
    for _ in range(int(rng.integers(1, 4))):
        at = int(rng.integers(0, len(data)))
        match int(rng.integers(0, 5)):
            case 0:
                data[at:] = b""
            case 1:
                data[at] = int(rng.integers(0, 256))
            case 2:
                data[at:at] = bytes(rng.integers(0, 256, 3).tolist())
            case 3:
                data[at:at] = rng.choice([b",", b"\n", b'"', b"nan", b"1e999", b"x", b"--", b"ITEM: "])
            case _:
                data[at : at + 20] = data[: int(rng.integers(0, 40))]
        if not data:
            break
    return kind, bytes(data)


def test_of_200_malformed_files_each_is_read_or_refused_in_one_line(tmp_path):
    rng, tables = np.random.default_rng(0), {}
    csv = io.StringIO()
    long_table().to_csv(csv, index=False)
    tables["csv"] = csv.getvalue().encode()
    tables["tsv"] = csv.getvalue().replace(",", "\t").encode()
    np.savez(tmp_path / "a.npz", t=T, q=Q, p=P)
    tables["npz"] = (tmp_path / "a.npz").read_bytes()
    savemat(tmp_path / "a.mat", {"t": T, "q": Q})
    tables["mat"] = (tmp_path / "a.mat").read_bytes()
    dump = "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n1\nITEM: BOX BOUNDS ss ss pp\n0 1\n0 1\n0 1\nITEM: ATOMS id x y\n"
    tables["dump"] = (dump + "1 0.5 0.25\n").encode()
    refused = []
    for k in range(200):
        kind, data = damaged(rng, tables)
        path = tmp_path / f"{k}.{kind}"
        path.write_bytes(data)
        try:
            fl.read_recording(path, dt=0.1)
        except FlockanaError as error:
            refused.append((path.name, str(error)))
    assert [error for name, error in refused if "\n" in error or name not in error] == []
    assert len(refused) > 120


@pytest.mark.slow
def test_a_million_rows_are_read_in_five_seconds(tmp_path):
    n, count = 100, 10_000
    rng = np.random.default_rng(0)
    x = rng.normal(size=(count * n, 4)).round(6)
    frame = pd.DataFrame({"time": np.repeat(np.arange(count) * 0.02, n), "id": np.tile(np.arange(n), count)})
    frame[["x", "y", "vx", "vy"]] = x
    path = tmp_path / "many.csv"
    frame.to_csv(path, index=False)
    started = time.process_time()
    rec = fl.read_recording(path)
    assert time.process_time() - started < 5.0
    assert rec.q.shape == (count, n, 2)
    np.testing.assert_array_equal(rec.q[-1, -1], x[-1, :2])
