import os
import sqlite3
from contextlib import closing

import pytest
import xarray
from PIL import Image

from flockana.base.errors import ArgumentError
from flockana.cli.ensemble import read_options
from flockana.ensemble import ensemble, shares
from tests.programs import ANSWERS_CTRL_C, CLI, interrupt, posix, program, until

COMMAND = ("ensemble",)


@pytest.mark.slow
def test_it_prints_shares_and_writes_what_is_asked_for(call, tmp_path):
    given = ["hexagon", "--seeds", 4, "--theorem", "alpha-flocking", "--jobs", 1, "--store", "s.sqlite"]
    code, out, err = call(*given, "-o", "all.nc", "--plot", "all.png")
    assert (code, err) == (0, "")
    assert "hexagon: 4 runs" in out
    # 4 of 4: from (0.025)^(1/4) on, to 3 digits
    rows = [line.split() for line in out.splitlines()]
    assert ["giant", "4", "100.0", "[39.8,", "100.0]", "0.0", "[0.0,", "60.2]"] in rows
    for label, name in (("store", "s.sqlite"), ("saved", "all.nc"), ("picture", "all.png")):
        assert f"{label}: {name}" in out
    stored = xarray.load_dataset(tmp_path / "all.nc", engine="h5netcdf")
    direct = ensemble("hexagon", range(4), theorems=["alpha-flocking"], jobs=1)
    assert stored.drop_vars("seconds").identical(direct.drop_vars("seconds"))
    Image.open(tmp_path / "all.png").verify()
    again, same, _ = call(*given)
    assert again == 0
    assert same.splitlines() == [line for line in out.splitlines() if not line.startswith(("saved", "picture"))]


def test_options_make_groups_and_a_phase_diagram(call, tmp_path):
    given = ["phase", "--seeds", 1, "--theorem", "source", "--jobs", 1, "--first-seed", 3]
    options = ["--set", "ratio=0.01,2.0", "--set", "density=0.3,1", "--set", "n=5"]
    code, out, _ = call(*given, *options, "--store", "s.sqlite", "--plot", "p.svg", "-o", "p.nc")
    assert (code, "phase: 4 runs" in out) == (0, True)
    found = xarray.load_dataset(tmp_path / "p.nc", engine="h5netcdf")
    assert dict(found.run.sizes) == {"ratio": 2, "density": 2, "seed": 1}
    assert (found.seed.values.tolist(), int(found.n)) == ([3], 5)
    assert b"agents" not in (tmp_path / "p.svg").read_bytes()[:100]
    code, out, _ = call("hexagon", "--seeds", 1, "--theorem", "energy", "--jobs", 1, "--level", 0.5)
    assert "50 % Clopper-Pearson" in " ".join(out.split())
    table = shares(ensemble("hexagon", [0], theorems=["energy"], jobs=1), level=0.5)
    assert f"[{100 * float(table.low[0, 0]):.1f}, 100.0]" in out


def test_options_are_read_as_what_they_look_like():
    assert read_options(["push=true,False", "n=20", "x=1e-3,2", "word=a b"]) == {
        "push": [True, False],
        "n": 20,
        "x": [0.001, 2],
        "word": "a b",
    }
    for bad, message in ((["n"], "OPTION=VALUE"), (["n=1,,2"], "OPTION=VALUE"), (["n=1", "n=2"], "n is set already")):
        with pytest.raises(ArgumentError, match=message):
            read_options(bad)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["hexagon", "--set", "m=2"], "hexagon has no option m"),
        (["hexagon", "--seeds", 100_000_000_000], "seeds: there are more than 1000000; expected at most so many"),
        (["phase", "--set", "n=1,2", "--set", "ratio=1,2", "--set", "density=1,2", "--plot", "x.png"], "two at most"),
    ],
)
def test_bad_input_is_one_line_and_exit_2(call, arguments, message):
    code, out, err = call(*arguments, "--store", "s.sqlite")
    assert (code, out) == (2, "")
    assert message in err
    assert not os.path.exists("s.sqlite")


def stored(path):
    """The records in a store, by seed; none as long as it is being made."""
    if not path.exists():
        return {}
    try:
        with closing(sqlite3.connect(path)) as file:
            return dict(file.execute("SELECT seed, record FROM runs").fetchall())
    except sqlite3.OperationalError:
        return {}


@pytest.mark.slow
@posix
def test_ctrl_c_leaves_a_store_to_go_on_from(call, tmp_path):
    """With some runs in the store, and far too many to go."""
    path = tmp_path / "s.sqlite"
    given = ("hexagon", "--theorem", "alpha-flocking", "--store", path)
    with program("-c", ANSWERS_CTRL_C + CLI, *COMMAND, *given, "--jobs", "2", "--seeds", "2000") as running:
        until(lambda: len(stored(path)) >= 3, running)
        interrupt(running)
        _, err = running.communicate()
    kept = stored(path)
    said = f"{len(kept)} of 2000 runs done; they are stored in {path}, and the same call goes on"
    assert (running.returncode, err.splitlines()) == (130, [said, "flockana: interrupted"])
    assert 3 <= len(kept) < 2000
    asked = range(len(kept) // 2 + 1)
    code, _, err = call(*given, "--jobs", 1, "--seeds", len(asked))
    assert (code, err) == (0, "")
    found = stored(path)
    assert {*found} == {*kept, *asked}
    assert {seed: found[seed] for seed in kept} == kept
