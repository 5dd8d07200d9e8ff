import json

import pytest

from flockana.cli.groups import GROUPS, example
from flockana.cli.main import _COMMANDS, main


def printed(capsys, *arguments):
    with pytest.raises(SystemExit) as ended:
        main(list(arguments))
    output = capsys.readouterr()
    return ended.value.code, output.out, output.err


def test_root_help_has_every_command_once_with_its_example(capsys):
    code, text, _ = printed(capsys)
    assert code == 0
    for name in _COMMANDS:
        assert sum(line.startswith(f"  {name} ") for line in text.splitlines()) == 1, name
        assert f"$ {example(name)}" in text
    assert max(map(len, text.splitlines())) <= 80
    assert all(entry[1].startswith(f"flockana {name} ") for group in GROUPS.values() for name, entry in group.items())


@pytest.mark.parametrize("name", [name for name in _COMMANDS if name != "explore"])  # explore serves a page
def test_every_command_has_results_to_pipe(capsys, name):
    assert "--json" in printed(capsys, name, "--help")[1]


def test_theorems_are_a_line_each_and_filtered(capsys):
    _, text, _ = printed(capsys, "theorems", "collision", "--source", "olfati", "--status", "verified")
    names = [line.split()[0] for line in text.splitlines()[1:-1]]
    assert {"collision-energy", "os-1", "os-3"} <= set(names)
    assert "L6" not in names
    code, _, error = printed(capsys, "theorems", "--source", "nobody")
    assert code == 2
    assert "expected part of" in error
    _, whole, _ = printed(capsys, "theorems")
    assert len(whole.splitlines()) < 100
    _, none, _ = printed(capsys, "theorems", "zebra")
    assert none == "0 theorems\n"


def test_scenarios_as_json(capsys):
    _, text, _ = printed(capsys, "scenarios", "hexagon", "--json")
    entries = {entry["name"]: entry for entry in json.loads(text)}
    assert entries["hexagon"]["n"] == 7
    assert entries["hexagon"]["source"] == "Olfati-Saber 2006"


def test_a_missing_folder_is_not_made(capsys, tmp_path):
    target = tmp_path / "runs" / "one.nc"
    code, _, error = printed(capsys, "run", "hexagon", "-o", str(target))
    assert code == 2
    assert f"make it first: mkdir -p {target.parent}" in error
    assert not target.parent.exists()


def test_a_saved_run_is_animated_and_checked_with_one_refusal(capsys, tmp_path):
    run, film = tmp_path / "one.nc", tmp_path / "one.gif"
    code, text, _ = printed(capsys, "run", "hexagon", "-o", str(run), "--json")
    assert code == 0
    assert json.loads(text)["status"] == "complete"
    code, text, _ = printed(capsys, "animate", "--on", str(run), "-o", str(film), "--seconds", "0.2", "--json")
    assert (code, json.loads(text)["file"]) == (0, str(film))
    assert film.stat().st_size > 0
    _, text, _ = printed(capsys, "verify", "os-3", "--on", str(run), "--no-report")
    assert text.count("Algorithm 2 is applied: Algorithm1") == 3  # one for each author of claims
    code, _, error = printed(capsys, "animate", "-o", str(film))
    assert code == 2
    assert "expected a scenario, or --on" in error
