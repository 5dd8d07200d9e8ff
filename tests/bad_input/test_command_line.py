import os

import pytest

from tests.bad_input.values import RUN

NOT_COUNTS = ("1,000", "None", "0", "-1", "1.5", "x", "", "nan", "1e3", "99999999999999999999x")
NOT_SEEDS = ("None", "1,0", "-1", "1.5", "x", "", "nan")
NOT_POSITIVE = ("1,5", "True", "0", "-1", "x", "", "nan", "inf", "1j")
SOURCES = """no-such square square: square:4 square:4x square:0x3 square:1x2x3 square:-1x2 line:x line:1e3
line:999999999 line:99999999999999999999 hexagonal-patch:99999 none.nc none.csv none.json
torn.nc torn.csv torn.json folder pipe.csv pipe.json text.csv wide.csv"""
PICTURES = "it it.txt it.gif . folder torn.csv/it.png pipe.png"
NOT_SOURCES = (*SOURCES.split(), "n" * 300, "n" * 300 + ".nc", "")
NOT_PICTURES = (*PICTURES.split(), "none\0.png", "n" * 300 + ".png")
NOT_SCENARIOS = ("no-such", "", "HEXAGN", "3", "os-1\0")
TIMES = ("x", "nan", "-1", "99", "inf", "")
FOLDERS = ("torn.csv", "torn.csv/x", "none\0")
ENSEMBLE = "ensemble three-agents-1d --theorem energy --seeds 1"
FALSIFY = "falsify energy --on three-agents-1d --budget 1"
EXPORT = "export lammps three-agents-1d -o it"

# each of the values takes the place of {}; a text of several words is split
TABLE = {
    "{}": ("no-such", "--no-such", "-x", "verify2"),
    "verify E8 --no-report --jobs {}": NOT_COUNTS,
    "verify E8 --no-report --seed {}": NOT_SEEDS,
    "verify zone-gap --no-report --seeds {}": NOT_SEEDS,
    "verify {} --no-report": NOT_SCENARIOS,
    "verify os-1 --no-report --on {}": ("none.nc", "folder", "torn.nc", "text.csv", "pipe.nc"),
    "verify E8 -o {}": (*FOLDERS, "n" * 300),
    "animate three-agents-1d -o it.gif --fps {}": (*NOT_POSITIVE, "1e9"),
    "animate three-agents-1d -o it.gif --seconds {}": (*NOT_POSITIVE, "1e9"),
    "equilibrium line:2 -o {}": ("it.nc", "folder", "pipe.json", "torn.csv/it.json", "it"),
    "lattice line:2 --plot {}": NOT_PICTURES,
    "equilibrium line:2 --plot {}": NOT_PICTURES,
    "stability line:2 --plot {}": NOT_PICTURES,
    "stability line:3 --modes {}": NOT_COUNTS,
    "ensemble three-agents-1d --theorem energy --seeds {}": NOT_COUNTS,
    "ensemble three-agents-1d --theorem energy --jobs {}": NOT_COUNTS,
    f"{ENSEMBLE} --first-seed {{}}": NOT_SEEDS,
    f"{ENSEMBLE} --level {{}}": ("0", "1", "95", "-1", "nan", "x"),
    f"{ENSEMBLE} --set {{}}": ("n", "n=", "=3", "n=1,", "n=,1", "no_such=3", ""),
    f"{ENSEMBLE} --store {{}}": ("folder", "torn.csv", "text.csv", "pipe.nc", "torn.csv/x"),
    f"{ENSEMBLE} -o {{}}": ("it.csv", "folder", "torn.csv/it.nc", "pipe.nc"),
    f"{ENSEMBLE} --plot {{}}": NOT_PICTURES,
    "ensemble {} --seeds 1": NOT_SCENARIOS,
    "ensemble three-agents-1d --seeds 1 --theorem {}": ("no-such", "", "E8"),
    "falsify energy --on three-agents-1d --budget {}": NOT_COUNTS,
    f"{FALSIFY} --seed {{}}": NOT_SEEDS,
    f"{FALSIFY} --claim {{}}": ("no-such", ""),
    f"{FALSIFY} --vary {{}}": ("x", "", "q,q", "p;q"),
    f"{FALSIFY} --region {{}}": NOT_POSITIVE,
    f"{FALSIFY} --speed {{}}": NOT_POSITIVE,
    f"{FALSIFY} --set {{}}": ("x", "x=1", "x=1,2", "x=1,2,3", "x=a,b", "gains.c1_alpha=2,1"),
    f"{FALSIFY} -o {{}}": ("it.nc", "folder", "pipe.json", "torn.csv/it.json"),
    f"{FALSIFY} --plot {{}}": NOT_PICTURES,
    "falsify {} --on three-agents-1d --budget 1": ("no-such", "", "E8"),
    "falsify energy --on {} --budget 1": NOT_SCENARIOS,
    "falsify --replay {}": ("none.json", "torn.json", "folder", "text.csv", "pipe.json", "deep.json"),
    f"{EXPORT} --points {{}}": ("1", "0", "x", "1.5", "999999999999"),
    f"{EXPORT} --samples {{}}": NOT_COUNTS[:6],
    f"{EXPORT} --dt {{}}": NOT_POSITIVE,
    f"{EXPORT} --inner {{}}": NOT_POSITIVE,
    f"{EXPORT} --consensus {{}}": ("other", ""),
    "export lammps {} -o it": NOT_SCENARIOS,
    "export lammps three-agents-1d -o {}": FOLDERS,
}
for command, suffix in (("run", ".nc"), ("animate", ".gif")):
    TABLE |= {
        f"{command} {{}} -o it{suffix}": NOT_SCENARIOS,
        f"{command} three-agents-1d -o it{suffix} --seed {{}}": NOT_SEEDS,
        f"{command} three-agents-1d -o {{}}": (".", "folder", "none\0.nc", f"torn.csv/it{suffix}", "pipe.gif"),
    }
for command in ("lattice", "equilibrium", "stability"):
    TABLE |= {f"{command} {{}}": NOT_SOURCES, f"{command} run.nc --time {{}}": TIMES}
    TABLE |= {f"{command} line:2 --{option} {{}}": NOT_POSITIVE for option in "dr"}
for command in ("equilibrium", "stability"):
    TABLE |= {
        f"{command} line:2 --algorithm {{}}": ("0", "3", "x", "1.5", ""),
        f"{command} line:2 --start {{}}": ("middle", "", "end"),
        f"{command} line:2 --seed {{}}": (*NOT_SEEDS, "1"),
        f"{command} hexagon {{}} 1": ("--d", "--r", "--time", "--algorithm"),
    }
ALONE = f"""verify os-1 E8; verify --on run.nc; verify os-1 --on run.nc --seed 1; run; run three-agents-1d; animate
animate three-agents-1d; run three-agents-1d -o; animate three-agents-1d -o; lattice; equilibrium; stability
lattice line:2 --time 0; equilibrium line:2 --time 0; stability line:2 --time 0; falsify; falsify energy
{FALSIFY} --replay torn.json; export; export gromacs hexagon -o it; export lammps hexagon; prove no-such
prove --jobs 0; prove --time-limit -1; prove -o torn.csv; scenarios --status x; theorems --no-such"""
CASES = [[v if word == "{}" else word for word in line.split()] for line, values in TABLE.items() for v in values]
CASES += [line.split() for line in ALONE.replace("\n", ";").split(";")]


@pytest.fixture(scope="module")
def places(tmp_path_factory):
    """A folder with what commands should not be given."""
    folder = tmp_path_factory.mktemp("places")
    whole = RUN.save(folder / "run.nc").read_bytes()
    (folder / "torn.nc").write_bytes(whole[: len(whole) // 2])
    for name, text in {
        "torn.csv": "x,y\n1.0,2.0\n3.0\n",
        "torn.json": '{"format": "flockana-cou',
        "deep.json": "[" * 100_000,
        "text.csv": "not a number\nnor this one\n",
        "wide.csv": "1,2,3,4\n",
    }.items():
        (folder / name).write_text(text)
    (folder / "folder").mkdir()
    for suffix in ("nc", "csv", "json", "png", "gif"):
        os.mkfifo(folder / f"pipe.{suffix}")
    return folder


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
