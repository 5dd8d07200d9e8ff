"""Flocks of the user's own, as FILE.py:NAME on the command line."""

import pytest

MINE = """import flockana as fl

flock = fl.Flock(fl.Algorithm1(), [[0.0, 0.0], [7.0, 0.0]], [[0.0, 0.1], [0.0, 0.0]], t_span=(0.0, 1.0))
law = flock.law


def margin(run):
    return 0.05 - abs(run.p).max(axis=(1, 2))


slow = fl.claim("slow", margin)
"""


@pytest.fixture
def mine(tmp_path):
    (tmp_path / "mine.py").write_text(MINE, encoding="utf-8")
    (tmp_path / "two.py").write_text(MINE + "other = flock\n", encoding="utf-8")
    (tmp_path / "broken.py").write_text("import flockana as fl\n\nfl.Gains(c1_alpha=-1.0)\n", encoding="utf-8")
    (tmp_path / "false.py").write_text("x = 1\ny = 1/0\n", encoding="utf-8")


@pytest.mark.parametrize("name", ["mine.py", "mine.py:flock", "two.py:other"])
def test_theorems_for_a_flock(mine, found, name):
    rows = {(row["theorem"], row["claim"]): row["status"] for row in found("theorems", "--for", name)}
    assert rows["os-1", "iii"] == rows["energy", "rate"] == "met"
    assert rows["alpha-flocking", "giant"] == "needs a run"


def test_a_table_is_printed(mine, call):
    code, out, err = call("theorems", "--for", "mine.py")
    assert (code, err) == (0, "")
    assert "os-1:iii" in out
    assert out.rstrip().splitlines()[-1].startswith("32 claims: ")


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("none.py", "none.py is no file: expected FILE.py:NAME"),
        ("mine.py:flok", "unknown flock in mine.py 'flok'; did you mean 'flock'?"),
        ("mine.py:law", "mine.py:law is Algorithm1(...): expected a flock; fl.Flock(law, q0) makes one"),
        ("mine.py:slow", "own claim>: expected a flock; fl.Flock(law, q0) makes one; a claim is checked --on it"),
        ("two.py", "two.py holds 2 flocks (flock, other): expected one, or FILE.py:NAME"),
        ("broken.py", "broken.py: c1_alpha = -1"),
        ("false.py", "false.py, line 2: ZeroDivisionError: division by zero"),
    ],
)
def test_what_is_refused(mine, refused, name, message):
    refused(message, "theorems", "--for", name)


def test_a_flock_is_verified_and_has_its_report(mine, call, tmp_path):
    code, out, err = call("verify", "mine.py:flock")
    assert (code, err) == (0, "")
    assert "os-1" in out
    assert "own flock" in out
    page = (tmp_path / "report" / "index.html").read_text(encoding="utf-8")
    assert "H(0) &lt; c*" in page or "H(0) < c*" in page
    assert "<svg" in page
    assert call("verify", "mine.py", "--seeds", "3")[0] == 2


def test_a_claim_in_a_file_is_checked_searched_and_counted(mine, found, call, refused):
    (verdict,) = found("verify", "mine.py:slow", "--on", "mine.py:flock")["verdicts"]
    assert (verdict["theorem"], verdict["status"], verdict["subject"]) == ("slow", "refuted", "own flock")
    rows = found("ensemble", "mine.py:flock", "--seeds", "1", "--theorem", "mine.py:slow")
    assert {row["of"]: row["share"] for row in rows} == {"verified": 0.0, "refuted": 1.0}
    assert call("falsify", "mine.py:slow", "--on", "mine.py:flock", "--budget", "3", "-o", "bad.json")[0] == 3
    assert found("falsify", "mine.py:slow", "--replay", "bad.json")["status"] == "refuted"
    refused(
        "a counterexample to 'slow', which is not in the catalogue: give that claim", "falsify", "--replay", "bad.json"
    )


@pytest.mark.slow
def test_every_command_that_takes_a_scenario_takes_a_flock_of_a_file(mine, call, found, tmp_path):
    assert found("run", "mine.py:flock", "-o", "run.nc")["t"] == [0.0, 1.0]
    assert found("verify", "mine.py:slow", "--on", "run.nc")["verdicts"][0]["claims"][0]["margin"] == -0.05
    assert found("equilibrium", "mine.py:flock", "--start", "start")["n"] == 2
    assert found("export", "lammps", "mine.py:flock", "-o", "lammps")["scenario"] == "mine.py:flock"
    assert call("animate", "mine.py:flock", "-o", "mine.gif", "--seconds", "1", "--fps", "2")[0] == 0


@pytest.mark.slow
def test_a_file_finds_the_modules_beside_it_and_so_do_worker_processes(mine, found, tmp_path):
    (tmp_path / "beside.py").write_text("reach = 7.0\n", encoding="utf-8")
    drawn = MINE.replace("[[0.0, 0.0], [7.0, 0.0]], [[0.0, 0.1], [0.0, 0.0]]", "start")
    start = "from beside import reach\n\n\ndef start(seed):\n    return [[0.0, 0.0], [reach + 0.1 * seed, 0.0]]\n\n\n"
    (tmp_path / "drawn_flocks.py").write_text(start + drawn, encoding="utf-8")
    asked = "ensemble", "drawn_flocks.py:flock", "--seeds", "2", "--jobs", "2", "--theorem", "drawn_flocks.py:slow"
    assert [(row["of"], row["share"]) for row in found(*asked)] == [("verified", 0.5), ("refuted", 0.5)]
