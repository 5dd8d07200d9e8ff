"""Which laws the compiled loop may step: those whose force it computes itself."""

from __future__ import annotations

import numpy as np
import pytest

from flockana.interactions.dead_zone import DeadZoneInteraction
from flockana.laws.dead_zone import DeadZoneFlocking
from flockana.laws.semi_implicit import SemiImplicitEuler

Q, P = np.array([[0.0, 0.0], [2.0, 0.0], [0.0, 14.0]]), np.array([[0.1, 0.0], [0.0, 0.2], [0.0, 0.0]])


class Idle(DeadZoneInteraction):
    """A pair that does not push."""

    def forces(self, q, p, *, stiffness, damping, out=None):
        return np.zeros_like(q) if out is None else out, 0.0


class Pulled(DeadZoneFlocking):
    """A wind blows, too."""

    def flow(self, t, q, p):
        u, rate = super().flow(t, q, p)
        return u + 1.0, rate


@pytest.mark.parametrize(
    "law", [DeadZoneFlocking(), DeadZoneFlocking(Idle()), Pulled()], ids=["itself", "another pair", "another law"]
)
def test_a_step_is_by_the_laws_own_force_whatever_it_inherits(law):
    u = law.flow(0.0, Q, P)[0]
    q, p, applied, _ = SemiImplicitEuler(law, 0.01).step(0.0, Q, P, {})
    np.testing.assert_allclose(applied, u, rtol=0.0, atol=1e-13 * 100.0)
    np.testing.assert_allclose(p, P + 0.01 * u, rtol=0.0, atol=1e-13)
    np.testing.assert_allclose(q, Q + 0.01 * p, rtol=0.0, atol=1e-13)
    np.testing.assert_allclose(SemiImplicitEuler(law, 0.01).iterate(0.0, Q, P, {}, 1)[1][-1], p, rtol=0.0, atol=1e-13)
