"""The numbers that proofs print: bounds rounded away from what they bound, and statements made of what was computed."""

import ast
import re
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import pytest

pytest.importorskip("z3")  # the extra flockana[proofs]

from flint import arb, ctx

import proofs as package
from flockana.certified import decimal_rounding
from flockana.certified.balls import AlphaParameters
from proofs import n_max, unstressed_patches
from proofs.proof import Step, names, proofs
from proofs.run import Outcome

LABEL = re.compile(r"Theorem \d+(?:\([ivx]+\))?|\(\d+\)")  # of what a number names
NUMERAL = re.compile(r"(?<![\w₀-₉^_.,'])\d+(?:\.\d+)?(?:e-?\d+)?(?![\w.])")
WORDS = re.compile(r"\b(four|five|six|seven|eight|nine|ten|eleven|twelve|thirteen)\b")
SMALL = {"0", "1", "2", "3"}  # dimensions, and the sizes in formulas


@pytest.fixture(autouse=True)
def digits():
    with ctx.workdps(30):
        yield


@pytest.mark.parametrize("text", ["0.3640975013", "-0.3640975013", "14.0000004999", "2e-9", "0.5", "12"])
@pytest.mark.parametrize("places", [0, 2, 6, 11])
def test_bounds_are_rounded_outward_and_no_further_than_a_unit(text, places):
    exact, unit = Fraction(text), Fraction(1, 10**places)
    low, high = (Fraction(f(arb(text), places)) for f in (decimal_rounding.at_least, decimal_rounding.at_most))
    assert low <= exact <= high
    assert exact - low <= unit * (1 + Fraction(1, 10**9))
    assert high - exact <= unit * (1 + Fraction(1, 10**9))


def test_the_bound_that_was_printed_inward():
    assert decimal_rounding.at_least(arb("0.3640975013")) == "0.364097"
    assert decimal_rounding.small(arb("2.39e-42")) == "2.4e-42"
    assert decimal_rounding.small(arb("2.31e-42")) == "2.4e-42"
    assert decimal_rounding.small(arb("9.91e-3")) == "1.0e-2"
    assert decimal_rounding.small(arb("123456")) == "1.3e5"
    assert decimal_rounding.interval(arb(1, "0.25"), 3) in {"[0.749, 1.251]", "[0.750, 1.250]"}
    assert decimal_rounding.first_digits(arb("1.9089"), 3) == "1.908"
    assert decimal_rounding.first_digits(arb("1.909", "1e-9"), 3) is None
    assert decimal_rounding.decimal(Fraction("5.601")) == "5.601"
    assert decimal_rounding.interval(arb(1) / arb(0, 1)) == "[-∞, ∞]"
    shown = decimal_rounding.plus_minus(arb(2).sqrt(), 10).split(r" \pm ")
    middle, radius = map(Fraction, shown)
    assert (middle - radius) ** 2 < 2 < (middle + radius) ** 2


def test_the_curvature_of_nineteen_agents_is_not_printed_above_what_is_proved():
    sites = unstressed_patches.patch(2)
    least = unstressed_patches.least_curvature(sites, unstressed_patches.links_of(sites))
    step = list(unstressed_patches._patch(2))[-1]
    assert Fraction(step.evidence) <= Fraction(str(float(least)))
    assert step.evidence == "0.364097"


def test_a_number_of_the_statement_that_was_not_found_is_no_proof():
    good = Outcome("x", steps=[Step("a", True, found={"n": "23"})], values={"n": "23"})
    assert good.status == "proved"
    other = replace(good, values={"n": "99"})
    assert other.status == "failed"
    assert list(other.objections()) == ["n is 23, and not 99 as stated"]
    unfound = replace(good, steps=[Step("a", True)])
    assert unfound.status == "unknown"
    assert list(unfound.objections()) == ["no step finds n, stated as 23"]
    assert replace(good, values={}).status == "failed"


def test_the_sizes_of_n_max_are_found():
    par = AlphaParameters()
    _, ratio = n_max.bound_lengths(par)
    steps = [n_max.every_state(par, m, ratio) for m in (1, 2, 3)] + [n_max.every_lattice(par, m) for m in (1, 2)]
    found = {name: value for step in steps for name, value in step.found.items()}
    assert found == n_max.SIZES == n_max.PROOF.values
    assert set(found.items()) >= {("states", "23"), ("lattices", "14")}
    assert n_max.every_lattice(AlphaParameters(r="8.5"), 2).found == {}  # of the stated parameters alone


@pytest.mark.parametrize("proof", proofs(), ids=lambda proof: proof.id)
def test_the_values_of_a_proof_stand_in_what_it_says(proof):
    for name, value in proof.values.items():
        assert re.search(rf"(?<![\d.]){re.escape(value)}(?![\d.]*\d)", proof.statement + proof.hypotheses), name


@pytest.mark.parametrize("name", names())
def test_no_number_of_a_statement_is_typed_by_hand(name):
    """It comes from what was computed, by `values`, or from the constant that the steps use."""
    tree = ast.parse(Path(package.__path__[0], f"{name.replace('-', '_')}.py").read_text(encoding="utf-8"))
    (call,) = (
        node for node in ast.walk(tree) if isinstance(node, ast.Call) and getattr(node.func, "id", "") == "Proof"
    )
    (statement,) = (keyword.value for keyword in call.keywords if keyword.arg == "statement")
    typed = "".join(
        node.value for node in ast.walk(statement) if isinstance(node, ast.Constant) and isinstance(node.value, str)
    )
    assert set(NUMERAL.findall(LABEL.sub("", typed))) <= SMALL
    assert not WORDS.findall(typed)
