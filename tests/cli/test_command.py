import os

import pytest


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["export", "lammps", "hexagon", "-o", ""], "--out '': the name is empty; choose another name; this folder is"),
        (["course", ""], "DIR '': the name is empty; choose another name; this folder is '.'"),
        (["prove", "-o", ""], "--output '': the name is empty; choose another name; this folder is '.'"),
        (["verify", "hexagon", "--report", ""], "--report '': the name is empty; choose another name; this folder is"),
        (["check", ""], "FILE '': the name is empty; choose another name"),
        (["falsify", "--replay", ""], "--replay '': the name is empty; choose another name"),
        (["lattice", ""], "cannot read '': the name is empty; choose another name"),
    ],
    ids=lambda value: " ".join(value) if isinstance(value, list) else "",
)
def test_an_empty_name_is_not_this_folder(refused, tmp_path, arguments, message):
    refused(message, *arguments)
    assert os.listdir(tmp_path) == []


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["ensemble", "hexagon", "--seeds", "0"], "'--seeds': "),
        (["ensemble", "hexagon", "--level", "high"], "'--level': "),
        (["explore", "--port", "99999"], "'--port': "),
        (["stability", "line:3", "--algorithm", "3"], "'--algorithm'"),
    ],
    ids=lambda value: " ".join(value) if isinstance(value, list) else "",
)
def test_a_value_that_is_refused_is_named(refused, arguments, message):
    refused(message, *arguments)
    refused(f"'{arguments[-1]}'", *arguments)


def test_help_is_given_whatever_else_is_wrong(call):
    code, out, err = call("course", "", "--help")
    assert (code, err) == (0, "")
    assert out.startswith("Usage")
