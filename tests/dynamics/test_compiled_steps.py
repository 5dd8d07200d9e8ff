"""Compiled runs: the same law to rounding, the same decisions as step by step, and only where both are the same."""

import subprocess
import sys
from dataclasses import dataclass

import numpy as np
import pytest

from flockana import Algorithm3, Capsule, ObstacleTerm, PairTerm, Polygon, Sphere, Wall, simulate
from flockana.dynamics import compiled_steps
from flockana.dynamics.compiled_steps import engine_of
from flockana.dynamics.error_tolerances import Control, ErrorFloors
from flockana.dynamics.first_evaluation import first_call
from flockana.dynamics.moving_frame import Plan
from flockana.environment import targets
from flockana.interactions import AlphaInteraction, Gains
from flockana.jit import register_jitable
from flockana.kernels import alpha
from flockana.kernels.pair_kernels import lift
from flockana.kernels.verlet_list import no_pairs
from flockana.laws.olfati_saber import Algorithm1, Algorithm2
from flockana.solvers.dop853 import DOP853
from flockana.solvers.rk4 import RK4
from flockana.solvers.scipy_solver import Scipy
from flockana.sources.li_dead_zone import DeadZoneInteraction
from tests.programs import posix

TARGETS = [
    targets.StaticTarget((5.0, -3.0), (0.3, 0.1)),
    targets.LinearTarget((20.0, 3.0), (1.5, -0.5)),
    targets.SineTarget((0.0, 4.0), (1.0, 0.2), amplitude=2.0, frequency=0.3, phase=0.7),
    targets.CircleTarget((5.0, 1.0), 8.0, frequency=0.2, phase=-0.4),
    targets.RescaledVelocity(targets.StaticTarget((5.0, -3.0), (0.3, 0.1)), 0.4),
    targets.RescaledVelocity(targets.CircleTarget((5.0, 1.0), 8.0, frequency=0.2), 0.25),
]
SPHERES = Sphere((-3.0, 6.0), 2.0), Sphere((12.0, 24.0), 4.0), Sphere((900.0, 0.0), 1.0)
TRIANGLE = Polygon([(-6.0, 0.0), (-1.0, 2.0), (-2.0, 16.0)])
BODIES = [  # near a flock between 0 and 18, none of them in its way: every kind, one and several of them
    (2, ()),
    (2, (TRIANGLE, Wall((0.0, -1.0), (0.3, 1.0)), Capsule((-3.0, 0.0), (-2.0, 15.0), 1.0), *SPHERES)),
    (3, (Sphere((-3.0, 6.0, 8.0), 2.0), Sphere((9.0, 9.0, 22.0), 3.0), Wall((-1.0, 0.0, 0.0), (1.0, 0.2, 0.0)))),
]
PER_AGENT = Gains(c1_gamma=np.linspace(0.5, 2.0, 12), c2_gamma=np.linspace(1.0, 3.0, 12))


@dataclass(frozen=True)
class Plain(Algorithm2):
    """Algorithm 2, which the library must take for another law."""

    def flow(self, t, q, p):
        """As it was."""
        return super().flow(t, q, p)


@dataclass(frozen=True)
class Stepped(Algorithm3):
    """Algorithm 3, which the library must take for another law."""

    def flow(self, t, q, p):
        """As it was."""
        return super().flow(t, q, p)


class LastOfAll(Algorithm3):
    """Algorithm 3, its obstacles the last of its terms."""

    @property
    def terms(self):
        """As they are, in another order."""
        return tuple(sorted(super().terms, key=lambda term: isinstance(term, ObstacleTerm)))


def start(n=12, m=2, seed=0, spread=18.0):
    rng = np.random.default_rng(seed)
    return rng.uniform(0.0, spread, (n, m)), rng.normal(0.0, 2.0, (n, m)) + 1.0


def calm(n=7):
    """A disturbed triangular patch, almost at rest: no step of its run hangs on rounding."""
    rng = np.random.default_rng(n)
    corners = [(7.0 * (i + 0.5 * (j % 2)), 7.0 * 0.75**0.5 * j) for j in range(n) for i in range(n)]
    return np.array(corners) + rng.normal(0.0, 0.2, (n * n, 2)), rng.normal(0.0, 0.05, (n * n, 2)) + 1.0


def laws():
    for target in TARGETS:
        yield 2, Algorithm2(target=target, gains=Gains(c1_gamma=0.7))
    yield 2, Algorithm2(target=TARGETS[3], gains=PER_AGENT)
    yield 2, Algorithm2(target=TARGETS[3], gains=Gains(c1_gamma=np.linspace(0.5, 2.0, 12)))
    yield 2, Algorithm1(DeadZoneInteraction(ramp=0.5))
    yield 2, Algorithm1(AlphaInteraction(unit=2.0, a=2.0, b=5.0))
    for m in (1, 3):
        yield m, Algorithm2(target=targets.LinearTarget((1.0, 2.0, 3.0)[:m], (0.5, 0.25, 1.0)[:m]))
    for m, bodies in BODIES:
        yield m, Algorithm3(target=targets.LinearTarget((1.0, 2.0, 3.0)[:m], (0.5, 0.25, 1.0)[:m]), obstacles=bodies)


def engine(law, q, p, plan, t=0.0):
    """The compiled integrator of a law at its start."""
    return engine_of(law, first_call(law, t, q, p), plan)


@pytest.mark.slow
@pytest.mark.parametrize(("m", "law"), list(laws()))
def test_the_compiled_form_is_the_law_to_rounding(m, law):
    q0, p0 = start(m=m)
    control = Control(1e-10, ErrorFloors(1e-10, 1e-10, 1e-10))
    made_of = engine(law, q0, p0, Plan(DOP853(), np.array([0.7]), np.empty(0), control), 0.5)
    made = made_of.advance()
    t, f = float(made_of.block.t[made]), made_of.block.f[made]
    states, work = made_of.states(made)
    q, p, found = states[-1]
    (u, power), energy = law.flow(t, q, p), law.hamiltonian(t, q, p)
    stiff = np.abs(law.jacobian(t, q, p)).sum(axis=1).max()  # times a rounding of the places: what the frame may change
    rounding = max(1e-13 * np.abs(u).max(), np.finfo(float).eps * np.abs(q).max() * stiff)
    np.testing.assert_allclose(found, u, rtol=1e-12, atol=rounding)
    assert f[-1] == pytest.approx(power, rel=1e-12, abs=1e-13 * float(np.abs(u * p).sum()))
    assert t > 0.5
    assert made_of.block.energy[made] == pytest.approx(energy, rel=1e-12)
    assert work[-1] == pytest.approx(energy - law.hamiltonian(0.5, q0, p0), abs=1e-9 * abs(energy))


@pytest.mark.slow
@pytest.mark.parametrize("method", ["DOP853", "RK45", "RK23"])
def test_it_decides_as_step_by_step(method):
    law, times = Algorithm2(target=TARGETS[3]), [0.0, 0.11, 0.25, 1.0]
    for sampled in (None, times):
        ours, theirs = (
            simulate(law, *calm(), (0.0, 1.0), method=name, rtol=1e-6, t_eval=sampled)
            for name in (method, f"scipy-{method}")
        )
        assert ours.stats["steps"] == theirs.stats["steps"]
        assert ours.stats["redone"] == theirs.stats["redone"]
        np.testing.assert_allclose(ours.t, theirs.t, rtol=1e-6)
        np.testing.assert_allclose(ours.path.t, theirs.path.t, rtol=1e-6)
        np.testing.assert_allclose(ours.q, theirs.q, atol=1e-8)
        work = theirs.extra["work"]  # a step's length is known to the rounding of the error that it is chosen by
        np.testing.assert_allclose(ours.extra["work"], work, atol=1e-6 * np.abs(work).max())


def test_rk4_makes_the_same_steps_compiled_or_not():
    for sampled in (None, [0.0, 0.11, 1.0], [0.5]):
        ours, plain = (
            simulate(kind(target=TARGETS[3]), *calm(), (0.0, 1.0), method="RK4", dt=0.013, t_eval=sampled)
            for kind in (Algorithm2, Plain)
        )
        assert ours.stats["steps"] == plain.stats["steps"]
        np.testing.assert_array_equal(ours.t, plain.t)
        np.testing.assert_allclose(ours.q, plain.q, atol=1e-10)
        np.testing.assert_allclose(ours.extra["work"], plain.extra["work"], atol=1e-8)
        np.testing.assert_array_equal(ours.path.t, plain.path.t)


def test_no_encounter_is_leapt_over():
    q, p = np.array([[0.0, 0.0], [300.0, 0.1]]), np.array([[20.0, 0.0], [-20.0, 0.0]])
    for options in ({}, {"method": "RK4", "dt": 20.0}):
        run = simulate(Algorithm1(), q, p, (0.0, 20.0), **options)
        assert run.stats["redone"] > 0
        assert run.min_distance() < 8.4
        assert np.abs(run.path.u).max() > 1.0


@pytest.mark.slow
@pytest.mark.parametrize(
    ("body", "beside"),
    [
        (Sphere((45.0, 1.0), 1.5), []),
        (Wall((45.0, 0.0), (-1.0, 0.1)), [Sphere((0.0, 90.0), 1.0), Capsule((0.0, 90.0), (9.0, 90.0), 1.0)]),
    ],
    ids=["sphere", "wall beside others"],
)
def test_no_obstacle_is_leapt_over(body, beside):
    """RK4's steps hang on encounters alone; the force's kink at d' makes others differ by rounding."""
    q, p = np.array([[0.0, 0.0], [0.0, 8.0]]), np.array([[21.0, 0.5], [20.0, 0.0]])
    kind = LastOfAll if beside else Algorithm3
    law = kind(target=targets.LinearTarget((0.0, 3.5), (20.0, 0.0)), obstacles=[*beside, body])
    stepped = Stepped(law.alpha, law.gains, law.target, law.beta, law.obstacles)
    ours, plain = (simulate(one, q, p, (0.0, 3.0), method="RK4", dt=2.0) for one in (law, stepped))
    assert (ours.stats["steps"], ours.stats["redone"]) == (plain.stats["steps"], plain.stats["redone"])
    np.testing.assert_allclose(ours.path.t, plain.path.t, rtol=1e-9)
    assert ours.stats["redone"] > 3
    ours, plain = (simulate(one, q, p, (0.0, 3.0), rtol=1e-7) for one in (law, stepped))
    np.testing.assert_allclose(ours.q[-1], plain.q[-1], atol=1e-5)
    assert body.clearance(ours.path.q.reshape(-1, 2)).min() < law.beta.d
    assert engine(law, q, p, Plan(RK4(2.0), np.array([3.0]), np.empty(0))) is not None


def test_rk4_grows_back_after_an_encounter_as_step_by_step():
    q, p = np.array([[0.0, 0.0], [300.0, 0.1]]), np.array([[20.0, 0.0], [-20.0, 0.0]])
    still = {"target": targets.StaticTarget((0.0, 0.0)), "gains": Gains(c1_gamma=0.0, c2_gamma=0.0)}
    ours, plain = (simulate(kind(**still), q, p, (0.0, 20.0), method="RK4", dt=20.0) for kind in (Algorithm2, Plain))
    assert (ours.stats["steps"], ours.stats["redone"]) == (plain.stats["steps"], plain.stats["redone"])
    np.testing.assert_allclose(ours.path.t, plain.path.t, rtol=1e-9)


def test_a_call_ends_early_where_steps_are_much_work():
    """So that Ctrl-C is heard: 600 agents in one place are 180,000 pairs, 13 times a step."""
    q = 1e-3 * np.random.default_rng(0).normal(size=(600, 2))
    control = Control(1e-10, ErrorFloors(1e-10, 1e-10, 1e-10))
    crowd = engine(Algorithm1(), q, np.zeros_like(q), Plan(DOP853(), np.array([9.0]), np.empty(0), control))
    assert crowd.advance() < 5e7 / (12 * 180_000) + 2
    assert crowd.failure == ""


def test_calls_of_one_step_make_the_same_run(monkeypatch):
    law = Algorithm2(target=TARGETS[1])
    many = simulate(law, *calm(), (0.0, 0.3), t_eval=[0.0, 0.1, 0.3])
    monkeypatch.setattr(compiled_steps, "_NUMBERS", 1)
    one = simulate(law, *calm(), (0.0, 0.3), t_eval=[0.0, 0.1, 0.3])
    assert one.stats["steps"] == many.stats["steps"]
    np.testing.assert_allclose(one.q, many.q, atol=1e-9)


@pytest.mark.slow
def test_a_law_that_changes_what_its_form_stands_for_is_stepped():
    class Told(targets.LinearTarget):
        """A γ-agent that lies about its velocity."""

        def state(self, t):
            q, p = super().state(t)
            return q, 2.0 * p

    class Stronger(PairTerm):
        """Twice the force."""

        def act(self, t, q, p, u):
            return super().act(t, q, p, u)

    class Strong(Algorithm1):
        """With that term."""

        @property
        def terms(self):
            return (Stronger(self.alpha, 1.0, 1.0),)

    class Weighed(AlphaInteraction):
        """Sums of its own."""

        def forces(self, *arguments, **options):
            return super().forces(*arguments, **options)

    class Fenced(Algorithm2):
        """With an obstacle that none of its terms knows of."""

        obstacle_field = Algorithm3(target=TARGETS[0], obstacles=[Sphere((50.0, 50.0), 1.0)]).obstacle_field

    class Doubled(Algorithm3):
        """With the same obstacles in two of its terms."""

        @property
        def terms(self):
            return (*super().terms, *(term for term in super().terms if isinstance(term, ObstacleTerm)))

    q, p = start()
    plain = [
        Plain(target=TARGETS[1]),
        Algorithm2(target=Told((0.0, 0.0), (1.0, 0.0))),
        Algorithm2(target=targets.RescaledVelocity(targets.CallableTarget(lambda t: ((t, 0.0), (1.0, 0.0))), 0.5)),
        Strong(),
        Algorithm1(Weighed()),
    ]
    dop853, lsoda = (Plan(solver, np.array([0.5]), np.empty(0)) for solver in (DOP853(), Scipy("LSODA")))
    for law in plain:
        assert engine(law, q, p, dop853) is None, law
    assert engine(Algorithm1(), q, p, lsoda) is None
    around = Sphere((-2.0, 12.0), 3.0)
    for law in (Fenced(target=TARGETS[1]), Doubled(target=TARGETS[1], obstacles=[around])):
        assert engine(law, q, p, dop853) is not None  # its obstacles are guarded, whatever its terms are
        ours, theirs = (simulate(law, q, p, (0.0, 0.5), method=name, rtol=1e-10) for name in ("DOP853", "scipy-DOP853"))
        np.testing.assert_allclose(ours.q[-1], theirs.q[-1], atol=1e-7)
    lied = simulate(plain[1], q, p, (0.0, 0.5), rtol=1e-9)
    np.testing.assert_allclose(lied.u[-1], plain[1].acceleration(0.5, lied.q[-1], lied.p[-1]), rtol=1e-9, atol=1e-9)


def test_a_crowd_is_stepped_and_one_that_gathers_on_the_way_is_told(monkeypatch):
    q, p = start()
    full = no_pairs(*q.shape)
    full.counts[0] = -1
    monkeypatch.setattr(compiled_steps, "fill", lambda *_: full)
    assert engine(Algorithm1(), q, p, Plan(DOP853(), np.array([0.01]), np.empty(0))) is None
    monkeypatch.undo()
    advance = compiled_steps.advance

    def crowded(*given):
        given[5][0].counts[0] = -1
        return compiled_steps.Advanced(*advance(*given))._replace(status=compiled_steps.UNLISTED)

    monkeypatch.setattr(compiled_steps, "advance", crowded)
    told = simulate(Algorithm1(), q, p, (0.0, 0.01))
    assert told.status == "failed"
    assert "than a list has room for: try method='scipy-DOP853'" in told.message


ALARMS = """
import signal, sys
import numpy as np
from flockana import Algorithm2, StaticTarget, simulate

class Alarm(Exception):
    pass

def ring(number, frame):
    raise Alarm

law, rng = Algorithm2(target=StaticTarget((0.0, 0.0))), np.random.default_rng(0)
q, p = rng.uniform(-60.0, 60.0, (150, 2)), rng.normal(size=(150, 2))
samples = np.linspace(0.0, 1e4, 1000)
simulate(law, q, p, (0.0, 100.0), t_eval=samples[:10])  # compiles
signal.signal(signal.SIGALRM, ring)
clean = 0
for k in range(12):
    signal.setitimer(signal.ITIMER_REAL, 0.05 + 0.01 * k)
    try:
        simulate(law, q, p, (0.0, 1e4), t_eval=samples)
    except Alarm:
        clean += 1
print(clean)
"""


@pytest.mark.slow
@posix
def test_an_alarm_during_a_compiled_run_raises_its_own_exception():
    """In a process of its own, which a kernel that gives Python more than numbers may kill."""
    ended = subprocess.run([sys.executable, "-c", ALARMS], capture_output=True, text=True, check=False)
    assert (ended.returncode, ended.stdout) == (0, "12\n"), ended.stderr


UNPACKING = """
import signal, sys
import numpy as np
from flockana import Algorithm1, simulate

class Alarm(Exception):
    pass

def ring(number, frame):
    raise Alarm

def interrupt(at):
    calls = []
    def count(frame, event, argument):
        if event == "call" and frame.f_code.co_filename.endswith(("function_type.py", "serialize.py")):
            calls.append(frame.f_code.co_name)
            if len(calls) == at:
                signal.raise_signal(signal.SIGALRM)
    sys.setprofile(count)
    try:
        simulate(Algorithm1(), *calm, (0.0, 0.2))
    except Alarm:
        return True
    finally:
        sys.setprofile(None)
    return not calls[at - 1:]

calm = np.random.default_rng(0).uniform(-6.0, 6.0, (2, 5, 2))
interrupt(0)
assert not interrupt(0)  # there are such calls
signal.signal(signal.SIGALRM, ring)
calls = [k for k in range(1, 100) if not interrupt(k)]
print(calls)
"""


@pytest.mark.slow
@posix
def test_an_alarm_while_numba_unpacks_a_callback_is_not_lost():
    """In a process of its own, as the one above; numba hands a callback to a kernel by calls of Python functions."""
    ended = subprocess.run([sys.executable, "-c", UNPACKING], capture_output=True, text=True, check=False)
    assert (ended.returncode, ended.stdout) == (0, "[]\n"), ended.stderr


@pytest.mark.slow
def test_a_pair_law_of_many_parameters_or_one_that_allocates_is_integrated_all_the_same():
    class Long(AlphaInteraction):
        """With parameters that nothing reads."""

        @property
        def par(self):
            return np.concatenate([super().par, np.zeros(32)])

    @register_jitable
    def through_an_array(s2, par, panels):
        held = np.empty(1)
        held[0] = alpha.pair_alpha_potential(s2, par, panels)
        return held[0]

    class Allocating(AlphaInteraction):
        """With a potential that needs memory."""

        kernels = lift(alpha.pair_alpha, alpha.pair_alpha_slope, through_an_array)

    plain = simulate(Algorithm1(), *calm(3), (0.0, 0.2))
    for pair in (Long(), Allocating()):
        law = Algorithm1(pair)
        assert law.compiled(2) is not None
        np.testing.assert_allclose(simulate(law, *calm(3), (0.0, 0.2)).q[-1], plain.q[-1], atol=1e-9)


def test_a_run_that_fails_says_why():
    wild = Algorithm2(gains=Gains(c1_gamma=1e300), target=targets.StaticTarget((0.0, 0.0)))
    run = simulate(wild, *start(), (0.0, 10.0), method="RK4", dt=1.0)
    assert run.status == "failed"
    assert "RK4 left the finite numbers at t = " in run.message
    assert np.isfinite(run.q).all()
    run = simulate(Algorithm1(gains=Gains(c1_alpha=1e60)), *start(), (1e9, 1e9 + 1.0))
    assert run.status == "failed"
    assert "DOP853 gave up at t = 1e+09: Required step size is less than spacing" in run.message
