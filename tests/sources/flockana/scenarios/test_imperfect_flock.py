"""Flocks as they are built: runs, expectations, ensembles."""

from __future__ import annotations

import numpy as np
import pytest

from flockana.scenarios import scenario


@pytest.mark.slow
def test_a_seed_is_another_wind_and_other_noise():
    ends = [scenario("as-built", seed).run().q[-1] for seed in (0, 0, 1)]
    np.testing.assert_array_equal(ends[0], ends[1])
    assert np.abs(ends[0] - ends[2]).max() > 1e-3
