"""A pair law that a user writes: read, cut into pieces, and derived."""

import pytest
import sympy as sp

from flockana.symbolic.pair_formula import PiecewiseFormula, S, derive_piece, pair_derivation, read_pair


def test_a_formula_is_read_derived_and_cut_where_its_pieces_meet():
    formula = read_pair("k*(s - d)**2/2", "", "0", ["k"])
    assert str(formula.derivative) == "k*(-2*d + 2*s)/2"
    piece = derive_piece(S**2 * (S - 1) ** 2 / 2, sp.Integer(1), S, forces=False)
    assert str(sp.expand(piece.weight)) == "-3*sqrt(s2) + 2*s2 + 1"
    pieces = read_pair("Piecewise((s**2, s < k), (0, True))", "", "0", ["k"])
    assert PiecewiseFormula(pieces, {sp.Symbol("k", real=True): 2.0}, 5.0).marks == (0.0, 2.0, 5.0)


@pytest.mark.parametrize("potential", ["k*(s**2 - eps)**2", "k*(z - eps)**2"])
def test_the_weight_is_the_slope_of_the_potential_in_either_distance(potential):
    derivation = pair_derivation(read_pair(potential, "", "1", ["k", "eps"]))
    assert derivation.holds
    assert len(derivation.residuals) == 1  # it was computed
