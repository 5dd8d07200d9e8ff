"""A verdict does not hang on how finely a run was integrated, nor is it given of a run that failed or was edited."""

from __future__ import annotations

import copy
import pickle
from dataclasses import dataclass, field, replace
from types import SimpleNamespace

import numpy as np
import pytest

import flockana as fl
from flockana.base.errors import ArgumentError
from flockana.base.seals import changed
from flockana.dynamics.trajectory import Trajectory
from flockana.laws.semi_implicit import SemiImplicitEuler
from flockana.theorems import Claim, Theorem, Tolerances, verify
from flockana.theorems import second_run as module
from flockana.theorems.claims import judged
from flockana.theorems.observed import Observed
from flockana.theorems.second_run import ensure_fits

SPRING = fl.Algorithm2(
    gains=fl.Gains(c1_alpha=0.0, c2_alpha=0.0, c1_gamma=1.0, c2_gamma=0.0), target=fl.StaticTarget((0.0,))
)
PAIR = ([[0.0, 0.0], [8.0, 0.5]], [[0.0, 0.0], [0.0, 1.0]])


def returns_to_the_start(bound: float) -> Theorem:
    """After one period a harmonic oscillator is at its start: true of the law for every bound > 0."""

    def check(seen: Observed, tolerances: Tolerances) -> tuple[list, list[Claim]]:
        away = seen.series(lambda run: np.abs(run.q[:, 0, 0] - run.q[0, 0, 0]))[-1]
        return [], [judged("back", bound - away)]

    return Theorem(
        "ours",
        "back after a period",
        "A statement that is long enough to be read by a person.",
        "ours",
        "trajectory",
        check,
    )


def oscillation(**how: object) -> Trajectory:
    return fl.simulate(SPRING, [[1.0]], [[0.0]], (0.0, 2.0 * np.pi), **how)


@pytest.mark.parametrize("bound", [1e-2, 1e-4, 1e-6, 1e-9])
@pytest.mark.parametrize(
    "how", [{"method": "RK4", "dt": 0.3}, {"rtol": 1e-4, "atol": 1e-6}, {}, {"method": "RK23", "rtol": 1e-3}]
)
def test_a_true_claim_is_never_refuted_by_the_integrator(bound: float, how: dict) -> None:
    run = oscillation(**how)
    error = abs(float(run.q[-1, 0, 0]) - 1.0)
    status = verify(returns_to_the_start(bound), run).status
    assert status in ("verified", "inconclusive")
    if error < 0.2 * bound:
        assert status == "verified"


def test_the_error_that_is_shown_holds_the_error_of_the_run() -> None:
    run = oscillation(method="RK4", dt=0.3)
    claim = verify(returns_to_the_start(0.5), run).claims[0]
    assert claim.status == "verified"
    assert claim.error == pytest.approx(2.0 * abs(float(run.q[-1, 0, 0]) - 1.0), rel=1e-2)
    assert claim.error > 1e-6


@dataclass(frozen=True)
class Pushed(fl.Algorithm1):
    """Algorithm 1 that a wind blows: another law, though it is a subclass."""

    def flow(self, t, q, p):
        u, rate = super().flow(t, q, p)
        return u + 1e-3, rate


@dataclass(frozen=True)
class Gusty(Pushed):
    """As often as it has been asked, the wind has grown."""

    asked: list[int] = field(default_factory=list)

    def flow(self, t, q, p):
        self.asked.append(1)
        u, rate = fl.Algorithm1.flow(self, t, q, p)
        return u + 1e-4 * len(self.asked), rate


EDITS = {
    "an input": lambda run: replace(run, u=np.where(np.arange(len(run.t))[:, None, None] == 5, 1.001 * run.u, run.u)),
    "a position": lambda run: replace(run, q=run.q + (np.arange(len(run.t)) == 5)[:, None, None] * 1e-4),
    "a velocity": lambda run: replace(
        run, p=run.p + (np.arange(len(run.t)) == 5)[:, None, None] * np.array([[1e-3], [0.0]])
    ),
    "the law": lambda run: replace(run, law=Pushed()),
    "its gains": lambda run: replace(run, law=fl.Algorithm1(gains=fl.Gains(c1_alpha=30.001))),
    "the clock": lambda run: replace(run, t=1.01 * run.t),
}


@pytest.mark.parametrize("edit", EDITS.values(), ids=EDITS)
@pytest.mark.parametrize("how", [{}, {"t_eval": np.linspace(0.0, 2.0, 30)}, {"method": "RK4", "dt": 0.02}])
def test_an_edited_run_is_refused(edit, how: dict) -> None:
    run = fl.simulate(fl.Algorithm1(), *PAIR, (0.0, 2.0), **how)
    verify("energy", run)
    with pytest.raises(ArgumentError, match="was made or changed by hand: expected a run as simulate returned it"):
        verify("energy", edit(run))


def test_a_state_from_elsewhere_is_refused_even_with_its_own_input() -> None:
    run = fl.simulate(fl.Algorithm1(), *PAIR, (0.0, 2.0))
    other = fl.simulate(fl.Algorithm1(), [[0.0, 0.0], [8.01, 0.5]], PAIR[1], (0.0, 2.0), t_eval=run.t)
    mixed = {
        name: np.where(np.arange(len(run.t))[:, None, None] < 6, getattr(run, name), getattr(other, name))
        for name in "qpu"
    }
    with pytest.raises(ArgumentError, match=r"is off by .* from where Algorithm1 leads"):
        ensure_fits(replace(run, **mixed))


@pytest.mark.parametrize("copied", [copy.deepcopy, lambda run: pickle.loads(pickle.dumps(run))], ids=["copy", "pickle"])
def test_an_edit_of_a_copy_is_seen(copied) -> None:
    """A copy can be written to."""
    run = copied(fl.simulate(fl.Algorithm1(), *PAIR, (0.0, 2.0), t_eval=np.linspace(0.0, 2.0, 60)))
    run.q[7] += 1e-4
    with pytest.raises(ArgumentError, match=r"was changed by hand since \(q\)"):
        verify("energy", run)


def test_an_edit_of_a_failed_run_is_seen_by_where_its_velocities_lead() -> None:
    """No second run is made of it, and no work was kept: of a state that is moved with its input, only that tells."""
    run = oscillation(t_eval=np.linspace(0.0, 2.0 * np.pi, 60))
    moved = 1e-4 * (np.arange(60) == 7)[:, None, None]
    edited = replace(run, q=run.q + moved, u=run.u - moved, status="failed", extra={})
    with pytest.raises(ArgumentError, match=r"q at t = .* is off by .* from where Algorithm2 leads"):
        ensure_fits(edited)


def test_a_copy_remembers_no_check_of_what_it_was_copied_from() -> None:
    run = fl.simulate(fl.Algorithm1(), *PAIR, (0.0, 2.0), t_eval=np.linspace(0.0, 2.0, 60))
    verify("energy", run)
    later = copy.deepcopy(run)
    later.q[7] += 1e-4
    with pytest.raises(ArgumentError, match=r"was changed by hand since \(q\)"):
        verify("energy", later)


def test_an_edit_past_the_flags_is_seen() -> None:
    run = fl.simulate(fl.Algorithm1(), *PAIR, (0.0, 2.0), t_eval=np.linspace(0.0, 2.0, 60))
    run.q.setflags(write=True)
    run.q[7] += 1e-4
    run.q.setflags(write=False)
    with pytest.raises(ArgumentError, match=r"was changed by hand since \(q\)"):
        verify("energy", run)


def test_who_watches_a_run_cannot_edit_it() -> None:
    def centred(sample):
        sample.q[:] -= sample.q.mean(axis=0) - 50.0

    watched = fl.simulate(fl.Algorithm1(), *PAIR, (0.0, 2.0), t_eval=[0.0, 0.7, 2.0], watch=centred)
    np.testing.assert_array_equal(watched.q, fl.simulate(fl.Algorithm1(), *PAIR, (0.0, 2.0), t_eval=[0.0, 0.7, 2.0]).q)


@pytest.mark.parametrize("own_step", [False, True])
def test_an_interval_that_is_not_integrated_to_its_end_accuses_nobody(monkeypatch, own_step: bool) -> None:
    """Either of the two integrations may fail before the next sample, from a state in which the law cannot go on."""
    integrated = module.integrated

    def early(*of, **how):
        return SimpleNamespace(t=of[0].t[:1]) if how.get("own_step", False) == own_step else integrated(*of, **how)

    run = fl.simulate(fl.Algorithm1(), *PAIR, (0.0, 2.0))
    monkeypatch.setattr(module, "integrated", early)
    ensure_fits(run)


def test_a_law_that_is_another_function_each_time_is_refused_as_simulated() -> None:
    with pytest.raises(ArgumentError, match="was it edited, or is it of another law"):
        verify("energy", fl.simulate(Gusty(), *PAIR, (0.0, 2.0), t_eval=np.linspace(0.0, 2.0, 60)))


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"t": [0.0, 2.0, 1.0]}, r"t\[1\] = 2 and t\[2\] = 1: expected rising times"),
        ({"t": [0.0, np.nan, 1.0]}, r"t\[1\] = nan: expected finite numbers"),
        ({"q": np.full((3, 1, 1), np.inf)}, r"q\[0, 0, 0\] = inf: expected finite numbers \(3 bad\)"),
        ({"u": np.full((3, 1, 1), np.nan)}, r"u\[0, 0, 0\] = nan"),
        ({"p": np.zeros((3, 1, 1), complex)}, "p: expected real numbers at 3 samples, got complex128"),
        ({"q": np.array([[["1"]]] * 3)}, "q: expected real numbers"),
        ({"extra": {"work": [0.0, np.nan, 0.0]}}, r"extra\['work'\]\[1\] = nan"),
        ({"extra": {"work": [0.0]}}, "expected real numbers at 3 samples"),
        ({"status": "finished"}, "status = 'finished': expected one of complete, interrupted, failed"),
        ({"law": None}, "law = None: expected a law"),
        ({"law": fl.Algorithm1}, "did you forget the parentheses"),
    ],
)
def test_a_trajectory_holds_real_finite_numbers_at_rising_times(change: dict, message: str) -> None:
    zeros = np.zeros((3, 1, 1))
    given = {"t": [0.0, 1.0, 2.0], "q": zeros, "p": zeros, "u": zeros, "law": fl.Algorithm1()}
    with pytest.raises(ArgumentError, match=message):
        Trajectory(**(given | change))


@pytest.mark.parametrize(
    ("bad", "message"),
    [
        ({"energy": 0.0}, r"tolerances.energy = 0: expected a number > 0"),
        ({"force": float("nan")}, r"tolerances.force = nan"),
        ({"settle": 1.0}, r"tolerances.settle = 1: expected a share below 1"),
        ({"giant": 2.0}, r"tolerances.giant = 2: expected a share below 1"),
        ({"contact": "x"}, r"tolerances.contact = 'x'"),
        ({"settle": -0.1}, r"tolerances.settle = -0.1: expected a number >= 0"),
    ],
)
def test_tolerances_are_validated(bad: dict, message: str) -> None:
    with pytest.raises(ArgumentError, match=message):
        Tolerances(**bad)


def test_verify_takes_tolerances_and_nothing_like_them() -> None:
    with pytest.raises(ArgumentError, match=r"tolerances = \{\}: expected flockana.Tolerances"):
        verify("E8", tolerances={})


@dataclass(frozen=True)
class Watched(SemiImplicitEuler):
    """A map that notes the times at which it is asked to step."""

    asked: list = field(default_factory=list, compare=False)

    def step(self, t, q, p, memory):
        self.asked.append(t)
        return super().step(t, q, p, memory)


@pytest.mark.parametrize(("steps", "again"), [(50, 12), (5, 5), (12, 12)])
def test_steps_of_a_map_from_its_first_to_its_last_are_made_again(steps: int, again: int) -> None:
    law = Watched(fl.DeadZoneFlocking(), dt=0.125)
    run = fl.simulate(law, *PAIR, (0.0, 0.125 * steps))
    law.asked.clear()
    ensure_fits(run)
    assert (len(law.asked), law.asked[0], law.asked[-1]) == (again, 0.0, 0.125 * (steps - 1))
