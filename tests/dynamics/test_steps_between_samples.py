"""The solver's own steps between samples: bounds at all times that output times cannot weaken, in bounded memory."""

import re
import tracemalloc
from dataclasses import replace
from functools import partial
from importlib import import_module

import numpy as np
import pytest

from flockana import Algorithm1, Algorithm2, Algorithm3, Gains, Sphere, StaticTarget, Trajectory, rescale, simulate
from flockana.base.errors import ArgumentError
from flockana.dynamics.run_samples import Samples
from flockana.dynamics.steps_between_samples import Between, Recorder, merged
from flockana.measures.metrics import cohesion_radii, min_distances
from flockana.measures.path_bounds import closest_approach, cohesion_bound
from flockana.solvers.solver_names import METHODS

COMPILED = ("DOP853", "RK45", "RK23", "RK4")

LAW = Algorithm2(gains=Gains(c1_gamma=4.0, c2_gamma=0.2), target=StaticTarget((0.0, 0.0)))
ENDS = (0.0, 6.0)
simulate_module = import_module("flockana.dynamics.simulate")  # where a function has the module's name


def start(n=8, seed=7):
    rng = np.random.default_rng(seed)
    return rng.uniform(-20.0, 20.0, (n, 2)), rng.normal(0.0, 3.0, (n, 2))


@pytest.fixture(scope="module")
def runs():
    """The same run with all its steps, and with its ends alone; and its truth, finely sampled."""
    every, ends = (simulate(LAW, *start(), ENDS, t_eval=t) for t in (None, ENDS))
    fine = simulate(LAW, *start(), ENDS, rtol=1e-11, t_eval=np.linspace(*ENDS, 60_001))
    return every, ends, fine


class TestBounds:
    def test_output_times_change_no_bound(self, runs):
        every, ends, _ = runs
        assert len(ends.t) == 2
        assert every.between is None
        assert ends.min_distance() == pytest.approx(every.min_distance(), rel=1e-9)
        assert ends.cohesion_bound() == pytest.approx(every.cohesion_bound(), rel=1e-9)
        assert ends.closest_approach().lower_by_interval.tolist() == [ends.min_distance()]

    def test_they_bound_the_truth_and_are_tight(self, runs):
        _, ends, fine = runs
        nearest, farthest = float(min_distances(fine.q).min()), float(cohesion_radii(fine.q).max())
        assert nearest - 1e-3 < ends.min_distance() < nearest + 1e-6  # given the integrator's accuracy, 1e-6 here
        assert farthest - 1e-6 < ends.cohesion_bound() < farthest + 1e-3
        assert ends.min_distance() < float(min_distances(ends.q).min()) - 0.1  # the samples alone would not tell

    @pytest.mark.slow
    @pytest.mark.parametrize("method", METHODS)
    def test_every_method_keeps_its_steps(self, method):
        options = {"method": method, "rtol": 1e-6} | ({"dt": 0.02} if method == "RK4" else {})
        run = simulate(LAW, *start(), (0.0, 1.0), t_eval=[0.0, 0.371, 1.0], **options)
        assert run.between is not None
        assert len(run.between.t) >= run.stats["steps"] - 2
        u = np.array([LAW.flow(t, q, p)[0] for t, q, p in zip(run.path.t, run.path.q, run.path.p, strict=True)])
        # a compiled one knows q from a frame of its own: forces to the rounding of the largest
        rounding = 1e-13 * np.abs(u).max() if method in COMPILED else 0.0
        np.testing.assert_allclose(run.path.u, u, rtol=1e-12, atol=rounding)

    def test_clearance_between_samples(self):
        law = Algorithm3(target=StaticTarget((60.0, 0.0)), obstacles=[Sphere((4.0, 9.0), 3.0)])
        every, ends = (simulate(law, [[0.0, 0.0]], [[9.0, 0.0]], (0.0, 8.0), t_eval=t) for t in (None, (0.0, 8.0)))
        assert ends.clearance().lower == pytest.approx(every.clearance().lower, rel=1e-6)
        assert ends.clearance().lower < 0.9 * min(np.linalg.norm(q[0] - [4.0, 9.0]) - 3.0 for q in ends.q)
        assert ends.clearance().time == pytest.approx(every.clearance().time, rel=1e-6)

    def test_a_crossing_between_two_samples_is_found(self):
        ends = simulate(
            Algorithm1(gains=Gains(c2_alpha=0.0)), [[0.0], [200.0]], [[60.0], [-60.0]], (0.0, 5.0), t_eval=(0.0, 5.0)
        )
        assert ends.min_distance() == 0.0


class TestKeeping:
    def test_windows_take_the_steps_within(self, runs):
        run = simulate(LAW, *start(), ENDS, t_eval=np.linspace(*ENDS, 13))
        window = run.window(1.5, 4.0)
        assert (window.t[0], window.t[-1]) == (1.5, 4.0)
        assert window.between.t.min() > 1.5
        assert window.between.t.max() < 4.0
        inside = (run.path.t[:-1] >= 1.5) & (run.path.t[1:] <= 4.0)
        assert window.min_distance() == closest_approach(*run.path).lower_by_interval[inside].min()
        assert run.window(1.5, 1.6).between is None
        assert run.window(1.5, 1.6).cohesion_bound() == cohesion_radii(run.window(1.5, 1.6).q)[0]

    def test_files_keep_them(self, runs, tmp_path):
        _, ends, _ = runs
        again = Trajectory.load(ends.save(tmp_path / "run.nc"))
        for name in ("t", "q", "p", "u"):
            np.testing.assert_array_equal(getattr(again.between, name), getattr(ends.between, name))
        assert again.between.slack is None
        assert again.min_distance() == ends.min_distance()
        every, _, _ = runs
        assert Trajectory.load(every.save(tmp_path / "every.nc")).between is None

    def test_other_units(self, runs):
        _, ends, _ = runs
        scaled = rescale(ends, length=1024.0, time=0.25)
        assert scaled.min_distance() == pytest.approx(1024.0 * ends.min_distance(), rel=1e-12)
        assert scaled.cohesion_bound() == pytest.approx(1024.0 * ends.cohesion_bound(), rel=1e-12)
        assert scaled.between.t[-1] == 0.25 * ends.between.t[-1]

    def test_an_interrupted_run_keeps_those_before_its_last_sample(self):
        class Stops(Algorithm1):
            def flow(self, t, q, p):
                if t > 2.0:
                    raise KeyboardInterrupt
                return super().flow(t, q, p)

        run = simulate(Stops(), *start(4), (0.0, 4.0), t_eval=[0.5, 1.0, 3.0], method="RK4", dt=0.1)
        assert (run.status, run.t.tolist()) == ("interrupted", [0.5, 1.0])
        assert run.between.t[0] > 0.5
        assert run.between.t[-1] < 1.0

    def test_a_run_that_its_watcher_ends_keeps_those_up_to_its_last_sample(self):
        def end(sample):
            if sample.t >= 2.0:
                raise KeyboardInterrupt

        run = simulate(LAW, *start(), (0.0, 4.0), t_eval=[0.0, 1.0, 2.0, 4.0], method="RK4", dt=0.25, watch=end)
        assert (run.status, run.t.tolist()) == ("interrupted", [0.0, 1.0, 2.0])
        assert {1.25, 1.5, 1.75} <= set(run.between.t)


@pytest.fixture(scope="module", params=[1, 3, 8, 20])
def thinned(request, runs):
    """A run whose steps come so many at a time, and after them the samples among them: first, last, and each 13th."""
    every, _, _ = runs
    recorder, keep = Recorder(most=3 * every.q[0].size * len(every.t) // 5), _sampled(every)
    for first in range(0, len(every.t), request.param):
        some = np.arange(first, min(first + request.param, len(every.t)))
        for of, wanted in ((np.setdiff1d(some, keep), False), (np.intersect1d(some, keep), True)):
            if of.size:
                recorder.add(Samples(every.t[of], every.q[of], every.p[of], every.u[of], {}, wanted))
    return merged(every.t[keep], every.q[keep], every.p[keep], every.u[keep], recorder.between())


def _sampled(every):
    return [*range(0, len(every.t) - 1, 13), len(every.t) - 1]


class TestBoundedMemory:
    def test_no_more_is_kept_than_allowed(self, runs, thinned):
        every, _, _ = runs
        assert len(every.t) // 12 < len(thinned.t) - len(_sampled(every)) <= len(every.t) // 5
        assert set(thinned.t) <= set(every.t)

    def test_what_is_left_out_is_let_go(self):
        """Steps come in blocks of one array: a view of one step would hold the whole of them."""
        most, block = 300_000, np.zeros((100, 3, 100, 2))
        recorder = Recorder(most=most)
        tracemalloc.start()
        for k in range(100):
            t = np.arange(100.0) + 100.0 * k
            q, p, u = np.moveaxis(block.copy(), 1, 0)
            recorder.add(Samples(t[:1], q[:1].copy(), p[:1].copy(), u[:1].copy(), {}))
            recorder.add(Samples(t[1:], q[1:], p[1:], u[1:], {}, wanted=False))
        held, _ = tracemalloc.get_traced_memory()
        tracemalloc.stop()
        assert 3 * recorder.between().q.size <= most
        assert held < 2 * 8 * most

    def test_single_steps_of_few_agents_take_their_numbers_and_no_objects(self):
        recorder, steps = Recorder(), 4000
        recorder.add(Samples(np.array([-1.0]), *np.zeros((3, 1, 2, 1)), {}))
        tracemalloc.start()
        for k in range(steps):
            arrays = (np.full(shape, float(k)) for shape in ((1,), *3 * ((1, 2, 1),)))
            recorder.add(Samples(*arrays, {}, wanted=False))
        held, _ = tracemalloc.get_traced_memory()
        tracemalloc.stop()
        recorder.add(Samples(np.array([float(steps)]), *np.zeros((3, 1, 2, 1)), {}))
        assert held < 4 * 8 * (7 * steps)
        np.testing.assert_array_equal(recorder.between().t, np.arange(steps))
        np.testing.assert_array_equal(recorder.between().u[:, 1, 0], np.arange(steps))

    @pytest.mark.parametrize("at_once", [1, 100])
    def test_steps_before_the_first_sample_are_not_held(self, at_once):
        recorder, block = Recorder(), np.zeros((at_once, 3, 100, 2))
        tracemalloc.start()
        for k in range(20):
            q, p, u = np.moveaxis(block.copy(), 1, 0)
            recorder.add(Samples(np.arange(float(at_once)) + at_once * k, q, p, u, {}, wanted=False))
        held, _ = tracemalloc.get_traced_memory()
        tracemalloc.stop()
        assert held < max(2 * block.nbytes, 16_000)  # some objects beside; all 20 steps are 96,000 at least
        assert recorder.between() is None

    def test_blocks_are_what_their_steps_are(self, runs):
        """Until the memory is full, to the bit, whichever way steps and samples come."""
        every, _, _ = runs
        ends = [0, len(every.t) // 2, len(every.t) - 2]  # the last step leads to no sample
        one_by_one, together = Recorder(), Recorder()
        all_steps = Samples(every.t, every.q, every.p, every.u, {})
        for k in range(len(every.t)):
            one_by_one.add(all_steps.at([k])._replace(wanted=k in ends))
        wanted = np.isin(np.arange(len(every.t)), ends)
        together.add(all_steps.at([0]))
        for some, flag in ((~wanted, False), (wanted & (every.t > 0.0), True)):
            together.add(all_steps.at(some)._replace(wanted=flag))
        for name in ("t", "q", "p", "u"):
            here, there = (getattr(recorder.between(), name) for recorder in (one_by_one, together))
            np.testing.assert_array_equal(here, there)
        assert len(one_by_one.between().t) == len(every.t) - 4

    def test_the_slack_is_how_far_the_paths_differ(self, runs, thinned):
        """Steps that were left out lie within it of the path through those that were kept."""
        every, _, _ = runs
        assert thinned.slack.shape == (len(thinned.t) - 1, every.n)
        for k in range(len(thinned.t) - 1):
            left = np.flatnonzero((every.t > thinned.t[k]) & (every.t < thinned.t[k + 1]))
            for step in left:
                here = _on_quintic(thinned, k, float(every.t[step]))
                assert (np.linalg.norm(here - every.q[step], axis=1) <= thinned.slack[k] + 1e-12).all()

    def test_bounds_are_weaker_and_true(self, runs, thinned):
        every, _, fine = runs
        assert closest_approach(*thinned).lower <= every.min_distance()
        assert closest_approach(*thinned).lower <= float(min_distances(fine.q).min())
        assert cohesion_bound(*thinned).max() >= every.cohesion_bound()

    def test_of_a_run_that_is_watched_the_same_is_kept(self, monkeypatch):
        q, p = start(6)
        monkeypatch.setattr(simulate_module, "Recorder", partial(Recorder, most=30 * 3 * q.size))
        how = {"method": "RK4", "dt": 0.001, "t_eval": np.linspace(0.0, 3.0, 100)}  # several blocks of steps
        watched, alone = (simulate(LAW, q, p, (0.0, 3.0), watch=watch, **how).between for watch in ([].append, None))
        for name in ("t", "q", "p", "u", "slack"):
            np.testing.assert_array_equal(getattr(watched, name), getattr(alone, name))

    def test_windows_and_files_keep_the_slack(self, runs, thinned, tmp_path):
        every, _, _ = runs
        keep = np.isin(thinned.t, every.t[_sampled(every)])
        between = Between(*(x[~keep] for x in thinned[:4]), thinned.slack)
        run = Trajectory(*(x[keep] for x in thinned[:4]), LAW, between=between)
        again = Trajectory.load(run.save(tmp_path / "thin.nc"))
        np.testing.assert_array_equal(again.path.slack, thinned.slack)
        half = again.window(0.0, float(again.t[len(again.t) // 2]))
        assert len(half.between.slack) == len(half.path.t) - 1
        assert half.min_distance() >= again.min_distance() == run.min_distance()


def _on_quintic(path, k, t):
    """The quintic between two knots at a time, from its monomials."""
    h, s = path.t[k + 1] - path.t[k], (t - path.t[k]) / (path.t[k + 1] - path.t[k])
    q0, v0, a0 = path.q[k], h * path.p[k], h * h * path.u[k]
    q1, v1, a1 = path.q[k + 1], h * path.p[k + 1], h * h * path.u[k + 1]
    rest, slope, bend = q1 - q0 - v0 - a0 / 2, v1 - v0 - a0, a1 - a0
    c3, c4, c5 = 10 * rest - 4 * slope + bend / 2, -15 * rest + 7 * slope - bend, 6 * rest - 3 * slope + bend / 2
    return q0 + v0 * s + a0 / 2 * s**2 + c3 * s**3 + c4 * s**4 + c5 * s**5


class TestRefusals:
    @pytest.mark.parametrize(
        ("change", "message"),
        [
            ({"t": [0.5, 0.4]}, "expected rising times"),
            ({"q": np.zeros((1, 3, 2))}, "expected 2 steps of one flock"),
            ({"u": np.full((2, 3, 2), np.nan)}, "between.u: expected finite numbers"),
            ({"slack": np.zeros((3, 2))}, "expected steps of the flock of q"),
        ],
    )
    def test_arrays_that_do_not_fit(self, change, message):
        good = {"t": np.array([0.4, 0.6])} | dict.fromkeys("qpu", np.zeros((2, 3, 2)))
        samples = np.zeros((2, 3, 2))
        with pytest.raises(ArgumentError, match=re.escape(message)):
            Trajectory(np.array([0.0, 1.0]), samples, samples, samples, LAW, between=Between(**(good | change)))

    @pytest.mark.parametrize("times", [[0.0, 0.5], [0.5, 1.0], [0.5, 2.0]])
    def test_times_that_are_not_between_samples(self, times):
        steps = np.zeros((2, 3, 2))
        with pytest.raises(ArgumentError, match="expected times strictly between those of the samples"):
            Trajectory(
                np.array([0.0, 1.0]), steps, steps, steps, LAW, between=Between(np.array(times), steps, steps, steps)
            )

    def test_replaced_samples_need_other_steps(self, runs):
        _, ends, _ = runs
        with pytest.raises(ArgumentError, match="between"):
            replace(ends, t=ends.t[:1], q=ends.q[:1], p=ends.p[:1], u=ends.u[:1], extra={})
