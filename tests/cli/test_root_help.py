import json
import re
from pathlib import Path

import pytest

from flockana.cli import matplotlib_folder
from flockana.cli.root_help import EXAMPLES
from flockana.theorems import theorems


def test_root_help_has_every_command_once_with_its_example(call):
    code, text, _ = call()
    assert code == 0
    for name, example in EXAMPLES.items():
        assert sum(line.startswith(f"  {name} ") for line in text.splitlines()) == 1, name
        assert example.startswith(f"flockana {name} ")
        assert f"$ {example}" in text
    assert max(map(len, text.splitlines())) <= 80
    commands = Path(matplotlib_folder.__file__).parent.glob("*.py")
    assert {*re.findall(r"^def (\w+)_command\(", "".join(path.read_text() for path in commands), re.M)} == {*EXAMPLES}


@pytest.mark.parametrize("name", [name for name in EXAMPLES if name != "explore"])  # explore serves a page
def test_every_command_has_results_to_pipe(call, name):
    assert "--json" in call(name, "--help")[1]


def test_theorems_are_a_line_each_and_filtered(call, refused):
    _, text, _ = call("theorems", "collision", "--source", "olfati", "--status", "verified")
    names = [line.split()[0] for line in text.splitlines()[1:-1]]
    assert {"collision-energy", "os-1", "os-3"} <= set(names)
    assert "L6" not in names
    refused("expected part of", "theorems", "--source", "nobody")
    _, whole, _ = call("theorems")
    assert sum(line.startswith("  ") for line in whole.splitlines()) == len(theorems())
    _, none, _ = call("theorems", "zebra")
    assert none == "0 theorems\n"
    entries = json.loads(call("scenarios", "hexagon", "--json")[1])
    assert [entry["n"] for entry in entries if entry["name"] == "hexagon"] == [7]


def test_a_saved_run_is_animated_and_checked_with_one_refusal(call, refused, tmp_path):
    run, film = tmp_path / "one.nc", tmp_path / "one.gif"
    code, text, _ = call("run", "hexagon", "-o", str(run), "--json")
    assert code == 0
    assert json.loads(text)["status"] == "complete"
    code, text, _ = call("animate", str(run), "-o", str(film), "--seconds", "0.2", "--json")
    assert (code, json.loads(text)["file"]) == (0, str(film))
    assert film.stat().st_size > 0
    _, text, _ = call("verify", "os-3", "--on", str(run), "--no-report")
    assert text.count("'Algorithm 2 is applied' does not hold:") == 3  # one for each author of claims
    assert text.count("Algorithm1") == 4  # and with the hypothesis itself
    _, text, _ = call("verify", "energy", "--on", "three-agents-1d", "--no-report", "--json")
    assert [v["theorem"] for v in json.loads(text)["verdicts"]] == ["energy"]
    refused("expected a theorem to check on it", "verify", "hexagon", "--on", "three-agents-1d")
    _, text, _ = call("falsify", "energy", "--on", str(run), "--budget", "1", "--json")
    assert json.loads(text)["scenario"] == str(run)
