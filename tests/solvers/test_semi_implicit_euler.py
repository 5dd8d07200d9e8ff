"""Which laws the compiled loop may step: those whose force it computes itself."""

import numpy as np
import pytest

from flockana import DeadZoneFlocking, DeadZoneInteraction, FixedSteps, SemiImplicitEuler, TaylorStep

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


class Drifting(FixedSteps):
    """A map of one's own, which remembers something."""

    def start(self, q, p):
        return {"drift": np.zeros(1)}

    def step(self, t, q, p, memory):
        q, p, u, _ = super().step(t, q, p, memory)
        return q + 1.0, p, u, {"drift": memory["drift"] + 1.0}


def test_a_scheme_that_steps_otherwise_does_so_many_steps_at_once():
    scheme = Drifting(DeadZoneFlocking(), SemiImplicitEuler(0.01))
    q, _, _, memory = scheme.iterate(0.0, Q, P, scheme.start(Q, P), 3)
    assert memory["drift"].tolist() == [[1.0], [2.0], [3.0]]
    still = SemiImplicitEuler(DeadZoneFlocking(), 0.01).iterate(0.0, Q, P, {}, 1)[0]
    np.testing.assert_array_equal(q[0], still[0] + 1.0)


def test_only_a_scheme_that_steps_as_compiled_gives_some_steps_of_many():
    wanted = np.array([2, 5])
    law = SemiImplicitEuler(DeadZoneFlocking(), 0.01)
    *states, memory = law.visit(0.01 * np.arange(5), Q, P, {}, wanted)
    assert memory == {}
    for found, every in zip(states, law.iterate(0.0, Q, P, {}, 5), strict=False):
        np.testing.assert_array_equal(found, every[wanted - 1])
    assert Pulled().block(SemiImplicitEuler(0.01)) is None
    assert DeadZoneFlocking().block(TaylorStep(0.01)) is None
