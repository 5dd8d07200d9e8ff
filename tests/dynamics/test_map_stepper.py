"""Maps: their steps, which of them are kept, and runs that end early."""

import re
from dataclasses import dataclass

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from flockana import Algorithm1, DiscreteLaw, SemiImplicitEuler, simulate
from flockana.base.errors import ArgumentError
from flockana.dynamics.map_stepper import _nearest, count_steps


@dataclass(frozen=True)
class Counter(DiscreteLaw):
    """q grows by one a step; remembers how often it stepped, changing its own array in place."""

    dt: float = 0.25
    fails_at: float = np.inf
    error: type[BaseException] | None = None
    spares: bool = False

    def start(self, q, p):
        return {"count": np.zeros(1)}

    def step(self, t, q, p, memory):
        if t >= self.fails_at:
            if self.error is not None:
                raise self.error
            return q if self.spares else q * np.nan, p * np.nan, 0 * q, memory
        memory["count"] += 1.0
        return q + 1.0, p, np.full_like(q, t), memory


def test_what_is_no_map_is_named_before_the_run():
    class Flat(Counter):
        def step(self, t, q, p, memory):
            return q.ravel(), p, q, memory

    class Short(Counter):
        def step(self, t, q, p, memory):
            return q, p

    with pytest.raises(ArgumentError, match=re.escape("Flat gives q as float64 of shape (1,) at the start, t = 0")):
        simulate(Flat(), [[0.0]], [[0.0]], (0.0, 1.0))
    with pytest.raises(ArgumentError, match=r"expected \(q, p, u, memory\)"):
        simulate(Short(), [[0.0]], [[0.0]], (0.0, 1.0))


def test_discrete_steps_and_memory():
    run = simulate(Counter(), [[0.0]], [[5.0]], (1.0, 2.0))
    assert run.t.tolist() == [1.0, 1.25, 1.5, 1.75, 2.0]
    assert run.q.ravel().tolist() == [0.0, 1.0, 2.0, 3.0, 4.0]
    assert run.u.ravel().tolist() == [0.0, 1.0, 1.25, 1.5, 1.75]
    assert run.extra["count"].ravel().tolist() == [0.0, 1.0, 2.0, 3.0, 4.0]
    assert (run.stats["method"], run.stats["dt"], run.stats["steps"]) == ("discrete", 0.25, 4)
    assert "work" not in run.extra


def test_discrete_keeps_the_nearest_steps():
    run = simulate(Counter(), [[0.0]], [[0.0]], (0.0, 2.0), t_eval=[0.0, 0.3, 0.32, 1.0, 1.9])
    assert run.t.tolist() == [0.0, 0.25, 1.0, 2.0]
    short = simulate(Counter(dt=0.6), [[0.0]], [[0.0]], (0.0, 1.0), t_eval=[1.0])
    assert short.t.tolist() == [0.0]  # the map never comes near t = 1


def test_discrete_runs_that_end_early():
    for spares in (False, True):  # positions
        failed = simulate(Counter(fails_at=0.5, spares=spares), [[0.0]], [[0.0]], (0.0, 2.0))
        assert (failed.status, failed.t.tolist()) == ("failed", [0.0, 0.25, 0.5])
        assert failed.message == "the map left the finite numbers at t = 0.75"
    stopped = simulate(Counter(fails_at=0.5, error=KeyboardInterrupt), [[0.0]], [[0.0]], (0.0, 2.0))
    assert (stopped.status, stopped.t.tolist()) == ("interrupted", [0.0, 0.25, 0.5])


class ByThrees(Counter):
    """The same, three steps at once."""

    steps_at_once = 3


class Visiting(ByThrees):
    """The same, which gives the steps that are wanted and no others."""

    def visit(self, times, q, p, memory, wanted):
        *states, series = self.iterate(times[0], q, p, {"count": memory["count"].copy()}, int(wanted[-1]))
        return *(values[wanted - 1] for values in states), {"count": series["count"][wanted - 1]}


@pytest.mark.parametrize("other", [ByThrees, Visiting])
@pytest.mark.parametrize("t_eval", [None, [0.0, 0.5, 0.75, 2.5], [1.0], [0.25, 0.5, 0.75, 1.9], [2.2]])
@pytest.mark.parametrize("fails_at", [np.inf, 1.0, 0.75])
def test_how_many_steps_a_map_makes_and_gives_at_once_changes_nothing(fails_at, t_eval, other):
    runs = [simulate(law(fails_at=fails_at), [[0.0]], [[5.0]], (0.0, 2.6), t_eval=t_eval) for law in (Counter, other)]
    one, many = ((run.status, run.message, run.stats["steps"], run.stats["evaluations"]) for run in runs)
    assert one == many
    for name in ("t", "q", "p", "u"):
        np.testing.assert_array_equal(*(getattr(run, name) for run in runs))
    np.testing.assert_array_equal(*(run.extra["count"] for run in runs))


@given(
    st.floats(-1e6, 1e6),
    st.floats(1e-3, 10.0),
    st.integers(1, 40),
    st.lists(st.floats(0.0, 1.0), min_size=1, max_size=6, unique=True),
)
def test_of_each_time_the_nearest_step_is_kept(t0, dt, steps, shares):
    times = t0 + np.arange(steps + 1) * dt
    keep = np.array(sorted({t0 + share * (times[-1] - t0 + dt) for share in shares} | {times[steps // 2] + 0.5 * dt}))
    found = _nearest(t0, dt, steps, keep)
    first = [next((k for k, t in enumerate(times) if t + 0.5 * dt >= wanted), steps + 1) for wanted in keep]
    assert found.tolist() == sorted({k for k in first if k <= steps})


def test_who_watches_a_map_sees_each_step_and_may_end_it_between_steps_made_at_once():
    seen = []
    whole = simulate(ByThrees(), [[0.0]], [[5.0]], (0.0, 2.0), watch=seen.append)
    assert [sample.t for sample in seen] == whole.t.tolist()
    assert [sample.q.tolist() for sample in seen] == whole.q.tolist()
    assert [sample.extra["count"].tolist() for sample in seen] == whole.extra["count"].tolist()

    def end(sample):
        if sample.t >= 1.25:
            raise KeyboardInterrupt

    ended = simulate(ByThrees(), [[0.0]], [[5.0]], (0.0, 2.0), watch=end)
    assert (ended.status, ended.t.tolist()) == ("interrupted", [0.0, 0.25, 0.5, 0.75, 1.0, 1.25])
    assert ended.message == "interrupted: the last sample is at t = 1.25"
    stopped = simulate(ByThrees(fails_at=1.0, error=KeyboardInterrupt), [[0.0]], [[5.0]], (0.0, 2.0))
    assert stopped.t.tolist() == [0.0, 0.25, 0.5, 0.75]  # the steps that were being made are lost
    assert stopped.message == "interrupted: the last sample is at t = 0.75"


def test_a_map_ends_no_later_than_its_span():
    """Its times can be asked for again."""
    law, end = SemiImplicitEuler(Algorithm1(), dt=1e-8), 1e-5 * (1.0 - 1e-16)
    run = simulate(law, [[0.0, 0.0], [5.0, 0.0]], np.zeros((2, 2)), (0.0, end))
    assert 1000 * law.dt > end == run.t[-1]
    again = simulate(law, run.q[0], run.p[0], (0.0, end), t_eval=run.t)
    np.testing.assert_array_equal(again.q, run.q)


@pytest.mark.parametrize(
    ("law", "options", "message"),
    [
        (Counter(), {"dt": 0.1}, "a discrete law brings its own step: expected neither dt, max_step nor method"),
        (Counter(), {"method": "RK45"}, "a discrete law brings its own step"),
        (Counter(dt=0.0), {}, "law.dt = 0: expected a number > 0"),
    ],
)
def test_what_a_map_has_no_use_for_is_refused(law, options, message):
    with pytest.raises(ArgumentError, match=message):
        simulate(law, [[0.0]], [[0.0]], (0.0, 1.0), **options)


def test_steps_are_counted_whatever_the_rounding_of_the_times():
    assert [count_steps(a, b, 0.1) for a, b in ((0.0, 0.3), (1e6, 1e6 + 0.3), (0.0, 0.31))] == [3, 3, 4]
