import json
import re
import sys

import numpy as np
import pytest

from flockana import Algorithm1, find_equilibrium, read_lammps
from flockana.base.errors import ArgumentError, FileError
from flockana.base.integrity_seals import sealed
from flockana.cli.positions_source import read_csv
from flockana.ensemble.one_run import Job, Record
from flockana.ensemble.store import Store
from flockana.equilibria.equilibrium_files import read_equilibrium, write_equilibrium
from flockana.falsify import Counterexample

LAW = Algorithm1()


def flipped(content, count, seed=0):
    """The content with one bit changed, at so many random places."""
    rng = np.random.default_rng(seed)
    for place, bit in zip(rng.integers(len(content), size=count).tolist(), rng.integers(8, size=count), strict=True):
        one = bytearray(content)
        one[place] ^= 1 << int(bit)
        yield bytes(one)


def shortened(content, count):
    for length in np.linspace(0, len(content) - 2, count).astype(int).tolist():
        yield content[:length]


def outcomes(read, path, contents, same, refusals=FileError):
    """How many of the contents are refused; every other one must be what was written."""
    refused = 0
    for content in contents:
        path.write_bytes(content)
        try:
            found = read(path)
        except refusals as error:
            refused += str(path) in str(error)
        else:
            assert same(found)
    return refused


def records():
    for k in range(12):
        claims = {"os-1:i": ("verified", 0.1 * k, None)}
        metrics = {"cohesion_radius": 1.0 / (k + 3), "order": float("inf")}
        yield f"key {k:02d} " * 8, Record(Job(k, (("n", 7),)), "complete", "", {"os-1": "verified"}, claims, metrics)


def test_a_store_gives_the_runs_that_were_stored_or_fewer(tmp_path):
    path, kept = tmp_path / "runs.sqlite", dict(records())
    with Store(path) as store:
        store.add("pair", kept)
    whole = path.read_bytes()

    def read(path):
        with Store(path) as store:
            return store.read(kept)

    def same(found):
        return found.items() <= kept.items()

    records_begin = whole.index(b"key ")
    refused = outcomes(read, path, flipped(whole, 60), same)
    in_records = (whole[:records_begin] + part for part in flipped(whole[records_begin:], 90))
    assert refused + outcomes(read, path, in_records, same) > 20
    assert outcomes(read, path, shortened(whole, 12), same) >= 11  # an empty file is a new store


MADE_UP = Counterexample("os-1", "i", "made up", LAW, np.array([[0.0], [8.0]]), np.zeros((2, 1)), (0.0, 1.0))
COUNTEREXAMPLE = sealed(MADE_UP)


def test_a_counterexample_is_that_which_was_written(tmp_path):
    path = tmp_path / "c.json"
    whole = COUNTEREXAMPLE.save(path).read_bytes()

    def same(found):
        return COUNTEREXAMPLE.save(path) == path and found.save(path).read_bytes() == whole

    assert same(Counterexample.load(path))
    flips = outcomes(Counterexample.load, path, flipped(whole, 400), same)
    assert flips > 350  # a flip in white space changes nothing
    assert outcomes(Counterexample.load, path, shortened(whole, 60), same) == 60


def test_a_file_without_its_digest_or_with_a_key_twice_is_refused(tmp_path, pair):
    write_equilibrium(pair, tmp_path / "e.json")
    COUNTEREXAMPLE.save(tmp_path / "c.json")
    for name, read in (("c.json", Counterexample.load), ("e.json", read_equilibrium)):
        text = (tmp_path / name).read_text()
        data = json.loads(text)
        del data["digest"]
        (tmp_path / name).write_text(json.dumps(data))
        with pytest.raises(FileError, match="it has no digest, which every file is written with"):
            read(tmp_path / name)
        for key in ("format", "law", "type"):
            (tmp_path / name).write_text(text.replace(f'"{key}"', f'"{key}": "x", "{key}"', 1))
            with pytest.raises(FileError, match=f"the key '{key}' is given twice"):
                read(tmp_path / name)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (
            {"options": {"progress": True}},
            "options progress: expected some of method, rtol, atol, dt, max_step, t_eval",
        ),
        ({"tolerances": {"energy": float("nan")}}, "tolerances.energy = nan: expected a finite number"),
        ({"tolerances": {"giant": 2.0}}, "tolerances.giant = 2: expected a share below 1"),
        ({"margin": [1.0]}, "is damaged"),
        ({"q0": [[0.0], [8.5]]}, "its digest is not that of its contents"),
    ],
)
def test_what_a_counterexample_may_hold(tmp_path, change, message):
    path = COUNTEREXAMPLE.save(tmp_path / "c.json")
    path.write_text(json.dumps(json.loads(path.read_text()) | change))
    with pytest.raises(FileError, match=re.escape(message)):
        Counterexample.load(path)


@pytest.fixture(scope="module")
def pair():
    return find_equilibrium(LAW, [[0.0], [6.9]])


def test_an_equilibrium_is_that_which_was_written(tmp_path, pair):
    path = tmp_path / "e.json"
    write_equilibrium(pair, path)
    whole = path.read_bytes()

    def same(found):
        return np.array_equal(found.q, pair.q) and found.law == pair.law

    assert same(read_equilibrium(path))
    assert outcomes(read_equilibrium, path, flipped(whole, 200), same) > 150
    assert outcomes(read_equilibrium, path, shortened(whole, 30), same) == 30
    moved = json.loads(whole)
    moved["q"][0][0] += 1e-12
    path.write_text(json.dumps(moved))
    with pytest.raises(FileError, match="its digest is not that of its contents"):
        read_equilibrium(path)


def test_positions_from_a_damaged_csv_are_finite_or_refused(tmp_path):
    path = tmp_path / "q.csv"
    whole = b"x,y\n0.0,0.0\n7.0,0.5\n3.5,6.0\n-1e3,2.5e-3\n"

    def finite(q):
        return q.ndim == 2 and 1 <= q.shape[1] <= 3 and len(q) >= 1 and np.isfinite(q).all()

    contents = [
        *flipped(whole, 300),
        *shortened(whole, 30),
        b"",
        b"\0",
        b"\xff" * 9,
        b'"',
        b"1," * 9,
        b"nan\n",
        b"1e999",
    ]
    refusals = (FileError, ArgumentError)  # a header that names other columns
    assert outcomes(read_csv, path, contents, finite, refusals) > 100


def dump():
    """Three snapshots of a pair, as LAMMPS writes them."""
    for k in range(3):
        yield f"ITEM: TIMESTEP\n{10 * k}\nITEM: TIME\n0.{k}\nITEM: NUMBER OF ATOMS\n2\nITEM: BOX BOUNDS ss ss pp\n"
        yield f"0 1\n0 1\n0 1\nITEM: ATOMS id x y vx vy\n1 0.{k} 0.0 1.0 0.0\n2 8.{k} 0.5 1.0 0.0\n"


def test_a_damaged_dump_of_lammps_is_refused_or_a_run(tmp_path):
    """Plain text without a digest: another digit is another number, which nobody can tell."""
    path, whole = tmp_path / "pair.dump", "".join(dump()).encode()

    def sound(run):
        return run.n == 2 and (np.diff(run.t) > 0.0).all() and np.isfinite([run.q, run.p]).all()

    def read(path):
        return read_lammps(path, LAW)

    path.write_bytes(whole)
    assert sound(read(path))
    refusals = (FileError, ArgumentError)  # a box whose faces cannot be read may be periodic: places may be wrapped
    assert outcomes(read, path, flipped(whole, 100), sound, refusals) > 75
    boundaries = whole.count(b"ITEM: TIMESTEP") - 1
    assert outcomes(read, path, (whole[:k] for k in range(len(whole))), sound) == len(whole) - boundaries


def test_loading_makes_no_object_but_parameters(tmp_path):
    """Files are data: nothing that a file names is imported or called unless it is a parameter class."""
    path = COUNTEREXAMPLE.save(tmp_path / "c.json")
    for name in (
        "os:system",
        "builtins:eval",
        "subprocess:Popen",
        "flockana:simulate",
        "flockana.base.files:replacing",
    ):
        data = json.loads(path.read_text()) | {"law": {"type": name, "command": "touch ran"}}
        path.write_text(json.dumps(data))
        with pytest.raises(FileError, match=r"cannot rebuild|which is not part of flockana"):
            Counterexample.load(path)
    assert "antigravity" not in sys.modules
    COUNTEREXAMPLE.save(path)
    path.write_text(path.read_text().replace("flockana:Algorithm1", "antigravity:fly"))
    with pytest.raises(FileError, match="which is not part of flockana"):
        Counterexample.load(path)
    assert "antigravity" not in sys.modules
