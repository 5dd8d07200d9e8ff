"""The command line, called in an empty folder."""

import json
import math
from importlib import import_module

import pytest

from flockana.cli.main import main


@pytest.fixture
def call(request, capsys, tmp_path, monkeypatch):
    """Exit status, output and errors of a command; a file's COMMAND goes before the arguments of all its calls."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("COLUMNS", "80")
    monkeypatch.setattr("flockana.base.progress._EVERY", math.inf)  # seconds: no lines on a slow machine
    command = getattr(request.module, "COMMAND", ())

    def run(*arguments):
        with pytest.raises(SystemExit) as end:
            main([*command, *map(str, arguments)])
        out = capsys.readouterr()
        return end.value.code, out.out, out.err

    return run


@pytest.fixture
def found(call):
    """What a command that succeeds prints with --json."""

    def run(*arguments):
        code, out, err = call(*arguments, "--json")
        assert (code, err) == (0, "")
        return json.loads(out)

    return run


@pytest.fixture
def refused(call):
    """Bad input: exit status 2, nothing on the output and one line that says what is wrong."""

    def run(message, *arguments):
        code, out, err = call(*arguments)
        assert (code, out) == (2, "")
        assert err.startswith("flockana: ")
        assert err.count("\n") == 1
        assert message in err

    return run


@pytest.fixture
def offer(monkeypatch):
    """Makes scenarios the whole catalogue, until the test ends: their builders by name."""

    def only(**builders):
        monkeypatch.setattr(import_module("flockana.scenarios.scenario"), "catalogue", lambda: builders)

    return only
