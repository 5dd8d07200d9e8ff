"""Maps of solvers: to the bit the same in any pieces, whatever is kept, and alone; what they refuse."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import flockana as fl
from flockana.solvers.solver_names import solver_of, solvers
from tests.refused import refused

MOVING = fl.CircleTarget((0.0, 0.0), 20.0, frequency=0.05)
LAW = fl.Algorithm2(target=MOVING)
Q = np.random.default_rng(3).uniform(0.0, 30.0, (23, 2))  # more than one cell, some pairs coming and going
P = np.random.default_rng(4).normal(0.0, 3.0, (23, 2))
KINDS = (fl.ExplicitEuler, fl.SemiImplicitEuler, fl.TaylorStep, fl.Heun, fl.RK4)


class Plain(fl.Algorithm2):
    """Algorithm 2, which the library must step in Python."""

    def flow(self, t, q, p):
        """As it was."""
        return super().flow(t, q, p)


@pytest.mark.slow
@pytest.mark.parametrize("law", [LAW, Plain(target=MOVING)], ids=["compiled", "in Python"])
@pytest.mark.parametrize("kind", KINDS)
@settings(max_examples=5, deadline=None)
@given(st.integers(1, 30), st.lists(st.integers(0, 31), min_size=1, max_size=5, unique=True))
def test_steps_blocks_and_times_to_keep_agree_to_the_bit(law, kind, piece, kept):
    """From a start that is no multiple of the step, so that times are rounded."""
    steps, t0 = fl.FixedSteps(law, kind(0.03)), 0.7
    run = fl.simulate(steps, Q, P, (t0, t0 + 31 * 0.03))
    q, p = Q, P
    for k in range(31):
        q, p, u, _ = steps.step(t0 + k * 0.03, q, p, {})
        np.testing.assert_array_equal((q, p, u), (run.q[k + 1], run.p[k + 1], run.u[k + 1]))
    times = t0 + np.arange(31) * 0.03
    first = steps.visit(times[:piece], Q, P, {}, np.array([piece]))
    rest = steps.visit(times[piece:], first[0][-1], first[1][-1], {}, np.arange(1, 32 - piece))
    np.testing.assert_array_equal(rest[0], run.q[piece + 1 :])
    kept = sorted(kept)
    some = fl.simulate(steps, Q, P, (t0, t0 + 31 * 0.03), t_eval=run.t[kept])
    np.testing.assert_array_equal(some.q, run.q[kept])


@pytest.mark.parametrize("kind", KINDS)
def test_compiled_steps_are_those_in_python(kind):
    runs = [fl.simulate(fl.FixedSteps(law, kind(0.01)), Q, P, (0.0, 0.3)) for law in (LAW, Plain(target=MOVING))]
    for name, size in (("q", 30.0), ("p", 100.0), ("u", 3000.0)):
        np.testing.assert_allclose(getattr(runs[0], name), getattr(runs[1], name), rtol=0.0, atol=1e-13 * size)


def test_every_solver_has_a_name_and_an_object():
    run = fl.simulate(LAW, Q[:5], P[:5], (0.0, 0.1), method="Heun", dt=0.001)
    same = fl.simulate(LAW, Q[:5], P[:5], (0.0, 0.1), method=fl.Heun(0.001))
    np.testing.assert_array_equal(run.q, same.q)
    assert run.stats["method"] == same.stats["method"] == "Heun"
    assert solver_of(fl.RK45(), None) == solver_of("RK45", None)
    assert {"DOP853", "RK4", "Radau", "scipy-RK23", "Euler-Maruyama", "SemiImplicitEuler"} <= set(solvers())


def test_wrapped_laws_take_every_solver_of_fixed_steps():
    late = fl.Delayed(fl.Algorithm1(), 0.02, late="pairs")
    ends = [fl.simulate(late, Q[:7], 0.1 * P[:7], (0.0, 0.2), method=kind(0.001)).q[-1] for kind in KINDS]
    assert max(np.abs(end - ends[-1]).max() for end in ends) < 0.02
    assert np.abs(ends[3] - ends[4]).max() < 1e-4  # Heun and RK4


test_bad_input = refused(
    (lambda: fl.FixedSteps(LAW, fl.RK45()), "expected a solver with a fixed step, such as RK4"),
    (lambda: fl.RK4(0.0), "dt = 0: expected a number > 0"),
    (lambda: fl.FixedSteps(fl.Disturbed(LAW, intensity=0.1), fl.RK4(0.1)), "expected a solver that takes noise"),
    (lambda: fl.simulate(LAW, Q, P, (0.0, 1.0), method=fl.RK4(0.1), dt=0.1), "brings its step; expected no other"),
    (lambda: fl.simulate(LAW, Q, P, (0.0, 1.0), method="RK4"), "method RK4 needs a fixed step, such as dt=0.005"),
    (lambda: fl.simulate(LAW, Q, P, (0.0, 1.0), method=4), "expected a solver such as RK4"),
    (lambda: fl.simulate(fl.Delayed(LAW, 0.1), Q, P, (0.0, 1.0), method=fl.RK45()), "Delayed is run in fixed steps"),
)
