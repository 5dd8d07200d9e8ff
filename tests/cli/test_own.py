"""Flocks of the user's own, as FILE.py:NAME on the command line."""

import pytest

MINE = """import flockana as fl

flock = fl.Flock(fl.Algorithm1(), [[0.0, 0.0], [7.0, 0.0]], [[0.0, 0.1], [0.0, 0.0]], t_span=(0.0, 1.0))
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
