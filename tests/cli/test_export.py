"""`flockana export lammps`."""

from __future__ import annotations

import pytest

COMMAND = ("export",)


def test_a_scenario_is_written_and_what_is_missing_is_said(call, tmp_path):
    code, said, _ = call("lammps", "hexagon", "--out", "new", "--samples", 5, "--points", 500)
    assert code == 0
    assert "missing: velocity consensus" in said
    assert "table: force off by at most" in said
    for name in ("in.flock", "flock.data", "pair.table", "README.txt"):
        assert f"{name}: new/{name}" in said
        assert (tmp_path / "new" / name).exists()
    assert "N 500 RSQ" in (tmp_path / "new" / "pair.table").read_text()


def test_the_nearest_consensus_can_be_chosen(call, tmp_path):
    code, said, _ = call("lammps", "hexagon", "--out", tmp_path, "--consensus", "nearest")
    assert code == 0
    assert "nearly: velocity consensus" in said
    assert "dpd/ext/tstat" in (tmp_path / "in.flock").read_text()


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("gromacs", "hexagon"), "gromacs"),
        (("lammps", "hexagone"), "unknown scenario 'hexagone'"),
        (("lammps", "minimal-2d"), "has no pair term for LAMMPS to tabulate"),
        (("lammps", "hexagon", "--dt", "-1"), "expected a number > 0"),
    ],
)
def test_bad_input_is_told_and_nothing_is_written(call, tmp_path, arguments, message):
    code, _, error = call(*arguments, "--out", "new")
    assert code == 2
    assert message in error
    assert not (tmp_path / "new").exists()
