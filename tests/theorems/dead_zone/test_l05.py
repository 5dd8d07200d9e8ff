"""Erratum L5: the energy of neighbours jumps by the potential at the range."""

import pytest

from flockana.interactions import DeadZoneInteraction


def test_the_jump_is_the_potential_at_the_range(verdict_of):
    far = DeadZoneInteraction(ramp=0.0).far_potential
    assert verdict_of("L5").claim("printed").computed == pytest.approx(far, rel=1e-9)
