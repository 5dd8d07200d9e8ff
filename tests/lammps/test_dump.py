"""Dumps of LAMMPS, read: whole ones as a run of a law, damaged ones with an error that says what is wrong."""

import numpy as np
import pytest

import flockana as fl
from flockana.base.errors import ArgumentError, FileError

BOX = "ITEM: BOX BOUNDS ss ss pp\n-9 9\n-9 9\n-0.5 0.5\n"


def dumped(run, path, *, columns="id type x y vx vy fx fy", times=True, shift=0.0):
    """A run of the law's own, written as LAMMPS writes it; agents in no order, forces off by a shift."""
    text, rng = "", np.random.default_rng(0)
    for k, t in enumerate(run.t.tolist()):
        text += "ITEM: UNITS\nlj\n" if k == 0 else ""
        text += f"ITEM: TIME\n{t!r}\n" if times else ""
        text += f"ITEM: TIMESTEP\n{10 * k}\nITEM: NUMBER OF ATOMS\n{run.n}\n{BOX}ITEM: ATOMS {columns} \n"
        for i in rng.permutation(run.n).tolist():
            data = {"id": i + 1, "type": 1, "z": 0.0, "vz": 0.0, "mass": 1.0}
            for j, axis in enumerate("xy"):
                data |= {f"v{axis}": float(run.p[k, i, j]), f"f{axis}": float(run.u[k, i, j]) + shift}
                data[axis] = data[f"{axis}u"] = float(run.q[k, i, j])
            text += " ".join(repr(data[name]) for name in columns.split()) + " \n"
    path.write_text(text)
    return path


@pytest.fixture(scope="module")
def run():
    q0 = np.array([[0.0, 0.0], [6.0, 1.0], [2.0, 7.0], [9.0, 6.0]])
    law = fl.Algorithm2(target=fl.LinearTarget((1.0, 2.0), (1.0, 0.0)))
    return fl.simulate(law, q0, np.zeros((4, 2)), (0.0, 2.0), rtol=1e-11, t_eval=np.linspace(0.0, 2.0, 201))


@pytest.fixture
def path(tmp_path):
    return tmp_path / "flock.dump"


def test_a_run_of_the_law_itself_comes_back_to_the_last_bit_and_leaves_no_residual(run, path):
    back = fl.read_lammps(dumped(run, path), run.law)
    for name in ("t", "q", "p", "u"):
        np.testing.assert_array_equal(getattr(back, name), getattr(run, name))
    assert back.law == run.law
    assert back.stats["steps"] == 2000
    assert back.extra["force_residual"].max() < 1e-13
    np.testing.assert_allclose(back.extra["work"], run.extra["work"], rtol=0.0, atol=1e-4 * np.abs(run.energy()).max())
    assert np.abs(back.energy_residual).max() < 1e-4 * np.abs(run.energy()).max()


def test_what_was_recorded_is_no_run_to_be_judged_and_other_forces_show(run, path):
    with pytest.raises(ArgumentError, match="expected a run as simulate returned it"):
        fl.verify("os-3", fl.read_lammps(dumped(run, path), run.law))
    largest = float(np.abs(run.u).max())
    off = fl.read_lammps(dumped(run, path, shift=0.01 * largest), run.law)
    np.testing.assert_allclose(off.extra["force_residual"], 0.01, rtol=1e-9)


def test_another_law_shows_in_both_residuals(run, path):
    other = fl.Algorithm2(target=fl.LinearTarget((1.0, 2.0), (1.0, 0.0)), gains=fl.Gains(c1_alpha=20.0))
    back = fl.read_lammps(dumped(run, path), other)
    assert back.extra["force_residual"].max() > 0.1
    assert np.abs(back.energy_residual).max() > 0.05 * np.abs(run.energy()).max()


def test_start_shifts_the_times_and_steps_make_them_where_there_are_none(run, path):
    back = fl.read_lammps(dumped(run, path, times=False), run.law, dt=0.001, start=3.0)
    np.testing.assert_allclose(back.t, run.t + 3.0, rtol=0.0, atol=1e-12)
    with pytest.raises(ArgumentError, match=r"dt = None: .* has no times; give the step"):
        fl.read_lammps(path, run.law)


def test_unwrapped_positions_and_the_plane_of_a_dump_in_space(run, path):
    back = fl.read_lammps(dumped(run, path, columns="type id xu yu vx vy"), run.law)
    np.testing.assert_array_equal(back.q, run.q)
    assert "force_residual" not in back.extra
    np.testing.assert_allclose(back.u, run.u, rtol=0.0, atol=1e-12 * np.abs(run.u).max())
    dumped(run, path, columns="id x y z vx vy vz")
    np.testing.assert_array_equal(fl.read_lammps(path, run.law, m=2).q, run.q)
    with pytest.raises(ArgumentError, match=r"2 components but the agents have 3.*with m=2"):
        fl.read_lammps(path, run.law)
    with pytest.raises(ArgumentError, match="m = 4: expected 1 to 3"):
        fl.read_lammps(path, run.law, m=4)


@pytest.mark.parametrize(
    ("columns", "message"),
    [
        ("id type xs ys vx vy", "expected positions x, y, z or xu, yu, zu"),
        ("id type x y", "expected vx vy among them"),
        ("id type x y vx vy fx", "expected fx fy among them"),
    ],
)
def test_missing_columns_are_named(run, path, columns, message):
    dumped(run, path, columns="id type x y vx vy fx fy")
    text = path.read_text().replace("id type x y vx vy fx fy", columns)
    lines = [
        " ".join(row.split()[: len(columns.split())]) if row[:1].isdigit() and " 1 " in row else row
        for row in text.splitlines()
    ]
    path.write_text("\n".join(lines) + "\n")
    with pytest.raises(ArgumentError, match=message):
        fl.read_lammps(path, run.law)


def without_last(text):
    cut = text.rindex("ITEM: NUMBER OF ATOMS\n4")
    last = text[cut:].replace("ATOMS\n4", "ATOMS\n3", 1)
    return text[:cut] + last[: last.rstrip("\n").rindex("\n") + 1]


def reworded(text, word):
    """Another word in the fourth column of the last line."""
    last = text.splitlines(keepends=True)[-1]
    return text.replace(last, last.replace(last.split()[3], word))


CUT = "where 4 lines of 8 numbers were expected; was it cut off"
WHOLE = "expected a whole number >= 1"
DAMAGE = [
    (lambda text, lines: "".join(lines[:-1]) + " ".join(lines[-1].split()[:5]), rf"'\d 1 .*' {CUT}"),
    (lambda text, lines: text.rstrip()[:-2], f"the end of the file {CUT}"),
    (lambda text, lines: "".join(lines[:-3]), "the end of the file where 4 lines"),
    (lambda text, lines: text[: text.rindex("ITEM: NUMBER")], "ends within the snapshot of step 2000; was it cut off"),
    (lambda text, lines: reworded(text, "nan"), r"'nan' in column 4 of .*; expected a finite number"),
    (lambda text, lines: reworded(text, "far"), r"'far' in column 4 of .*; expected a finite number"),
    (lambda text, lines: without_last(text), "snapshot 200 has 3 agents .* were agents lost"),
    (lambda text, lines: "".join([*lines[:-1], lines[-2]]), "two agents of one id; expected each once"),
    (lambda text, lines: text + text, "step 0 follows step 2000; expected rising steps"),
    (lambda text, lines: text + "ITEM: ENTRIES\n1\n", "unknown item 'ITEM: ENTRIES'"),
    (lambda text, lines: f"Step Temp\n{text}", "'Step Temp' where an ITEM was expected"),
    (lambda text, lines: "", "holds no snapshot: expected a text dump"),
    (("ITEM: TIME\n2.0\n", "ITEM: TIME\n1.0\n"), "expected rising times"),
    (("TIMESTEP\n10\n", "TIMESTEP\n10.5\n"), r"step 10\.5; expected a whole number >= 0"),
    (("TIMESTEP\n0\n", "TIMESTEP\n-1\n"), "step -1; expected a whole number >= 0"),
    (("ATOMS\n4\n", "ATOMS\n0\n"), f"number of atoms 0; {WHOLE}"),
    (("ATOMS\n4\n", "ATOMS\n-1\n"), f"number of atoms -1; {WHOLE}"),
    (("ATOMS\n4\n", "ATOMS\n1e300\n"), rf"number of atoms 1e\+300; {WHOLE}"),
    (("ATOMS id type x y", "ATOMS id type x x"), "or with a column twice"),
    (("ATOMS id", "ATOMS mol"), "expected a dump of style custom with id"),
]


@pytest.mark.parametrize(("how", "message"), DAMAGE)
def test_damaged_dumps_are_refused(run, path, how, message):
    text = dumped(run, path).read_text()
    path.write_text(how(text, text.splitlines(keepends=True)) if callable(how) else text.replace(*how))
    with pytest.raises(FileError, match=message):
        fl.read_lammps(path, run.law)


def test_what_is_no_text_or_not_there_is_refused(run, path):
    with pytest.raises(FileError, match=r"cannot read .*flock\.dump"):
        fl.read_lammps(path, run.law)
    path.write_bytes(b"\xff\xfe\x00\x01")
    with pytest.raises(FileError, match="expected a text dump of LAMMPS"):
        fl.read_lammps(path, run.law)


def test_a_law_for_other_agents_and_a_map_are_refused(run, path):
    dumped(run, path)
    each = fl.Algorithm2(target=fl.StaticTarget((0.0, 0.0)), gains=fl.Gains(c1_gamma=np.arange(1.0, 6.0)))
    with pytest.raises(ArgumentError, match="5"):
        fl.read_lammps(path, each)
    with pytest.raises(ArgumentError, match="is a map from step to step"):
        fl.read_lammps(path, fl.DiscreteMinimalFlocking(fl.MinimalFlocking(), 0.1))


def boxed(path, bounds, columns, *rows):
    """One snapshot in a box."""
    path.write_text(
        f"ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n{len(rows)}\nITEM: BOX BOUNDS {bounds}\n"
        f"ITEM: ATOMS {columns}\n" + "".join(f"{row}\n" for row in rows)
    )
    return fl.read_lammps(path, fl.Algorithm1(), dt=1.0, m=2)


SQUARE = "pp pp pp\n0 10\n0 10\n-0.5 0.5"
ACROSS = ("1 5 9.5 0 0 0 0", "2 2 0.5 0 1 0 0")


@pytest.mark.parametrize(
    ("bounds", "columns", "rows", "gap"),
    [
        (SQUARE, "id x y ix iy vx vy", ("1 9.5 5 0 0 0 0", "2 0.5 5 1 0 0 0"), (1.0, 0.0)),
        (SQUARE, "id x y xu yu vx vy", ("1 9.5 5 9.5 5 0 0", "2 0.5 5 10.5 5 0 0"), (1.0, 0.0)),
        (SQUARE, "id x yu ix iy vx vy", ("1 9.5 15 0 7 0 0", "2 0.5 15 1 3 0 0"), (1.0, 0.0)),
        ("ss pp pp\n0 10\n0 10\n-1 1", "id x y iy vx vy", ("1 1 9.5 -1 0 0", "2 1 0.5 0 0 0"), (0.0, 1.0)),
        # edges (10, 0) and (3, 10): through the upper face a place moves by 3 along x
        ("xy xz yz pp pp pp\n0 13 3\n0 10 0\n-1 1 0", "id x y ix iy vx vy", ACROSS, (0.0, 1.0)),
        ("abc origin pp pp pp\n10 0 0 0\n3 10 0 0\n0 0 2 -1", "id x y ix iy vx vy", ACROSS, (0.0, 1.0)),
    ],
)
def test_agents_across_a_periodic_face_are_near(path, bounds, columns, rows, gap):
    run = boxed(path, bounds, columns, *rows)
    np.testing.assert_allclose(run.q[0, 1] - run.q[0, 0], gap, atol=1e-14)
    assert fl.cohesion_radius(run.q[0]) == pytest.approx(0.5)


@pytest.mark.parametrize(
    ("bounds", "columns", "message"),
    [
        (SQUARE, "id x y vx vy", "the box is periodic in x, y, and x y are .*expected xu yu, or ix iy beside them"),
        ("ss pp pp\n0 10\n0 10\n-1 1", "id x y ix vx vy", "periodic in y, and x y are wrapped.*or iy beside them"),
        ("\n0 10\n0 10\n-1 1", "id x y vx vy", "may be periodic in x, y"),
        ("xy xz yz ss ss pp\n0 13 0\n0 10 3\n-1 1 0", "id x y vx vy", "periodic in z, and x y are wrapped"),
    ],
)
def test_wrapped_places_are_refused_where_nothing_unwraps_them(path, bounds, columns, message):
    with pytest.raises(ArgumentError, match=message):
        boxed(path, bounds, columns, "1" + " 1" * (len(columns.split()) - 1))


def test_a_box_without_periodic_faces_along_the_axes_needs_no_images(path):
    assert boxed(path, "ss ff pp\n0 10\n0 10\n-1 1", "id x y vx vy", "1 9.5 5 0 0").q.tolist() == [[[9.5, 5.0]]]


def test_names_of_elements_are_no_numbers(path):
    run = boxed(path, "ss ss pp\n0 10\n0 10\n-1 1", "id element x y vx vy", "2 Ar 1 2 3 4", "1 NaCl 5 6 7 8")
    assert run.q.tolist() == [[[5.0, 6.0], [1.0, 2.0]]]


def test_bounds_that_are_none_are_refused(path):
    with pytest.raises(FileError, match="invalid bounds"):
        boxed(path, "ss ss pp\n0\n0\n0", "id x y vx vy", "1 1 1 1 1")
