from flockana.theorems.headline import does_not_hold


def test_a_name_in_words_is_quoted_and_a_formula_is_not():
    assert does_not_hold("H(0) < c*") == "H(0) < c* does not hold"
    assert does_not_hold("connected") == "'connected' does not hold"
