"""Steps of wrapped laws: all wrappers at once, in any pieces, saved and replayed."""

from functools import partial

import numpy as np
import pytest

from flockana import Delayed, Disturbed, Lossy, Measured, Sampled, Saturated, Trajectory, simulate
from flockana.ensemble import ensemble
from flockana.environment.targets import LinearTarget, StaticTarget
from flockana.explore.law_parameters import changed, numbers, tree_of
from flockana.lattice import hexagonal_patch
from flockana.laws.olfati_saber import Algorithm2
from flockana.solvers.euler_maruyama import EulerMaruyama
from flockana.solvers.fixed_steps import FixedSteps
from flockana.solvers.wrapped_steps import Stepped
from tests.refused import refused

LAW = Algorithm2(target=StaticTarget((0.0, 0.0)))
Q = hexagonal_patch(1, 7.0)
SENSED = Sampled(Delayed(Measured(Lossy(LAW, 0.1), 0.001, 0.01, "neighbours", seed=2), 0.02, "neighbours"), 0.02)
ALL = Disturbed(Saturated(SENSED, 5.0), intensity=0.1, swing=(1.0, 0.0), frequency=0.5, seed=7)


def test_all_at_once_is_saved_and_replayed(tmp_path):
    run = simulate(ALL, Q, 0.0 * Q, (0.0, 1.0), dt=0.01)
    again = Trajectory.load(run.save(tmp_path / "run.nc"))
    assert again.law == run.law == Stepped(ALL, 0.01, 2)
    np.testing.assert_array_equal(simulate(again.law, Q, 0.0 * Q, (0.0, 1.0)).q, run.q)
    assert run.extra == {}  # the past is not recorded
    assert run.status == "complete"


def test_steps_are_the_same_in_any_pieces():
    law, memory = Stepped(ALL, 0.01, 2), None
    q, p, memory = Q, 0.0 * Q, law.start(Q, 0.0 * Q)
    whole = law.iterate(0.0, q, p, memory, 30)
    done = 0
    for piece in (1, 5, 24):
        states = law.iterate(0.01 * done, q, p, memory, piece)
        q, p, memory = states[0][-1], states[1][-1], {name: values[-1] for name, values in states[3].items()}
        done += piece
    np.testing.assert_array_equal(q, whole[0][-1])


class Interpreted(FixedSteps):
    """Steps one by one, as those of a law that is not compiled."""

    def _compiled(self, *_):
        return None


@pytest.mark.parametrize("target", [StaticTarget((0.0, 0.0)), LinearTarget((3.0, 0.0), (1.0, 2.0))])
def test_compiled_steps_of_noise_are_those_made_one_by_one(target):
    """Across blocks of random numbers, at some steps only, with two noises and a swing; and from the middle on."""
    noisy = Disturbed(Algorithm2(target=target), intensity=0.1, seed=3)
    law = Disturbed(noisy, force=(0.1, 0.2), swing=(0.3, 0.1), frequency=0.2, intensity=0.2)
    p, wanted = 0.1 * Q[::-1], np.array([1, 255, 256, 257, 600])
    found, one_by_one = (
        each.visit(2.0 + 0.01 * np.arange(600), Q, p, each.start(Q, p), wanted)
        for each in (FixedSteps(law, EulerMaruyama(0.01)), Interpreted(law, EulerMaruyama(0.01)))
    )
    for fast, slow, size in zip(found[:3], one_by_one[:3], (1.0, 1.0, 100.0), strict=True):
        np.testing.assert_allclose(fast, slow, rtol=0.0, atol=1e-11 * size)
    begins = 2.0 + 0.01 * np.arange(600)
    start = FixedSteps(law, EulerMaruyama(0.01)).start(Q, p)
    assert FixedSteps(law, EulerMaruyama(0.01))._compiled(begins, Q, p, start, wanted) is not None
    memory = {name: values[-1] for name, values in found[3].items()}
    later = [each(law, EulerMaruyama(0.01)).iterate(8.0, Q, p, memory, 30)[1] for each in (FixedSteps, Interpreted)]
    np.testing.assert_allclose(later[0], later[1], rtol=0.0, atol=1e-11)


@pytest.mark.slow
def test_a_step_of_order_1_holds_the_input():
    """q + h p + ½ h² u and p + h u, with u at the beginning of the step."""
    law, h, p = Disturbed(LAW, force=(0.3, -0.2)), 0.1, 0.1 * Q[::-1]
    u = law.acceleration(0.0, Q, p)
    q_1, p_1, held, _ = Stepped(law, h, 1).step(0.0, Q, p, Stepped(law, h, 1).start(Q, p))
    np.testing.assert_allclose(q_1, Q + h * p + 0.5 * h**2 * u, rtol=0.0, atol=1e-13)
    np.testing.assert_allclose(p_1, p + h * u, rtol=0.0, atol=1e-13)
    np.testing.assert_allclose(held, u, rtol=0.0, atol=1e-12)


@pytest.mark.slow
def test_runs_are_the_same_at_any_number_of_workers():
    """All wrappers, and compiled noise: in this process, and in two others."""
    for law in (Stepped(ALL, 0.01), Stepped(Disturbed(LAW, intensity=0.1), 0.01, 1)):
        starts = partial(hexagonal_patch, 1)  # by the seed, which is the distance
        flock = {"law": law, "q0": starts, "p0": 0.0 * Q, "t_span": (0.0, 0.3), "theorems": []}
        alone, both = (ensemble(seeds=(7, 8), metrics=["cohesion_radius"], jobs=n, **flock) for n in (1, 2))
        assert alone.drop_vars("seconds").identical(both.drop_vars("seconds"))
        assert alone["cohesion_radius"].values[0] != alone["cohesion_radius"].values[1]


def test_knobs_of_an_explorer_are_those_of_every_wrapper():
    found = {number.path for number in numbers(Stepped(ALL, 0.01))}
    assert {"solver.dt", "law.intensity", "law.law.limit", "law.law.law.period", "law.law.law.law.delay"} <= found
    changes = tree_of(Stepped(ALL, 0.01), {"law.intensity": 0.3, "law.law.law.law.delay": 0.01})
    law = changed(Stepped(ALL, 0.01), changes).law
    assert (law.intensity, law.law.law.law.delay, law.law.law.period) == (0.3, 0.01, 0.02)


def test_what_wraps_shows_through():
    assert ALL.core is LAW
    assert [type(one).__name__ for one in ALL.wrappers][:3] == ["Disturbed", "Saturated", "Sampled"]
    law = Stepped(ALL, 0.01)
    assert (law.target, law.pair, law.scales) == (LAW.target, LAW.pair, LAW.scales)


test_bad_input = refused(
    (lambda: Stepped(LAW, 0.01), "expected a law that wraps one"),
    (lambda: Stepped(ALL, 0.01, 3), "order = 3: expected one of 1, 2, 4"),
    (lambda: Stepped(ALL, 0.03), "dt = 0.03: expected a step that divides the delay or period 0.02, such as 0.02"),
)
