"""Certificates of basins: a change of any number is seen, and of one that was sealed again no false claim passes."""

import copy
import json
from fractions import Fraction
from math import ceil, floor
from pathlib import Path

import numpy as np
import pytest
from flint import arb

import flockana as fl
import flockana.certified.certificate_check
from flockana import Algorithm1, certify
from flockana.base.errors import FileError
from flockana.base.integrity_seals import with_digest
from flockana.certified import certificate_check as forms
from flockana.certified import check_basin
from flockana.certified.certificate import basin_certificate, tube_certificate, write_certificate
from flockana.certified.certificate_check import RejectedError, check_certificate, check_data, positive, unit
from flockana.cli.main import main
from flockana.equilibria.equilibrium_files import smallest_strained
from flockana.lattice import hexagonal_patch
from tests.certified.conftest import ALL, basin_of, leaf, resealed, with_leaf


def value(text):
    return Fraction(float.fromhex(text)) if "0x" in str(text) else Fraction(str(text))


def with_value(data, path, new):
    """The same with another number there."""
    written = lambda old: int(new) if isinstance(old, int) else float(new).hex() if "0x" in old else str(new)  # noqa: E731
    return with_leaf(data, path, written)


def rejected(data) -> bool:
    try:
        check_data(data)
    except RejectedError:
        return True
    return False


def small():
    return json.loads(json.dumps(basin_certificate(basin_of("triangle", 1))))


@ALL
def test_what_was_certified_is_checked_by_other_code(basin):
    found = check_data(json.loads(json.dumps(basin_certificate(basin))))
    assert found.kind == "basin"
    assert len(found.steps) == 9
    assert len(found.prose) == 5


def test_the_checker_knows_nothing_of_the_prover():
    ours = {
        "basin",
        "curvature_shells",
        "lyapunov",
        "structural_potential",
        "enclosed_equilibrium",
        "krawczyk",
        "energies_in_balls",
        "agent_forces_in_balls",
    }
    ours |= {"flow_in_balls", "lohner", "pair_laws_in_series", "enclose_run", "tube", "formula_in_balls"}
    checkers = {"certificate_check", "check_basin", "check_motion", "check_tube", "scalar_functions_in_balls"}
    folder = Path(flockana.certified.certificate_check.__file__).parent
    for group, others in ((checkers, ours | {"certificate"}), (ours, checkers)):
        for module in sorted(group):
            lines = (folder / f"{module}.py").read_text(encoding="utf-8").splitlines()
            imports = [line for line in lines if line.startswith(("from", "import"))]
            assert not any(f"flockana.certified.{name} " in line for line in imports for name in others), module


CLAIMS = ["radius", "level", "curvature", "rate", "overshoot", "distance", "surplus", "second_eigenvalue", "degree"]


@pytest.mark.parametrize("name", [*CLAIMS, "curvatures"])
@pytest.mark.parametrize("sign", [1, -1])
def test_what_follows_is_stated_to_the_last_digit_even_when_it_is_sealed_again(name, sign):
    data = small()
    for path in [(name,)] if name in CLAIMS else [(name, 0), (name, 7), (name, 15)]:
        old = value(data[name] if len(path) == 1 else data[name][path[1]])
        digits = 3 if name in ("rate", "overshoot") else 4
        assert rejected(resealed(with_value(data, path, old + sign * unit(old, digits)))), path


@pytest.mark.parametrize(
    ("path", "factor"),
    [(("bonds", 0, "along", k), Fraction(21, 20)) for k in (0, 6)]
    + [(("bonds", 0, "across", k), Fraction(1, 2)) for k in (0, 8, 15)]
    + [(("law", name), Fraction(101, 100)) for name in ("d", "r", "eps", "h", "a")]
    + [(("law", "c1_alpha"), Fraction(99, 100)), (("law", "c2_alpha"), Fraction(1, 20))]
    + [(("lyapunov", name), Fraction(2)) for name in ("eps", "theta", "kappa", "tau")]
    + [
        (("positions", 0, 1), Fraction(10**9 + 1, 10**9)),
        (("box",), Fraction(10**12)),
        (("bonds", 0, "pairs", 0, 0), 9),
    ],
)
def test_false_premises_are_rejected_even_when_they_are_sealed_again(path, factor):
    data = small()
    assert rejected(resealed(with_value(data, path, (value(leaf(data, path)) or 1) * factor)))


def test_a_pair_left_out_is_missed():
    data = small()
    data["bonds"][0]["pairs"].pop()
    with pytest.raises(RejectedError, match="may come into range unseen"):
        check_data(resealed(data))


def test_the_command_says_what_holds_and_what_is_rejected(tmp_path, capsys):
    file, other = tmp_path / "pair.json", tmp_path / "other.json"
    write_certificate(basin_of("pair", 1), file)
    altered = {**json.loads(file.read_text(encoding="utf-8")), "radius": "0.6"}
    for path, text, code, said in (
        (file, None, 0, "a certificate of kind basin that holds"),
        (other, json.dumps(altered), 3, "is rejected: its digest is not that of its contents"),
        (other, "{}", 2, "is no certificate"),
    ):
        if text:
            path.write_text(text, encoding="utf-8")
        with pytest.raises(SystemExit) as end:
            main(["check", str(path)])
        assert end.value.code == code
        assert said in "".join(capsys.readouterr())


def test_what_is_no_certificate_is_no_certificate(tmp_path):
    file = tmp_path / "x.json"
    file.write_text("[1, 2", encoding="utf-8")
    with pytest.raises(FileError, match="is no certificate"):
        check_certificate(file)
    with pytest.raises(RejectedError, match="its kind 'wish' is unknown"):
        check_data(resealed({**small(), "kind": "wish"}))
    data = small()
    del data["bonds"]
    with pytest.raises(RejectedError, match="it lacks 'bonds': expected format, kind,"):
        check_data(resealed(data))


@pytest.mark.parametrize(("name", "share"), [("nineteen", 0.035), ("strained", 0.02)])
def test_larger_flocks_and_one_under_stress_have_certified_basins_too(name, share):
    if name == "strained":
        basin = certify(smallest_strained())
    else:
        basin = certify(hexagonal_patch(2, 7.0), law=Algorithm1())
        assert not rejected(json.loads(json.dumps(basin_certificate(basin))))
    assert share < basin.share < 0.05
    assert basin.connected
    assert basin.holds(basin.rest, 0.0 * basin.rest)


@pytest.mark.parametrize(("name", "sign", "why"), [("second_eigenvalue", 1, "not proved"), ("degree", -1, "degree")])
def test_the_net_itself_is_checked_and_not_only_what_follows(name, sign, why):
    data = small()
    old = value(data[name])
    with pytest.raises(RejectedError, match=why):
        check_data(resealed(with_value(data, (name,), old + sign * unit(old, 4))))


def test_a_stated_number_has_its_digits_and_no_more():
    rounded = check_basin.round_down_float
    assert rounded("7.740", Fraction("7.7405"))
    assert not rounded("7.7399", Fraction("7.7405"))
    assert not rounded("7.739", Fraction("7.7405"))
    assert not rounded("7.741", Fraction("7.7405"))


@pytest.mark.parametrize(
    "choice",
    [
        {"eps": "0"},
        {"eps": "-0.01"},
        {"kappa": lambda choice, curvature: choice["eps"] * Fraction(499, 1000)},
        {"theta": "1.001"},
        {"theta": "-0.001"},
        {"tau": "-1"},
        {"tau": lambda choice, curvature: -2 * choice["eps"]},  # by which the rate would be larger
        {"eps": lambda choice, curvature: curvature, "kappa": "1000000"},
    ],
    ids=["eps 0", "eps < 0", "kappa", "theta > 1", "theta < 0", "tau < 0", "tau and rate", "curvature"],
)
def test_what_makes_no_lyapunov_function_is_rejected_as_such(choice):
    data = pair_data()
    own, curvature = {name: Fraction(x) for name, x in data["lyapunov"].items()}, Fraction(data["curvature"])
    assert curvature > 1
    for name, new in choice.items():
        new = Fraction(new) if isinstance(new, str) else new(own, curvature)
        data["lyapunov"][name] = f"{new.numerator}/{new.denominator}"
    with pytest.raises(RejectedError, match="no Lyapunov function"):
        check_data(resealed(data))


@pytest.mark.parametrize(("corner", "holds"), [("1.51", True), ("1.5", False), ("1.49", False)])
def test_a_matrix_less_a_shift_is_positive_definite_to_its_last_minor(corner, holds):
    """[[3, 1], [1, x]] less 1 is so above x = 3/2, and a ball of such matrices if all of them are."""
    for sign in (1, -1):
        rows = [[arb(3), arb(sign)], [arb(sign), arb(corner)]]
        assert positive(rows, arb(1)) is holds
    assert not positive([[arb(3), arb(1)], [arb(1), arb(corner) + arb(0, 0.02)]], arb(1))
    assert [positive([[arb(x)]]) for x in (-0.5, 0.0, 0.5)] == [False, False, True]


def pair_data():
    return json.loads(json.dumps(basin_certificate(basin_of("pair", 1))))


@pytest.mark.parametrize(
    ("name", "factor", "term"), [("theta", 0.9, 0), ("kappa", 1.1, 1), ("kappa", 0.9, 2), ("eps", 1.02, 2)]
)
def test_the_rate_is_the_least_of_three(name, factor, term):
    """The best F has them alike; of others one is smaller, and the certificate holds with the rate that it leaves."""
    data = with_value(small(), ("lyapunov", name), value(small()["lyapunov"][name]) * Fraction(factor))
    eps, theta, kappa, tau = (value(data["lyapunov"][key]) for key in ("eps", "theta", "kappa", "tau"))
    names = ("curvature", "surplus", "second_eigenvalue", "degree")
    curvature, surplus, second, degree = (value(data[key]) for key in names)
    c2, mean = value(data["law"]["c2_alpha"]), theta * surplus + (1 - theta) * curvature
    pull = theta * curvature + 2 * mean - 2 * kappa * c2 * degree
    drag = (1 - eps / (2 * kappa)) * c2 * second - eps
    terms = [eps * theta, eps * pull / (curvature + eps * tau), 2 * drag / (1 + eps / tau)]
    assert terms.index(min(terms)) == term
    share = float(eps) / float(curvature) ** 0.5
    rate = Fraction(floor(min(terms) / 2 / (step := unit(min(terms) / 2, 3)))) * step
    beyond = unit(value(data["overshoot"]), 3)
    more = Fraction(ceil(Fraction((1 + share) / (1 - share)) / beyond)) * beyond
    fitted = with_value(with_value(data, ("rate",), rate), ("overshoot",), more)
    assert not rejected(resealed(fitted))
    assert rejected(resealed(with_value(fitted, ("rate",), rate + step)))


def test_a_law_that_damps_nothing_proves_no_rate():
    with pytest.raises(RejectedError, match="nothing damps"):
        check_data(resealed(with_value(pair_data(), ("law", "c2_alpha"), Fraction(0))))


# Forms of certificates: nothing that is not checked has a place, at any depth, and no number is without end.
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


def resealed_whole(data):
    """With digests that fit, that of a basin within too."""
    rest = {key: value for key, value in data.items() if key != "digest"}
    if isinstance(rest.get("basin"), dict):
        rest["basin"] = resealed_whole(rest["basin"])
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
    assert check_data(resealed_whole(DATA[name])).kind == DATA[name]["kind"]


@pytest.mark.parametrize(("name", "at"), CASES, ids=str)
def test_a_key_that_is_not_checked_is_refused_at_every_depth(name, at):
    for key, value in (("more", "1"), ("radius_", "1000"), ("", None), ("Digest", "0")):
        other = copy.deepcopy(DATA[name])
        leaf(other, at)[key] = value
        with pytest.raises(RejectedError, match=f"holds {key!r}: expected .*nothing else is checked"):
            check_data(resealed_whole(other))


@pytest.mark.parametrize(("name", "at"), CASES, ids=str)
def test_a_key_that_is_taken_out_is_refused_at_every_depth(name, at):
    for key in leaf(DATA[name], at):
        other = copy.deepcopy(DATA[name])
        del leaf(other, at)[key]
        with pytest.raises(RejectedError):
            check_data(other if key == "digest" else resealed_whole(other))


@pytest.mark.parametrize("name", DATA)
def test_a_key_that_is_given_twice_is_refused_at_every_depth(name, tmp_path):
    text = json.dumps(DATA[name])
    keys = sorted({key for at in objects(DATA[name]) for key in leaf(DATA[name], at)})
    for key in keys:
        (tmp_path / "twice.json").write_text(text.replace(f'"{key}": ', f'"{key}": "0", "{key}": '))
        with pytest.raises(FileError, match=f"the key '{key}' is given twice"):
            check_certificate(tmp_path / "twice.json")


def test_a_clearance_is_refused_where_there_is_no_sphere():
    with pytest.raises(RejectedError, match="clearance = '1000': expected null"):
        check_data(resealed_whole(DATA["tube"] | {"clearance": "1000"}))


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
            check_data(resealed_whole(other))


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
