"""Forms of certificates: nothing that is not checked has a place, at any depth, and no number is without end."""

import copy
import json

import numpy as np
import pytest

import flockana as fl
from flockana.base.errors import FileError
from flockana.base.seals import with_digest
from flockana.certified import check as forms
from flockana.certified.certificate import basin_certificate, tube_certificate
from flockana.certified.check import RejectedError, check_certificate, check_data
from tests.certified.conftest import leaf, with_leaf


def certificates():
    law, led = fl.Algorithm1(), {"target": fl.StaticTarget((0.0, 0.0))}
    start = ([[0.0], [7.2]], [[0.0], [0.0]], (0.0, 0.0078125))
    sphere = fl.Algorithm3(**led, obstacles=(fl.Sphere((9.0, 0.0), 1.0),))
    yield "basin", basin_certificate(fl.certify([[0.0], [7.0]], law=law))
    yield "tube", tube_certificate(fl.enclose(law, *start), basin=None)
    near = fl.enclose(law, [[0.0], [7.01]], *start[1:])
    yield "tube in a basin", tube_certificate(near, basin=fl.certify([[0.0], [7.0]], law=law))
    among = fl.enclose(sphere, [[0.0, 0.0], [0.0, 7.2]], np.zeros((2, 2)), (0.0, 0.0078125))
    yield "tube among spheres", tube_certificate(among)


DATA = {name: json.loads(json.dumps(data)) for name, data in certificates()}


def resealed(data):
    """With digests that fit, that of a basin within too."""
    rest = {key: value for key, value in data.items() if key != "digest"}
    if isinstance(rest.get("basin"), dict):
        rest["basin"] = resealed(rest["basin"])
    return with_digest(rest)


def objects(data, at=()):
    """Where every JSON object stands."""
    if isinstance(data, dict | list):
        if isinstance(data, dict):
            yield at
        for key, value in data.items() if isinstance(data, dict) else enumerate(data):
            yield from objects(value, (*at, key))


CASES = [(name, at) for name, data in DATA.items() for at in objects(data)]


@pytest.mark.parametrize("name", DATA)
def test_what_was_written_has_the_form(name):
    assert check_data(resealed(DATA[name])).kind == DATA[name]["kind"]


@pytest.mark.parametrize(("name", "at"), CASES, ids=str)
def test_a_key_that_is_not_checked_is_refused_at_every_depth(name, at):
    for key, value in (("more", "1"), ("radius_", "1000"), ("", None), ("Digest", "0")):
        other = copy.deepcopy(DATA[name])
        leaf(other, at)[key] = value
        with pytest.raises(RejectedError, match=f"holds {key!r}: expected .*nothing else is checked"):
            check_data(resealed(other))


@pytest.mark.parametrize(("name", "at"), CASES, ids=str)
def test_a_key_that_is_taken_out_is_refused_at_every_depth(name, at):
    for key in leaf(DATA[name], at):
        other = copy.deepcopy(DATA[name])
        del leaf(other, at)[key]
        with pytest.raises(RejectedError):
            check_data(other if key == "digest" else resealed(other))


@pytest.mark.parametrize("name", DATA)
def test_a_key_that_is_given_twice_is_refused_at_every_depth(name, tmp_path):
    text = json.dumps(DATA[name])
    keys = sorted({key for at in objects(DATA[name]) for key in leaf(DATA[name], at)})
    for key in keys:
        (tmp_path / "twice.json").write_text(text.replace(f'"{key}": ', f'"{key}": "0", "{key}": '))
        with pytest.raises(FileError, match=f"the key '{key}' is given twice"):
            check_certificate(tmp_path / "twice.json")


def test_the_sphere_and_the_clearance_of_the_review_are_refused():
    """Algorithm 1 has neither: both were believed unseen."""
    with pytest.raises(RejectedError, match="clearance = '1000': expected null"):
        check_data(resealed(DATA["tube"] | {"clearance": "1000"}))
    sphere = {"centre": ["3"], "radius": "1"}
    for key, value in (("beta_d", "4.2"), ("c1_beta", "1"), ("spheres", []), ("spheres", [sphere])):
        other = DATA["tube"] | {"law": DATA["tube"]["law"] | {key: value}}
        with pytest.raises(RejectedError, match=f"law holds '{key}'"):
            check_data(resealed(other))


NUMBERS = [
    *(" 1e99999999", "1e99999999 ", "\n1e99999999", "0x1p 999999999", "1e9999", "1" * 501, "0x1p9999", "١", "1e٣", "-"),
    *("1,0", "1e", "1e-1_000_000_000", "1 /3", "1_0", "+1", ".5", "5.", "1E5", "0X1p3", "inf", "nan", "∞", ""),
]


@pytest.mark.parametrize("number", NUMBERS, ids=lambda number: repr(number[:15]))
def test_no_number_is_without_end_wherever_it_stands(number):
    for name, at in (
        ("basin", ("radius",)),
        ("basin", ("law", "d")),
        ("basin", ("bonds", 0, "along", 0)),
        ("basin", ("positions", 0, 0)),
        ("basin", ("lyapunov", "eps")),
        ("tube in a basin", ("basin", "radius")),
        ("tube", ("times", 1)),
        ("tube", ("paths", 0, 0, 0)),
        ("tube among spheres", ("law", "spheres", 0, "centre", 0)),
    ):
        other = with_leaf(DATA[name], at, lambda _: number)
        with pytest.raises(RejectedError, match=r"= .*: expected a .* at most 500 characters and 3 digits"):
            check_data(resealed(other))


def test_what_is_nested_without_end_is_refused(tmp_path):
    deep = "x"
    for _ in range(5000):
        deep = [deep]
    with pytest.raises(RejectedError):
        check_data(DATA["basin"] | {"curvatures": deep})
    for depth in (900, 100_000):
        (tmp_path / "deep.json").write_text(json.dumps(DATA["basin"]).replace('"box": ', '"box": ' + "[" * depth, 1))
        with pytest.raises(FileError):
            check_certificate(tmp_path / "deep.json")
    nested = json.loads("[" * 900 + "]" * 900)
    with pytest.raises(RejectedError):
        check_data(with_digest({k: v for k, v in DATA["basin"].items() if k != "digest"} | {"box": nested}))


def test_a_huge_file_is_not_read(tmp_path):
    with (tmp_path / "huge.json").open("wb") as file:
        file.truncate(2**28 + 1)  # a hole on the disk
    with pytest.raises(FileError, match="it has 268435457 bytes; expected at most 268435456"):
        check_certificate(tmp_path / "huge.json")


@pytest.mark.parametrize(
    ("data", "form", "message"),
    [
        (1, forms.NUMBER, "it = 1: expected a decimal in text"),
        (True, forms.WHOLE, "it = True: expected a whole number"),
        (1.0, forms.WHOLE, "it = 1.0: expected a whole number"),
        (1, forms.TRUTH, "it = 1: expected true or false"),
        ("x", [forms.TEXT], "it = 'x': expected a list"),
        ([["1"], ["x"]], [[forms.NUMBER]], r"it\[1\]\[0\] = 'x': expected a decimal"),
        ({"a": {"b": []}}, {"a": {"b": None}}, r"a.b = \[\]: expected null"),
        ([], {"a": forms.ANY}, r"it = \[\]: expected names with their values"),
    ],
)
def test_what_is_of_another_form_is_told_with_its_leaf(data, form, message):
    with pytest.raises(RejectedError, match=message):
        forms.ensure_form(data, form)
