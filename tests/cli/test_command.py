import os

import pytest


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (
            ["export", "lammps", "hexagon", "-o", ""],
            "--output '': the name is empty; choose another name; this folder is",
        ),
        (["course", ""], "DIR '': the name is empty; choose another name; this folder is '.'"),
        (["prove", "-o", ""], "--output '': the name is empty; choose another name; this folder is '.'"),
        (["verify", "hexagon", "--output", ""], "--output '': the name is empty; choose another name; this folder is"),
        (["check", ""], "FILE '': the name is empty; choose another name"),
        (["falsify", "--replay", ""], "--replay '': the name is empty; choose another name"),
        (["lattice", ""], "cannot read '': the name is empty; choose another name"),
    ],
    ids=lambda value: " ".join(value) if isinstance(value, list) else "",
)
def test_an_empty_name_is_not_this_folder(refused, tmp_path, arguments, message):
    refused(message, *arguments)
    assert os.listdir(tmp_path) == []


def test_help_is_given_whatever_else_is_wrong(call):
    code, out, err = call("course", "", "--help")
    assert (code, err) == (0, "")
    assert out.startswith("Usage")
