"""Bad input on the command line: exit status 2, one line that says what is wrong, no traceback and no file left."""

import os

import pytest

from tests.bad_input.values import RUN

NOT_COUNTS = ("1,000", "None", "0", "-1", "1.5", "x", "", "nan", "1e3", "99999999999999999999x")
NOT_SEEDS = ("None", "1,0", "-1", "1.5", "x", "", "nan")
NOT_POSITIVE = ("1,5", "True", "0", "-1", "x", "", "nan", "inf", "1j")
NOT_SOURCES = (
    "no-such",
    "square",
    "square:",
    "square:4",
    "square:4x",
    "square:0x3",
    "square:1x2x3",
    "square:-1x2",
    "line:x",
)
NOT_SOURCES += (
    "line:1e3",
    "line:999999999",
    "line:99999999999999999999",
    "hexagonal-patch:99999",
    "none.nc",
    "none.csv",
)
NOT_SOURCES += (
    "none.json",
    "n" * 300,
    "n" * 300 + ".nc",
    "torn.nc",
    "torn.csv",
    "torn.json",
    "folder",
    "pipe.csv",
    "text.csv",
    "wide.csv",
    "",
)
NOT_PICTURES = (
    "it",
    "it.txt",
    "it.gif",
    ".",
    "folder",
    "none\0.png",
    "torn.csv/it.png",
    "pipe.png",
    "n" * 300 + ".png",
)
NOT_SCENARIOS = ("no-such", "", "HEXAGN", "3", "os-1\0")


def cases():
    yield from ([word] for word in ("no-such", "--no-such", "-x", "verify2"))
    yield from (["verify", "E8", "--no-report", "--jobs", v] for v in NOT_COUNTS)
    yield from (["verify", "E8", "--no-report", "--seed", v] for v in NOT_SEEDS)
    yield from (["verify", "zone-gap", "--no-report", "--seeds", v] for v in NOT_SEEDS)
    yield from (["verify", v, "--no-report"] for v in NOT_SCENARIOS)
    yield from (
        ["verify", "os-1", "--no-report", "--on", v] for v in ("none.nc", "folder", "torn.nc", "text.csv", "pipe.nc")
    )
    yield from (["verify", "E8", "--report", v] for v in ("torn.csv", "torn.csv/x", "none\0", "n" * 300))
    yield from (
        ["verify", "os-1", "E8"],
        ["verify", "--on", "run.nc"],
        ["verify", "os-1", "--on", "run.nc", "--seed", "1"],
    )
    for command in (["run"], ["animate"]):
        suffix = ".nc" if command == ["run"] else ".gif"
        yield from ([*command, v, "-o", "it" + suffix] for v in NOT_SCENARIOS)
        yield from ([*command, "three-agents-1d", "-o", "it" + suffix, "--seed", v] for v in NOT_SEEDS)
        yield from (
            [*command, "three-agents-1d", "-o", v] for v in (".", "folder", "none\0.nc", "torn.csv/it" + suffix)
        )
        yield from ([*command], [*command, "three-agents-1d"], [*command, "three-agents-1d", "-o"])
        yield [*command, "three-agents-1d", "-o", "pipe.gif"]
    for option in ("--fps", "--seconds"):
        yield from (["animate", "three-agents-1d", "-o", "it.gif", option, v] for v in (*NOT_POSITIVE, "1e9"))
    for command in ("lattice", "equilibrium", "stability"):
        yield from ([command, v] for v in NOT_SOURCES)
        yield from ([command, "line:2", "--d", v] for v in NOT_POSITIVE)
        yield from ([command, "line:2", "--r", v] for v in NOT_POSITIVE)
        yield from ([command, "run.nc", "--time", v] for v in ("x", "nan", "-1", "99", "inf", ""))
        yield [command, "line:2", "--time", "0"]
        yield [command]
        picture = {"lattice": "-o", "equilibrium": "--picture", "stability": "--plot"}[command]
        yield from ([command, "line:2", picture, v] for v in NOT_PICTURES)
    for command in ("equilibrium", "stability"):
        yield from ([command, "line:2", "--algorithm", v] for v in ("0", "3", "x", "1.5", ""))
        yield from ([command, "line:2", "--start", v] for v in ("middle", "", "end"))
        yield from ([command, "line:2", "--seed", v] for v in (*NOT_SEEDS, "1"))
        yield from ([command, "hexagon", option, "1"] for option in ("--d", "--r", "--time", "--algorithm"))
    yield from (["equilibrium", "line:2", "-o", v] for v in ("it.nc", "folder", "pipe.json", "torn.csv/it.json", "it"))
    yield from (["stability", "line:3", "--modes", v] for v in NOT_COUNTS)
    ensemble = ["ensemble", "three-agents-1d", "--theorem", "energy"]
    for option in ("--seeds", "--jobs"):
        yield from ([*ensemble, option, v] for v in NOT_COUNTS)
    yield from ([*ensemble, "--seeds", "1", "--first-seed", v] for v in NOT_SEEDS)
    yield from ([*ensemble, "--seeds", "1", "--level", v] for v in ("0", "1", "95", "-1", "nan", "x"))
    yield from ([*ensemble, "--seeds", "1", "--set", v] for v in ("n", "n=", "=3", "n=1,", "n=,1", "no_such=3", ""))
    yield from (
        [*ensemble, "--seeds", "1", "--store", v] for v in ("folder", "torn.csv", "text.csv", "pipe.nc", "torn.csv/x")
    )
    yield from ([*ensemble, "--seeds", "1", "-o", v] for v in ("it.csv", "folder", "torn.csv/it.nc", "pipe.nc"))
    yield from ([*ensemble, "--seeds", "1", "--plot", v] for v in NOT_PICTURES)
    yield from (["ensemble", v, "--seeds", "1"] for v in NOT_SCENARIOS)
    yield from (["ensemble", "three-agents-1d", "--seeds", "1", "--theorem", v] for v in ("no-such", "", "E8"))
    falsify = ["falsify", "energy", "--on", "three-agents-1d"]
    yield from ([*falsify, "--budget", v] for v in NOT_COUNTS)
    yield from ([*falsify, "--budget", "1", "--seed", v] for v in NOT_SEEDS)
    yield from ([*falsify, "--budget", "1", "--claim", v] for v in ("no-such", ""))
    yield from ([*falsify, "--budget", "1", "--vary", v] for v in ("x", "", "q,q", "p;q"))
    yield from ([*falsify, "--budget", "1", "--region", v] for v in NOT_POSITIVE)
    yield from ([*falsify, "--budget", "1", "--speed", v] for v in NOT_POSITIVE)
    yield from (
        [*falsify, "--budget", "1", "--set", v] for v in ("x", "x=1", "x=1,2", "x=1,2,3", "x=a,b", "gains.c1_alpha=2,1")
    )
    yield from ([*falsify, "--budget", "1", "-o", v] for v in ("it.nc", "folder", "pipe.json", "torn.csv/it.json"))
    yield from ([*falsify, "--budget", "1", "--plot", v] for v in NOT_PICTURES)
    yield from (["falsify", v, "--on", "three-agents-1d", "--budget", "1"] for v in ("no-such", "", "E8"))
    yield from (["falsify", "energy", "--on", v, "--budget", "1"] for v in NOT_SCENARIOS)
    yield from (
        ["falsify", "--replay", v] for v in ("none.json", "torn.json", "folder", "text.csv", "pipe.json", "deep.json")
    )
    yield from (["falsify"], ["falsify", "energy"], [*falsify, "--replay", "torn.json"])
    export = ["export", "lammps", "three-agents-1d", "--out", "it"]
    yield from ([*export, "--points", v] for v in ("1", "0", "x", "1.5", "999999999999"))
    yield from ([*export, "--samples", v] for v in NOT_COUNTS[:6])
    yield from ([*export, "--dt", v] for v in NOT_POSITIVE)
    yield from ([*export, "--inner", v] for v in NOT_POSITIVE)
    yield from ([*export, "--consensus", v] for v in ("other", ""))
    yield from (["export", "lammps", v, "--out", "it"] for v in NOT_SCENARIOS)
    yield from (["export"], ["export", "gromacs", "hexagon", "--out", "it"], ["export", "lammps", "hexagon"])
    yield from (["export", "lammps", "three-agents-1d", "--out", v] for v in ("torn.csv", "torn.csv/x", "none\0"))
    yield from (
        ["prove", "no-such"],
        ["prove", "--jobs", "0"],
        ["prove", "--time-limit", "-1"],
        ["prove", "-o", "torn.csv"],
    )
    yield from (["scenarios", "--status", "x"], ["theorems", "--no-such"])


CASES = list(cases())


@pytest.fixture(scope="module")
def places(tmp_path_factory):
    """A folder with what commands should not be given."""
    folder = tmp_path_factory.mktemp("places")
    whole = RUN.save(folder / "run.nc").read_bytes()
    (folder / "torn.nc").write_bytes(whole[: len(whole) // 2])
    (folder / "torn.csv").write_text("x,y\n1.0,2.0\n3.0\n")
    (folder / "torn.json").write_text('{"format": "flockana-cou')
    (folder / "deep.json").write_text("[" * 100_000)
    (folder / "text.csv").write_text("not a number\nnor this one\n")
    (folder / "wide.csv").write_text("1,2,3,4\n")
    (folder / "folder").mkdir()
    for suffix in ("nc", "csv", "json", "png", "gif"):
        os.mkfifo(folder / f"pipe.{suffix}")
    return folder


def test_there_are_many():
    assert len(CASES) >= 500


@pytest.mark.parametrize("first", range(0, len(CASES), 25))
def test_bad_input_is_2_and_one_line_and_no_file(call, places, monkeypatch, first):
    monkeypatch.chdir(places)
    before = sorted(path.name for path in places.rglob("*"))
    wrong = []
    for arguments in CASES[first : first + 25]:
        try:
            code, out, err = call(*arguments)
        except BaseException as error:
            wrong.append(f"{arguments}: {type(error).__name__}: {error}")
            continue
        if code != 2 or out or err.count("\n") != 1 or not err.startswith("flockana: ") or "Traceback" in err:
            wrong.append(f"{arguments}: {code}, {out[:60]!r}, {err[:200]!r}")
        left = sorted(path.name for path in places.rglob("*"))
        if left != before:
            wrong.append(f"{arguments}: {set(left) ^ set(before)} left")
            before = left
    assert not wrong, "\n".join(wrong)
