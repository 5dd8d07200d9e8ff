"""Integration: orders, exact solutions, every method, and runs that end early with nothing lost."""

import re
from dataclasses import dataclass

import numpy as np
import pytest

import flockana as fl
from flockana import Algorithm1, Algorithm2, Gains, Law, LinearTarget, LinkKeeping, StaticTarget, simulate
from flockana.base.errors import ArgumentError, UnknownNameError
from flockana.solvers.solver_names import ADAPTIVE, METHODS
from tests.programs import out_of_a_kernel

LAW = Algorithm2(gains=Gains(c1_alpha=3.0, c2_alpha=1.0), target=LinearTarget((5.0, 0.0), (1.0, 0.5)))


def start(n=6, m=2, seed=0, spread=12.0):
    rng = np.random.default_rng(seed)
    return rng.uniform(0.0, spread, (n, m)), rng.normal(0.0, 1.0, (n, m))


@dataclass(frozen=True)
class Oscillator(Law):
    """q'' = −q, smooth for ever, with its energy; from `breaks` on it returns `bad`."""

    breaks: float = np.inf
    bad: float = np.nan
    error: type[BaseException] | None = None

    def flow(self, t, q, p):
        if t >= self.breaks:
            if self.error is not None:
                raise self.error
            return np.full_like(q, self.bad), 0.0
        return -q, 0.0

    def hamiltonian(self, t, q, p):
        return 0.5 * float(np.sum(q * q) + np.sum(p * p))


def kwargs(method):
    return {"method": method, "dt": 0.01} if method == "RK4" else {"method": method}


def test_rk4_is_of_fourth_order_on_a_linear_problem():
    """Halving the step divides the error by 16."""
    errors = []
    for dt in (0.1, 0.05, 0.025):
        run = simulate(Oscillator(), [[1.0]], [[0.0]], (0.0, 3.0), method="RK4", dt=dt, t_eval=[3.0])
        errors.append(np.hypot(run.q[-1, 0, 0] - np.cos(3.0), run.p[-1, 0, 0] + np.sin(3.0)))
    assert errors[0] / errors[1] == pytest.approx(16.0, rel=0.1)
    assert errors[1] / errors[2] == pytest.approx(16.0, rel=0.1)


def test_rk4_is_of_fourth_order_on_a_smooth_flock():
    """Against DOP853 at rtol 1e-12; all agents stay within h r_α of each other, where φ_α is smooth."""
    from flockana.interactions import AlphaInteraction

    law = Algorithm2(AlphaInteraction(d=5.0, r=60.0, h=0.9), LAW.gains, LAW.target)
    q0, p0 = start(5, spread=6.0)
    exact = simulate(law, q0, p0, (0.0, 1.0), rtol=1e-12, atol=1e-13, t_eval=[1.0])
    runs = [simulate(law, q0, p0, (0.0, 1.0), method="RK4", dt=dt, t_eval=[1.0]) for dt in (0.01, 0.005, 0.0025)]
    errors = [np.abs(run.q[-1] - exact.q[-1]).max() for run in runs]
    works = [abs(run.extra["work"][-1] - exact.extra["work"][-1]) for run in runs]
    for e in (errors, works):
        assert 13.0 < e[0] / e[1] < 19.0
        assert 13.0 < e[1] / e[2] < 19.0


def test_rk4_lands_on_times_off_its_grid():
    times = np.array([0.0, 0.013, 0.5, 0.5037, 1.999, 2.0])
    run = simulate(Oscillator(), [[1.0]], [[0.0]], (0.0, 2.0), method="RK4", dt=0.01, t_eval=times)
    np.testing.assert_array_equal(run.t, times)
    np.testing.assert_allclose(run.q[:, 0, 0], np.cos(times), atol=2e-10)
    np.testing.assert_allclose(run.p[:, 0, 0], -np.sin(times), atol=2e-10)
    np.testing.assert_allclose(run.u[:, 0, 0], -np.cos(times), atol=2e-10)


@pytest.mark.parametrize(("dt", "steps"), [(0.3, 4), (0.25, 4), (5.0, 1), (0.1, 10)])
def test_rk4_steps(dt, steps):
    run = simulate(Oscillator(), [[1.0]], [[0.0]], (-1.0, 0.0), method="RK4", dt=dt)
    assert run.stats["steps"] == steps
    assert run.stats["evaluations"] == 4 * steps + 1
    assert (run.t[0], run.t[-1], len(run.t)) == (-1.0, 0.0, steps + 1)
    assert run.stats["dt"] == dt


@pytest.mark.slow
@pytest.mark.parametrize("method", METHODS)
def test_every_method_agrees(method):
    """Tolerances 1e-8: global errors of 1e-5 for the low orders (RK23, and the stiff ones)."""
    q0, p0 = start(4)
    exact = simulate(LAW, q0, p0, (0.0, 1.0), rtol=1e-12, atol=1e-13, t_eval=[0.4, 1.0])
    run = simulate(LAW, q0, p0, (0.0, 1.0), t_eval=[0.4, 1.0], **kwargs(method))
    assert (run.status, run.message) == ("complete", "reached the end of the time span")
    assert run.stats["method"] == method
    assert run.stats["evaluations"] > 0
    np.testing.assert_allclose(run.q, exact.q, atol=1e-5)
    np.testing.assert_allclose(run.p, exact.p, atol=1e-5)
    np.testing.assert_allclose(run.extra["work"], exact.extra["work"], atol=1e-4)


@pytest.mark.parametrize("method", ["DOP853", "RK4"])
@pytest.mark.parametrize("target", [StaticTarget((3.0, 1.0)), LinearTarget((3.0, 1.0), (1.0, -2.0))])
def test_one_agent_follows_the_closed_form(method, target):
    """e = q − q_r obeys e'' + c2 e' + c1 e = 0: underdamped, to 1e-7."""
    c1, c2 = 2.0, 1.0
    law = Algorithm2(gains=Gains(c1_gamma=c1, c2_gamma=c2), target=target)
    q0, p0 = np.array([[0.0, 5.0]]), np.array([[1.0, 0.0]])
    t = np.linspace(0.0, 6.0, 25)
    run = simulate(law, q0, p0, (0.0, 6.0), t_eval=t, **kwargs(method))
    e0, v0 = q0[0] - target.position(0.0), p0[0] - target.rate(0.0)
    w = np.sqrt(c1 - c2 * c2 / 4)
    e = np.exp(-c2 * t / 2)[:, None] * (np.cos(w * t)[:, None] * e0 + np.sin(w * t)[:, None] * (v0 + c2 / 2 * e0) / w)
    path = np.array([target.position(x) for x in t])
    np.testing.assert_allclose(run.q[:, 0], path + e, atol=1e-7)


def test_algorithm_1_conserves_momentum_and_balances_energy():
    law = Algorithm1(gains=Gains(c1_alpha=30.0, c2_alpha=5.0))
    q0, p0 = start(30, spread=25.0)
    run = simulate(law, q0, p0, (0.0, 3.0))
    momentum = run.p.sum(axis=1)
    np.testing.assert_allclose(momentum, np.broadcast_to(momentum[0], momentum.shape), atol=1e-10)
    energy = run.energy()
    assert energy[-1] < energy[0] - 10.0
    assert np.all(np.diff(run.extra["work"]) <= 0.0)
    assert np.abs(run.energy_residual).max() <= 1e-6 * energy[0]


def test_the_clock_may_start_anywhere():
    near = simulate(Algorithm1(), *start(4), (0.0, 1.0), t_eval=[1.0])
    far = simulate(Algorithm1(), *start(4), (1e6, 1e6 + 1.0), t_eval=[1e6 + 1.0])
    np.testing.assert_allclose(far.q, near.q, atol=1e-6)


@pytest.mark.parametrize("method", ["DOP853", "RK4"])
def test_t_eval_takes_both_ends_or_neither(method):
    for times in ([0.0], [1.0], [0.0, 1.0], [0.37], np.linspace(0, 1, 50)):
        run = simulate(Oscillator(), [[1.0]], [[0.0]], (0.0, 1.0), t_eval=times, **kwargs(method))
        np.testing.assert_array_equal(run.t, times)
        np.testing.assert_allclose(run.q[:, 0, 0], np.cos(times), atol=1e-7)
    assert simulate(Oscillator(), [[1.0]], [[0.0]], (0.0, 1.0), t_eval=0.5).t.tolist() == [0.5]


@pytest.mark.parametrize("method", [*ADAPTIVE, "RK4"])
@pytest.mark.parametrize("bad", [np.nan, np.inf])
@pytest.mark.filterwarnings("ignore")
def test_a_law_that_breaks_loses_nothing(method, bad):
    whole = simulate(Oscillator(), [[1.0]], [[0.0]], (0.0, 1.0), **kwargs(method))
    run = simulate(Oscillator(breaks=0.5, bad=bad), [[1.0]], [[0.0]], (0.0, 1.0), **kwargs(method))
    assert run.status == "failed"
    assert re.search(r"gave up at t = |left the finite numbers at t = 0\.5", run.message)
    assert len(run.t) > 1
    assert run.t[-1] <= 0.5
    assert np.isfinite(run.q).all()
    shared = min(len(run.t), np.searchsorted(whole.t, 0.2))
    np.testing.assert_array_equal(run.q[:shared], whole.q[:shared])


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.filterwarnings("ignore")
def test_a_law_that_breaks_before_the_first_time_to_keep(method):
    run = simulate(Oscillator(breaks=0.5), [[1.0]], [[2.0]], (0.0, 1.0), t_eval=[0.9], **kwargs(method))
    assert (run.status, run.t.tolist(), run.q.tolist(), run.p.tolist()) == ("failed", [0.0], [[[1.0]]], [[[2.0]]])


@dataclass(frozen=True)
class Returns(Law):
    """Returns what it is told to, and says that it has an energy."""

    found: object
    energy: object = 1.0

    def flow(self, t, q, p):
        return self.found

    def hamiltonian(self, t, q, p):
        return self.energy


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("bad", [np.nan, np.inf])
def test_a_law_broken_from_the_start_is_named(method, bad):
    message = f"Oscillator gives u[1] = [{bad}] at the start, t = 3: expected finite accelerations there"
    law = Oscillator(breaks=0.0, bad=np.array([[0.0], [bad]]))
    with pytest.raises(ArgumentError, match=re.escape(message)):
        simulate(law, [[1.0], [2.0]], [[0.0], [0.0]], (3.0, 4.0), **kwargs(method))


@pytest.mark.parametrize(
    ("found", "energy", "message"),
    [
        (None, 1.0, "Returns gives None at t = 0: expected (u, dH/dt)"),
        (np.zeros((1, 2)), 1.0, "Returns gives array([[0., 0.]]) at t = 0: expected (u, dH/dt)"),
        ((None, 0.0), 1.0, "gives u as NoneType at t = 0: expected an array of real numbers of shape (1, 2)"),
        (([[0.0, 0.0]], 0.0), 1.0, "gives u as list at t = 0: expected an array of real numbers"),
        ([np.zeros((1, 2)), 0.0], 1.0, "gives [array([[0., 0.]]), 0.0] at t = 0: expected (u, dH/dt)"),
        (
            (np.zeros((2, 1)), 0.0),
            1.0,
            "gives u as float64 of shape (2, 1) at t = 0: expected an array of real numbers",
        ),
        ((np.zeros((1, 2), complex), 0.0), 1.0, "gives u as complex128 of shape (1, 2)"),
        ((np.zeros((1, 2)), None), 1.0, "gives dH/dt = None at t = 0"),
        ((np.zeros((1, 2)), 1j), 1.0, "gives dH/dt = 1j at t = 0"),
        ((np.zeros((1, 2)), np.zeros(2)), 1.0, "gives dH/dt = array([0., 0.])"),
        ((np.zeros((1, 2)), np.nan), 1.0, "gives H = 1, but dH/dt = nan at the start, t = 0: expected the rate of"),
        ((np.zeros((1, 2)), np.inf), 1.0, "gives H = 1, but dH/dt = inf"),
        ((np.zeros((1, 2)), 0.0), 2j, "gives H = 2j at the start"),
        ((np.zeros((1, 2)), 0.0), None, "gives H = None at the start"),
    ],
)
def test_what_is_no_law_of_motion_is_named_before_the_run(found, energy, message):
    for method in ("DOP853", "RK4"):
        with pytest.raises(ArgumentError, match=re.escape(message)):
            simulate(Returns(found, energy), [[0.0, 0.0]], [[0.0, 0.0]], (0.0, 1.0), **kwargs(method))


@pytest.mark.parametrize("found", [None, [[0.0, 0.0]], (None, 0.0), ([[0.0, 0.0]], 0.0), (np.zeros((1, 2)), None)])
def test_the_public_face_of_a_law_names_it_too(found):
    for ask in (Returns(found).acceleration, Returns(found).energy_rate):
        with pytest.raises(ArgumentError, match=r"^Returns gives .* at t = 2: expected"):
            ask(2.0, [[0.0, 0.0]], [[0.0, 0.0]])


def test_rk4_notices_a_state_that_is_lost_while_forces_are_not():
    """NaN positions have no neighbours: Algorithm 1's forces are then 0, and finite."""

    class Gap(Law):
        def flow(self, t, q, p):
            return (np.full_like(q, np.nan) if 0.42 < t < 0.48 else np.zeros_like(q)), 0.0

    run = simulate(Gap(), [[0.0]], [[1.0]], (0.0, 1.0), method="RK4", dt=0.1)
    assert run.status == "failed"
    assert run.t[-1] == pytest.approx(0.4)


@pytest.mark.parametrize("method", ["DOP853", "RK45", "RK23", "Radau", "BDF", "LSODA", "RK4"])
def test_an_interrupted_run_is_a_prefix(method):
    whole = simulate(Oscillator(), [[1.0]], [[0.0]], (0.0, 2.0), **kwargs(method))
    law = Oscillator(breaks=1.0, error=KeyboardInterrupt)
    run = simulate(law, [[1.0]], [[0.0]], (0.0, 2.0), **kwargs(method))
    assert run.status == "interrupted"
    assert run.message == f"interrupted: the last sample is at t = {run.t[-1]:g}"
    assert 1 < len(run.t) < len(whole.t)
    for name in ("t", "q", "p", "u"):
        np.testing.assert_array_equal(getattr(run, name), getattr(whole, name)[: len(run.t)])
    np.testing.assert_array_equal(run.extra["work"], whole.extra["work"][: len(run.t)])


def test_ctrl_c_within_a_kernel_is_ctrl_c():
    run = simulate(Oscillator(breaks=1.0, error=out_of_a_kernel()), [[1.0]], [[0.0]], (0.0, 2.0))
    assert (run.status, 0.0 < run.t[-1] < 1.0) == ("interrupted", True)
    with pytest.raises(SystemError, match="of its own"):
        simulate(Oscillator(breaks=1.0, error=SystemError("of its own")), [[1.0]], [[0.0]], (0.0, 2.0))


def test_interrupted_before_the_first_time_to_keep():
    law = Oscillator(breaks=1.0, error=KeyboardInterrupt)
    run = simulate(law, [[1.0]], [[0.0]], (0.0, 2.0), t_eval=[1.5])
    assert (run.status, run.t.tolist()) == ("interrupted", [0.0])
    assert run.message == "interrupted: no sample was reached but the start"


def test_a_law_without_energy_has_no_balance():
    class Drift(Law):
        def flow(self, t, q, p):
            return np.zeros_like(q), float("nan")

    for options in ({}, {"method": "RK4", "dt": 0.1}):
        run = simulate(Drift(), [[0.0]], [[1.0]], (0.0, 1.0), **options)
        assert run.status == "complete"
        assert dict(run.extra) == {}
        with pytest.raises(ArgumentError, match=r"it carries no extra\['work'\].* where the law has an energy"):
            _ = run.energy_residual


def test_the_progress_bar_changes_nothing(capsys):
    quiet = simulate(LAW, *start(), (0.0, 0.5))
    shown = simulate(LAW, *start(), (0.0, 0.5), progress=True)
    np.testing.assert_array_equal(shown.q, quiet.q)


def test_the_start_is_not_changed():
    q0, p0 = start()
    before = q0.copy()
    run = simulate(LAW, q0, p0, (0.0, 0.2), method="RK4", dt=0.05)
    np.testing.assert_array_equal(q0, before)
    assert q0.flags.writeable
    np.testing.assert_array_equal(run.q[0], before)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"t_span": (1.0, 0.0)}, "t_span = (1, 0): expected finite t0 < t1"),
        ({"method": "RK4"}, "dt = None: method RK4 needs a fixed step, such as dt=0.005"),
        ({"method": "RK4", "dt": 1e-3, "t_span": (1e16, 1e16 + 8)}, "too small to change t = 1e+16"),
        ({"dt": 0.1}, "dt = 0.1: DOP853 chooses its own steps; give t_eval to choose output times"),
        ({"t_eval": [0.5, 0.5]}, "expected rising times within t_span"),
        ({"law": Algorithm1}, "did you forget the parentheses?"),
        ({"q0": [[0.0]]}, "q has shape (1, 1) but p has shape (1, 2)"),
        ({"q0": [[0.0]], "p0": [[0.0]]}, "the target has 2 components but the agents have 1"),
    ],
)
def test_refusals(options, message):
    arguments = {"law": LAW, "q0": [[0.0, 0.0]], "p0": [[0.0, 0.0]], "t_span": (0.0, 1.0)} | options
    with pytest.raises(ArgumentError, match=re.escape(message)):
        simulate(**arguments)


def test_an_unknown_method_is_named():
    with pytest.raises(UnknownNameError, match=re.escape("unknown method 'RK5'; did you mean 'RK")):
        simulate(LAW, [[0.0, 0.0]], [[0.0, 0.0]], (0.0, 1.0), method="RK5")


def test_who_watches_sees_each_kept_sample_as_it_comes_and_may_end_the_run():
    law, q0, p0 = Algorithm1(), [[0.0], [7.9]], [[0.0], [0.0]]
    seen = []
    run = simulate(law, q0, p0, (0.0, 1.0), t_eval=[0.25, 0.5, 1.0], watch=seen.append)
    assert [sample.t for sample in seen] == run.t.tolist() == [0.25, 0.5, 1.0]
    np.testing.assert_array_equal([sample.q for sample in seen], run.q)

    def end(sample):
        if sample.t >= 0.5:
            raise KeyboardInterrupt

    ended = simulate(law, q0, p0, (0.0, 1.0), t_eval=[0.25, 0.5, 1.0], watch=end)
    assert (ended.status, ended.t.tolist()) == ("interrupted", [0.25, 0.5])
    np.testing.assert_array_equal(ended.q, run.q[:2])


@pytest.mark.parametrize("method", ["DOP853", "scipy-RK45", "LSODA"])
def test_an_absolute_tolerance_is_a_length_so_that_units_do_not_matter(method):
    law, q, p = Algorithm1(), np.array([[0.0], [8.0], [15.0]]), np.array([[0.3], [0.0], [-0.3]])
    length, time = 2.0**30, 1.0  # the first step of scipy's solvers, and of ours, knows the unit of time
    run = simulate(law, q, p, (0.0, 1.0), method=method, rtol=1e-6, atol=1e-6)
    other = simulate(
        fl.rescale(law, length=length, time=time), q * length, p * (length / time), (0.0, time),
        method=method, rtol=1e-6, atol=1e-6 * length,
    )  # fmt: skip
    np.testing.assert_array_equal(other.q, run.q * length)
    np.testing.assert_array_equal(other.extra["work"], run.extra["work"] * (length / time) ** 2)
    assert other.floors == run.in_units(length, time).floors
    assert run.floors[:2] == pytest.approx((1e-6, 1e-6 / law.scales.time))
    slow = fl.rescale(law, time=2.0**-20)
    there = simulate(slow, q, p * 2.0**20, (0.0, 2.0**-20), method=method, rtol=1e-6, atol=1e-6)
    assert there.floors == run.in_units(1.0, 2.0**-20).floors


def test_rk4_that_blows_up_fails_at_once_and_says_why():
    """Its steps far beyond stability, cut where agents would fly out of range at once, are not cut without end."""
    law = Algorithm2(gains=Gains(c2_gamma=2e5), target=StaticTarget((0.0, 0.0)))
    q, p = [[0.0, 0.0], [5.0, 1.0], [3.0, 6.0]], [[1.0, 0.0], [0.0, 0.3], [0.2, 0.0]]
    run = simulate(law, q, p, (0.0, 10.0), method="RK4", dt=0.01)
    assert run.status == "failed"
    assert "reduce dt" in run.message
    assert (run.t[-1] < 0.2, run.stats["steps"] < 5000) == (True, True)


def test_a_run_that_would_take_a_thousand_million_steps_fails_in_seconds_and_says_how_many():
    """Forces of 1 on lengths of 1e-40: the law's own time is 1e-20."""
    law = LinkKeeping(((0, 1),), r=2e-40, k=1.0, c=1.0)
    run = simulate(law, [[0.0, 0.0], [1.1e-40, 0.0]], [[0.0, 0.0], [0.0, 1e-41]], (0.0, 1.0))
    assert run.status == "failed"
    assert re.fullmatch(r"it would take \S+e\+2\d more steps to t = 1: the last 10000 are \S+ long .*", run.message)
    assert run.stats["steps"] < 30_000


@pytest.mark.slow
def test_steps_that_collapse_at_a_collision_end_a_run_and_name_the_pair():
    """A bound pair of a logarithmic potential, whose friction lets it spiral into the pole."""
    pair = fl.pair_law("k*log(s)", adjacency="(1-s/r)**2", range=3, length=2, parameters={"k": 1.0})
    law = Algorithm2(alpha=pair, target=StaticTarget((0.0, 0.0)))
    run = simulate(law, [[-0.5, 0.0], [0.5, 0.0], [9.0, 9.0]], [[0.0, -0.7], [0.0, 0.7], [0.0, 0.0]], (0.0, 1e3))
    assert run.status == "failed"
    told = re.fullmatch(
        r"steps collapse at t = (\S+): the last 10000 are \S+ long on average; the nearest agents, (\d) and (\d), are "
        r"(\S+) apart",
        run.message,
    )
    assert told is not None, run.message
    assert {told[2], told[3]} == {"0", "1"}
    assert float(told[1]) == pytest.approx(run.t[-1], rel=1e-5)
    assert float(told[4]) == pytest.approx(np.linalg.norm(run.q[-1, 0] - run.q[-1, 1]), rel=1e-2)
    assert run.stats["steps"] < 60_000


@pytest.mark.parametrize("scale", [{"length": 1e100, "time": 1.0}, {"length": 1.0, "time": 1e-100}])
def test_a_law_beyond_the_scales_of_numbers_is_refused_in_a_line(scale):
    law = fl.rescale(Algorithm1(), **scale)
    with pytest.raises(
        ArgumentError, match=r"the law's length is .*: expected both from 1e-45 to 1e\+45; choose other"
    ):
        simulate(law, scale["length"] * np.array([[0.0], [7.0]]), np.zeros((2, 1)), (0.0, scale["time"]))
