"""Representation of laws, gains and results: at most twelve lines, and a table in a notebook."""

from dataclasses import dataclass
from fractions import Fraction
from typing import Any

import numpy as np

import flockana as fl
from flockana.base.short_repr import ShortRepr, short_text


def test_a_short_repr_is_what_made_it():
    law = fl.Algorithm2(gains={"c1_gamma": [1.0, 2.0]}, target=fl.StaticTarget((0.0, 1.0)))
    assert eval(repr(law), vars(fl) | {name: getattr(fl, name) for name in fl.__all__}) == law
    assert "<td" in law._repr_html_() and "Gains(c1_alpha=30.0" in law._repr_html_()  # noqa: PT018


def test_long_values_are_cut_and_long_texts_are_broken_over_lines():
    law = fl.Algorithm2(gains={"c1_gamma": [1.5] * 500}, target=fl.StaticTarget((0.0, 0.0)))
    for shown in (law, fl.Disturbed(law, intensity=1.0), fl.scenario("zone-51").law):
        lines = repr(shown).splitlines()
        assert max(map(len, lines)) <= 120
        assert len(lines) <= 12
    assert "c1_gamma=(1.5, 1.5, 1.5, … 500 in all)" in repr(law).replace("\n  ", " ")
    assert len(repr(fl.verify("os-1", law=fl.Algorithm1(), q0=[[0.0], [8.0]]))) < 500


def test_numbers_are_pythons_own():
    assert short_text((np.float64(0.5), np.array([1.0, 2.0]))) == "(0.5, [1.0, 2.0])"
    assert short_text(np.zeros((5, 2))) == "<array of shape (5, 2)>"
    assert short_text((1.5,)) == "(1.5,)"
    assert [short_text(Fraction(*x)) for x in ((1, 3), (10**40 + 1, 4 * 10**40))] == ["Fraction(1, 3)", "0.25"]


def test_twelve_lines_hold_many_long_fields_and_an_own_repr_stays():
    made = type("Long", (ShortRepr,), {"__annotations__": {f"part_{k}": Any for k in range(16)}})
    assert len(repr(dataclass(made)(*["x " * 200] * 16)).splitlines()) <= 12

    @dataclass
    class Own(ShortRepr):
        x: int

        def __repr__(self):
            return "mine"

    @dataclass
    class Heir(Own):
        y: int

    assert repr(Own(1)) == repr(Heir(1, 2)) == "mine"
