import json
from pathlib import Path

import pytest

from flockana.base.errors import FileError
from flockana.cli.command_output import show_files, show_json
from flockana.cli.picture_file import ensure_file


def test_only_files_that_were_written_are_named_and_never_broken(capsys, monkeypatch):
    monkeypatch.setenv("COLUMNS", "40")
    folder = Path("a-folder" * 9)
    show_files(saved=None, picture=folder / "it.png")
    assert capsys.readouterr().out == f"picture: {folder / 'it.png'}\n"


def test_json_holds_letters_as_they_are_and_no_nan(capsys):
    show_json({"κ": [1.5, None]})
    text = capsys.readouterr().out
    assert json.loads(text) == {"κ": [1.5, None]}
    assert "κ" in text
    with pytest.raises(ValueError, match="not JSON compliant"):
        show_json({"κ": float("nan")})


def test_a_file_that_is_not_asked_for_is_never_wrong(tmp_path):
    ensure_file(None, (".png",))
    ensure_file(tmp_path / "it.PNG", (".png",))
    with pytest.raises(FileError, match=r"make it first: mkdir -p .*new"):
        ensure_file(tmp_path / "new" / "it.PNG", (".png",))
    assert not (tmp_path / "new").exists()
