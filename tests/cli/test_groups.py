import json

import pytest

from flockana.cli.groups import GROUPS, example
from flockana.cli.main import _COMMANDS


def test_root_help_has_every_command_once_with_its_example(call):
    code, text, _ = call()
    assert code == 0
    for name in _COMMANDS:
        assert sum(line.startswith(f"  {name} ") for line in text.splitlines()) == 1, name
        assert f"$ {example(name)}" in text
    assert max(map(len, text.splitlines())) <= 80
    assert all(entry[1].startswith(f"flockana {name} ") for group in GROUPS.values() for name, entry in group.items())


@pytest.mark.parametrize("name", [name for name in _COMMANDS if name != "explore"])  # explore serves a page
def test_every_command_has_results_to_pipe(call, name):
    assert "--json" in call(name, "--help")[1]


def test_theorems_are_a_line_each_and_filtered(call, refused):
    _, text, _ = call("theorems", "collision", "--source", "olfati", "--status", "verified")
    names = [line.split()[0] for line in text.splitlines()[1:-1]]
    assert {"collision-energy", "os-1", "os-3"} <= set(names)
    assert "L6" not in names
    refused("expected part of", "theorems", "--source", "nobody")
    _, whole, _ = call("theorems")
    assert len(whole.splitlines()) < 100
    _, none, _ = call("theorems", "zebra")
    assert none == "0 theorems\n"


def test_scenarios_as_json(call):
    _, text, _ = call("scenarios", "hexagon", "--json")
    entries = {entry["name"]: entry for entry in json.loads(text)}
    assert entries["hexagon"]["n"] == 7
    assert entries["hexagon"]["source"] == "Olfati-Saber 2006"


def test_a_missing_folder_is_not_made(refused, tmp_path):
    target = tmp_path / "runs" / "one.nc"
    refused(f"make it first: mkdir -p {target.parent}", "run", "hexagon", "-o", target)
    assert not target.parent.exists()


def test_a_saved_run_is_animated_and_checked_with_one_refusal(call, refused, tmp_path):
    run, film = tmp_path / "one.nc", tmp_path / "one.gif"
    code, text, _ = call("run", "hexagon", "-o", str(run), "--json")
    assert code == 0
    assert json.loads(text)["status"] == "complete"
    code, text, _ = call("animate", "--on", str(run), "-o", str(film), "--seconds", "0.2", "--json")
    assert (code, json.loads(text)["file"]) == (0, str(film))
    assert film.stat().st_size > 0
    _, text, _ = call("verify", "os-3", "--on", str(run), "--no-report")
    assert text.count("'Algorithm 2 is applied' does not hold:") == 3  # one for each author of claims
    assert text.count("Algorithm1") == 4  # and with the hypothesis itself
    refused("expected a scenario, or --on", "animate", "-o", film)
