"""Erratum E10: the bump function jumps at h = 1."""


def test_it_is_a_jump_by_one(verdict_of):
    assert verdict_of("E10").claim("printed").computed == "ρ₁(1⁻) - ρ₁(1⁺) = 1"
