"""The how-to on files of trackers: its lines give the flock that was written as five tools write it."""

import re
from pathlib import Path

import numpy as np
import pytest

from tools.tool_files import FRAMES, NAMES, RATE, flock, write_tool_files

PAGE = Path(__file__).parents[2] / "docs" / "howto" / "recorded-tools.md"
SECTIONS = dict(re.findall(r"^## (.+?)\n.*?```python\n(.*?)```", PAGE.read_text(encoding="utf-8"), re.S | re.M))
SCALE = {"idtracker.ai": (200.0 / 40.0, 300.0 / 40.0)}  # bodies: 200 pixels to a unit, 40 to a body


@pytest.mark.parametrize("tool", ["A motion-capture log", "idtracker.ai", "TrackMate", "ROS", "LAMMPS"])
def test_five_lines_read_the_file_of_a_tool(tool, tmp_path, monkeypatch, capsys):
    write_tool_files(tmp_path)
    monkeypatch.chdir(tmp_path)
    code, names = SECTIONS[tool], dict[str, object]()
    assert len([line for line in code.splitlines() if line]) == 5
    exec(code, names)
    rec, (factor, shift), run = names["rec"], SCALE.get(tool, (1.0, 0.0)), flock()
    np.testing.assert_allclose(rec.t, np.arange(FRAMES) / RATE, atol=1e-9)
    off = np.linalg.norm(rec.q - (factor * run.q + shift), axis=2)
    assert (off < (rec.bound if tool == "ROS" else 1e-6))[rec.present].all()
    assert rec.gaps == {"TrackMate": 1, "ROS": 2}.get(tool, 0)
    said = capsys.readouterr().out
    match tool:
        case "ROS":
            assert rec.ids == NAMES
            assert rec.p is None
            assert np.nanmax(off) > 1e-6  # interpolated
        case "LAMMPS":
            assert "explains 100%" in said
            assert "c1α = 2 ±" in said
            assert "2 of 2 verified" in said
        case "A motion-capture log":
            apart = np.linalg.norm(run.q[:, [0, 0, 1]] - run.q[:, [1, 2, 2]], axis=2)
            assert float(said.split()[-1]) == pytest.approx(apart.min(), abs=1e-5)
