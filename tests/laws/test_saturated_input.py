"""Saturated laws: bounded inputs, the energy's balance, bad input."""

import numpy as np
import pytest

from flockana import Algorithm1, Algorithm2, Saturated, StaticTarget, simulate
from flockana.lattice import hexagonal_patch
from tests.refused import refused

LAW = Algorithm2(target=StaticTarget((30.0, 0.0)))
Q = 0.8 * hexagonal_patch(1, 7.0)


@pytest.mark.slow
@pytest.mark.parametrize("law", [Algorithm1(), LAW])
@pytest.mark.parametrize("by", ["length", "component"])
def test_inputs_stay_within_the_limit_and_the_balance_is_kept(law, by):
    run = simulate(Saturated(law, 3.0, by), Q, 0.0 * Q + 0.5, (0.0, 2.0), rtol=1e-9)
    size = np.linalg.norm(run.u, axis=2) if by == "length" else np.abs(run.u)
    assert size.max() == pytest.approx(3.0, rel=1e-12)
    assert np.abs(run.energy_residual).max() < 1e-6 * np.abs(run.energy()).max()


def test_a_falling_agent_by_hand():
    """The pull is beyond the limit for the first unit of time: free fall at 2."""
    run = simulate(Saturated(LAW, 2.0), [[0.0, 0.0]], [[0.0, 0.0]], (0.0, 1.0), t_eval=[1.0])
    assert run.q[-1, 0].tolist() == pytest.approx([1.0, 0.0])


test_bad_input = refused((lambda: Saturated(LAW, 1.0, "axis"), "by = 'axis': expected one of length, component"))
