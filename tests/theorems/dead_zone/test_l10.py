"""Erratum L10: a condition that suffices, and that is not necessary."""

import numpy as np
import pytest

from flockana import DeadZoneFlocking, simulate
from flockana.theorems.dead_zone.l10 import energy_share, escaping_pair


def test_the_same_pair_without_damping_parts():
    """On a line and undamped the condition is both: 2 ψ̄(r) is enough to leave, less than ψ̄(r) is not."""
    law, q, p = escaping_pair()
    free = DeadZoneFlocking(law.interaction, k2=0.0)
    assert energy_share(free, q, p) == pytest.approx(2.0)
    assert np.ptp(simulate(free, q, p, (0.0, 20.0)).q[-1, :, 0]) > 50.0
    slow = 0.6 * p
    assert energy_share(free, q, slow) < 1.0
    run = simulate(free, q, slow, (0.0, 60.0))
    assert np.ptp(run.q[:, :, 0], axis=1).max() < law.interaction.r
