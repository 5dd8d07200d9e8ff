"""Certificates of basins: a change of any number is seen, and of one that was sealed again no false claim passes."""

import json
from collections.abc import Iterator
from fractions import Fraction
from pathlib import Path

import pytest
from flint import arb

import flockana.certified.check
from flockana import Algorithm1, certify
from flockana.base.errors import FileError
from flockana.certified import check_basin
from flockana.certified.certificate import basin_certificate, write_certificate
from flockana.certified.check import RejectedError, check_certificate, check_data, positive, unit
from flockana.cli.main import main
from flockana.equilibria.record import smallest_strained
from flockana.lattice import hexagonal_patch
from tests.certified.conftest import ALL, basin_of, leaf, resealed, with_leaf


def numbers(data, path=()) -> Iterator[tuple]:
    """Where the numbers of a certificate stand, in text or not; not those of the statement."""
    if isinstance(data, dict):
        for key in data:
            if key not in ("statement", "prose", "digest", "made_with", "format", "kind", "algorithm"):
                yield from numbers(data[key], (*path, key))
    elif isinstance(data, list):
        for k, item in enumerate(data):
            yield from numbers(item, (*path, k))
    else:
        yield path


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
    ours = {"basin", "shells", "lyapunov", "structure", "at_rest", "krawczyk", "energies", "agent_terms"}
    ours |= {"flow", "lohner", "series", "enclose", "tube", "formulas"}
    checkers = {"check", "check_basin", "check_motion", "check_tube", "intervals"}
    folder = Path(flockana.certified.check.__file__).parent
    for group, others in ((checkers, ours | {"certificate"}), (ours, checkers)):
        for module in sorted(group):
            lines = (folder / f"{module}.py").read_text(encoding="utf-8").splitlines()
            imports = [line for line in lines if line.startswith(("from", "import"))]
            assert not any(f"flockana.certified.{name} " in line for line in imports for name in others), module


def test_a_change_of_any_one_number_is_rejected():
    data = small()
    places = list(numbers(data))
    assert len(places) > 60
    for path in places:
        inner = leaf(data, path)
        old = value(inner)
        for new in (old + 1, old - 1) if isinstance(inner, int) else (old * 1001 / 1000 + (old == 0), old + 1):
            assert rejected(with_value(data, path, new)), path
    assert not rejected(data)


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


def pair_data():
    return json.loads(json.dumps(basin_certificate(basin_of("pair", 1))))


def test_a_law_that_damps_nothing_proves_no_rate():
    with pytest.raises(RejectedError, match="nothing damps"):
        check_data(resealed(with_value(pair_data(), ("law", "c2_alpha"), Fraction(0))))
