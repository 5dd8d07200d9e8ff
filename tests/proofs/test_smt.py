"""What a step rests on is what was proved: false constants put into the proofs, one at a time, make a step fail."""

import importlib
import inspect
import types

import pytest

pytest.importorskip("z3")  # the extra flockana[proofs]

import z3

from proofs.smt import implication, lemma
from tests.proofs.steps import failing


def mutant(name, old, new):
    """A module of proofs with one piece of its source replaced."""
    source = inspect.getsource(importlib.import_module(f"proofs.{name}"))
    assert source.count(old) == 1, old
    module = types.ModuleType(f"proofs.{name}_mutant")
    module.__package__ = "proofs"
    exec(compile(source.replace(old, new), name, "exec"), vars(module))
    return module


MUTANTS = [
    ("cohesion", "_radius", "C1 * OWN <= 2 * H0", "C1 * OWN <= H0"),  # J without ½
    ("cohesion", "_radius", "        (N - 1) * REST >= OWN,\n", "        REST >= (N - 1) * OWN,\n"),
    ("cohesion", "_radius", "X[1, 1] ** 2: OWN, X[2, 1] ** 2: REST", "X[1, 1] ** 2: OWN / 2, X[2, 1] ** 2: REST / 2"),
    ("signs_of_phi", "_control", "        gap**2 <= 2 * p_i + 2 * p_j,\n", "        gap**2 <= p_i + p_j,\n"),
    ("signs_of_phi", "_control", "u <= n * (c1 * bound + 2 * c2 * s)", "u <= n * (c1 * bound + c2 * s)"),
    ("signs_of_phi", "_phi", "f > -B, f < A), *known, latex", "f > -B, f < A / 2), *known, latex"),
    ("signs_of_phi", "_phi", "(A + B) * (s + C) + (A - B) * w", "(A + B) * (s + C) - (A - B) * w"),
    ("signs_of_phi", "potential_signs", "(Z - D_ALPHA) * g == PAIR", "(D_ALPHA - Z) * g == PAIR"),
    ("collisions", "_instant", "TOGETHER * C1 * C_STAR <= H,", "2 * TOGETHER * C1 * C_STAR <= H,"),
    ("bearing_distance", "_energies", "z3.And(x >= rho - gap, rho - gap > 0)", "z3.And(x >= rho - gap / 2, rho > gap)"),
    ("bearing_distance", "_energies", "square / 2 + MU * (length", "square + MU * (length"),
    ("dead_zone_parting", "separation_steps", "(defaults(), FROM", "(defaults() | {R_D: sp.Integer(16)}, FROM"),
    ("dead_zone_parting", "separation_steps", "KEPT = 14, 12, 9", "KEPT = 13, 12, 9"),
    ("dead_zone_parting", "separation_steps", "f <= p_r * n_r + k1 * r,", "2 * f <= p_r * n_r + k1 * r,"),
    ("dead_zone_pairs", "rest_steps", "STIFF = 50", "STIFF = 1"),
]


@pytest.mark.parametrize(("name", "part", "old", "new"), MUTANTS, ids=lambda value: value[:40])
def test_a_false_constant_makes_a_step_fail(name, part, old, new):
    try:
        broken = failing(getattr(mutant(name, old, new), part)())
    except ValueError:  # an enclosure with no certain digits
        broken = ["stopped"]
    assert broken


def test_an_unproved_lemma_gives_nothing():
    x, y = z3.Reals("x y")
    good, bad = lemma("square", x * x >= 0, x > 1), lemma("positive", x > 0, x >= 0)
    assert (good.step.holds, bad.step.holds) == (True, False)
    assert implication("by it", y * y >= 0, good.at({x: y}), y > 1).holds is True
    assert implication("by that", y > 0, bad.at({x: y}), y >= 0).holds is False
    assert implication("by that", y > 0, bad.then({x: y}), y >= 0).holds is False


def test_a_lemma_is_used_on_its_condition():
    x, f, y = z3.Reals("x f y")
    double = lemma("twice", f > 0, f == 2 * x, when=x > 0)
    assert double.step.holds is True
    assert implication("there", f > 0, double.then({x: y}), y > 1).holds is True
    assert implication("elsewhere", f > 0, double.then({x: y}), y > -1).holds is False
