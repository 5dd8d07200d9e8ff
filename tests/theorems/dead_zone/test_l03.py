"""Erratum L3: how the force and its potential grow where two agents meet, by algebra."""


def test_a_force_that_is_unbounded_has_a_potential_of_a_logarithm(verdict_of):
    printed, corrected = (verdict_of("L3").claim(name) for name in ("printed", "corrected"))
    assert (printed.status, printed.rigour, printed.computed) == ("refuted", "symbolic", "2*k_r")
    assert (corrected.status, corrected.rigour, corrected.computed) == ("verified", "symbolic", ["0"] * 5)
