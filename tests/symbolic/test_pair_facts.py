"""What is decided about formulas: hidden jumps, poles, kinks and spikes are found, smooth laws are proved."""

import dataclasses
from functools import partial
from typing import ClassVar

import numpy as np
import pytest
import sympy as sp

import flockana as fl
from flockana import AlphaInteraction, DeadZoneInteraction, FormulaInteraction, RationalWeight
from flockana.base.function_facts import Fact, conjunction
from flockana.symbolic.interval_decisions import is_zero
from flockana.symbolic.pair_facts import _NumericFormula
from tests.toys.formulas import alpha_formula, spring

END = "*(r - s)**2"  # ends smoothly
LJ = "4*e*((q/s)**12 - (q/s)**6)*(1 - (s/r)**2)**2"


def pair(potential, adjacency="(1 - s/r)**2", length=1.0, **parameters):
    return fl.pair_law(potential, adjacency=adjacency, range=3.0, length=length, parameters=parameters)


SMOOTH = [
    spring,
    alpha_formula,
    partial(pair, LJ, e=1.0, q=1.0, length=1.12),
    partial(pair, "D*(1 - exp(-a*(s - d)))**2*(1 - s/r)**2", D=1.0, a=2.0),
    partial(pair, "(s**2/d**2 - 1 - log(s**2/d**2))*(1 - s/r)**2", "(1 + cos(pi*s/r))/2"),
    partial(pair, "exp(-s/k)/s" + END, k=0.3),
    partial(pair, "tanh(1000000*(s - 1.3))" + END),
    partial(pair, "exp(-((s - 1.3)*1000)**2)" + END),
    partial(pair, "sqrt((s - 1.3)**2 + 1e-12)" + END),
    partial(pair, "sqrt(cos(s) + 2)" + END),
    partial(pair, "abs(s - 1)**3" + END),
    partial(pair, "s**1.5" + END),
    partial(pair, "Piecewise((s**2, s < k), (2*k*s - k**2, True))" + END, k=0.7),
    partial(pair, "atan(s)*asinh(s)*(1 + s)**-2" + END),
]


@pytest.mark.slow
@pytest.mark.parametrize("make", SMOOTH, ids=lambda make: make.args[0] if isinstance(make, partial) else make.__name__)
def test_smooth_laws_are_proved_smooth(make):
    law = make()
    assert (law.facts.smooth.status, law.facts.weight.status, law.facts.inside.status) == ("met", "met", "met")
    assert law.facts.smooth.width == 0.0
    assert not [fault for fault in law.faults if not fault.startswith("coincidence")]


ROUGH = [  # and where
    ("atan(tan(s))*s**2", "potential jumps", np.pi / 2),
    ("-atan(tan(60*s))", "potential jumps", None),
    ("asin(sin(4*s))", "force jumps", np.pi / 8),
    ("acos(cos(4*s))", "force jumps", np.pi / 4),
    ("1/(s - 1.3)**2", "potential has no limit", 1.3),
    ("1/(s**2 - 2.6*s + 1.69)", "potential has no limit", 1.3),
    ("atan(1/(s - 1.3))", "potential jumps", 1.3),
    ("exp(-1/(s - 1.3)**2)*atan(1/(s - 1.3)) + atan(1/(s - 1.3))", "potential jumps", 1.3),
    ("sqrt((s - 1.3)**2)", "force jumps", 1.3),
    ("sqrt(s**2 - 2.6*s + 1.69)", "force jumps", 1.3),
    ("sqrt(1 - sin(s)**2)", "force jumps", np.pi / 2),
    ("log(abs(s - 1.3))", "potential has no limit", 1.3),
    ("log((s - 1.3)**2)", "potential has no limit", 1.3),
    ("tanh(1/(s - 1.3))", "potential jumps", 1.3),
    ("1/(1 + exp(1/(s - 1.3)))", "potential jumps", 1.3),
    ("1/(cos(3*s) + 1)", "potential has no limit", np.pi / 3),
    ("asin(sin(1000*s))/1000", "force jumps", None),
    ("Piecewise((0, s < 1.3), (1e-3, True))", "potential jumps", 1.3),
    ("Piecewise((0, s < 1.3), (atan(1/(s - 1.7)), True))", "potential jumps", 1.7),
    ("atan(1/((s - 1.3)*(s - 1.3000001)))", "potential jumps", 1.3000001),
]


@pytest.mark.slow
@pytest.mark.parametrize(("text", "fault", "at"), ROUGH, ids=[text for text, _, _ in ROUGH])
def test_hidden_jumps_poles_and_kinks_are_found_with_a_witness(text, fault, at):
    smooth = pair(f"({text}){END}").facts.smooth
    assert smooth.status == "unmet"
    assert fault in smooth.detail
    low, high = smooth.witness
    assert high - low < 1e-14
    assert at is None or low == pytest.approx(at, abs=1e-6)


@pytest.mark.slow
@pytest.mark.parametrize(
    "text", ["sin(s - 1.3)/(s - 1.3)", "exp(-1/(s - 1.3)**2)", "((s - 1.3)**2)**(3/4)*(s - 1.3)**2", "exp(1/(s - r))"]
)
def test_what_no_enclosure_decides_is_assumed_with_the_width_that_is_left(text):
    """Smooth, but by a limit at one point: neither proved nor called a fault."""
    smooth = pair(f"{text}{END}").facts.smooth
    assert smooth.status == "assumed"
    assert 0.0 < smooth.width < 1e-9


CENTRE = 110.5 * 3.0 / 256.0  # halfway between two of 257 distances
SIGNS = [
    (f"(1 - s/r)**2*(1 - 2000*exp(-((s - {CENTRE})*1000)**2))", "unmet", "unmet"),
    (f"1 - 1.001*exp(-((s - {CENTRE})*1000000)**2)", "unmet", "unmet"),
    (f"1 - 0.999*exp(-((s - {CENTRE})*1000000)**2)", "met", "met"),
    ("-4*(1 - s/r)**2", "unmet", "unmet"),
    ("(1 - s/r)*(2 - s/r)", "met", "met"),
    ("(1 - s/r)**3*(s - 1)**2", "met", "unmet"),  # at the length
    ("(1 - s/r)**3*(s - 1.1)**2", "met", "assumed"),
    ("s**2 - 2.6*s + 1.69", "met", "assumed"),
    ("(1 + cos(pi*s/r))/2", "met", "met"),
    ("Piecewise((1, s < 1), ((1 + cos(pi*(s - 1)/(r - 1)))/2, True))", "met", "met"),
    ("Piecewise((1, s < 1), (0, True))", "met", "unmet"),
    ("0", "met", "unmet"),
    ("s - 1e-9", "unmet", "unmet"),
    ("1/s - 1/r", "met", "met"),
    ("-log(s/r)", "met", "met"),
    ("sin(s)**2", "met", "met"),
    ("(r - s)**5", "met", "met"),
    ("(s - r)**5", "unmet", "unmet"),
]


@pytest.mark.slow
@pytest.mark.parametrize(("adjacency", "weight", "inside"), SIGNS, ids=[text for text, _, _ in SIGNS])
def test_the_sign_of_an_adjacency(adjacency, weight, inside):
    facts = pair("s**2" + END, adjacency).facts
    assert (facts.weight.status, facts.inside.status) == (weight, inside)


def test_the_least_adjacency_is_cut_off_at_0_only_where_its_sign_is_proved(monkeypatch):
    facts = Fact("assumed"), Fact("assumed")
    monkeypatch.setattr(_NumericFormula, "_signs", lambda self: facts)
    assert pair("s**2" + END, "(s - 1)*(1 - s/r)").facts.least_weight[0] == pytest.approx(-1.0)


LEASTS = [
    ("k*(s - d)**2*(s - r)**2/2", 0.0, 4.5),
    ("-k*(s - r)**2*s**2", -(1.5**4), 0.0),
    ("k/s**2 + k*(s - r)**2*0", 1.0 / 9.0, np.inf),
    ("-k/s", -np.inf, -np.inf),
    ("-k*log(s/r)", 0.0, np.inf),
    ("k*s**1.5", 0.0, 0.0),
    ("k*log(s/r)", -np.inf, -np.inf),
    ("k*s*log(s/r)", -3.0 / np.e, 0.0),
    ("k*exp(-1/s)", 0.0, 0.0),
]


@pytest.mark.parametrize(("potential", "least", "contact"), LEASTS, ids=[text for text, _, _ in LEASTS])
def test_the_least_potential_and_that_at_contact(potential, least, contact):
    facts = pair(potential, k=1.0).facts
    for bounds, value in ((facts.least, least), (facts.contact, contact)):
        assert bounds[0] <= value + 1e-15
        assert bounds[1] >= value - 1e-15
        assert bounds == pytest.approx((value, value), rel=1e-11, abs=1e-11)


def test_a_force_is_integrated_with_bounds():
    law, paper = alpha_formula(), AlphaInteraction()
    assert law.facts.contact == pytest.approx((paper.c_star, paper.c_star), rel=1e-12)
    assert law.facts.contact[0] <= paper.c_star * (1.0 + 1e-13)
    assert law.facts.contact[1] >= paper.c_star * (1.0 - 1e-13)
    assert law.facts.least == pytest.approx((0.0, 0.0), abs=1e-11)
    assert fl.pair_law(force="sin(s)", adjacency=0, range=3.0, length=1.0).facts.smooth.status == "unmet"


def test_a_nonzero_jump_as_small_as_rounding_is_no_fault_and_no_proof():
    facts = [pair(f"Piecewise((s**2 + {height}, s < 1), (s**2, True)){END}").facts.smooth for height in (1e-14, 1e-3)]
    assert [fact.status for fact in facts] == ["assumed", "unmet"]


@dataclasses.dataclass(frozen=True)
class Changed(AlphaInteraction):
    """A derived law, of which nothing is known."""


@dataclasses.dataclass(frozen=True)
class Proved(AlphaInteraction):
    """A derived law that names what is proved of it."""

    proofs: ClassVar = {"smooth": "a theorem of ours", "weight": "the same"}


def test_other_pair_laws_name_their_proofs_or_are_assumed():
    assert AlphaInteraction().facts.smooth.status == "met"
    assert {Changed().facts.smooth.status, DeadZoneInteraction().facts.weight.status} == {"assumed"}
    assert Proved().facts.smooth == Fact("met", "a theorem of ours")
    assert (Proved().facts.weight.status, Proved().facts.inside.status) == ("met", "assumed")
    assert RationalWeight().facts.weight.status == "met"


def test_facts_are_those_of_the_numbers():
    law = pair("k*(r - s)**2*s**2", "k*(1 - s/r)**2", k=1.0)
    assert law.facts.weight.status == "met"
    assert law.with_parameters(k=-1.0).facts.weight.status == "unmet"


def test_together():
    one, two = Fact("assumed", "a", (0.0, 1.0), 1.0), Fact("assumed", "b", (2.0, 3.0), 0.5)
    assert conjunction([one, two, Fact("met")]) == Fact("assumed", "a; b", (0.0, 1.0), 1.5)
    assert conjunction([Fact("met")], "why") == Fact("met", "why")
    assert isinstance(spring(), FormulaInteraction)


@pytest.mark.slow
@pytest.mark.parametrize("law", [spring(), alpha_formula()], ids=["in s", "in the norm"])
def test_slopes_are_bounded_on_parts_of_the_range(law):
    """Against differences: never below them, and within a factor of 3 of the largest."""
    s = np.linspace(1e-3, law.range * (1.0 - 1e-9), 40001)
    force, weight = (np.abs(np.diff(of(s)) / np.diff(s)) for of in (law.force, law.adjacency))
    for bound in law.slopes(16):
        inside = (s[:-1] >= bound.left) & (s[1:] <= bound.right)
        for most, seen in ((bound.force, force[inside].max()), (bound.adjacency, weight[inside].max())):
            assert seen * (1.0 - 1e-6) - 1e-9 <= most <= 3.0 * seen + 1e-6 * law.strength


def test_slopes_at_a_pole_have_no_bound():
    slopes = [bound.force for bound in pair("k*s**2/(r - s)", k=1.0).slopes(4)]
    assert np.isfinite(slopes[:3]).all()
    assert slopes[3] == np.inf


def test_a_number_is_zero_by_algebra_or_not_by_its_enclosure():
    k = sp.Symbol("k")
    assert is_zero(k - 2, {k: sp.Integer(2)}) is True
    assert is_zero(k - sp.pi, {k: sp.Integer(3)}) is False
