"""Samples that are not of the law of a run are found by their inputs, those of a map by its steps."""

from dataclasses import dataclass, field, replace

import numpy as np
import pytest

import flockana as fl
from flockana import SemiImplicitEuler, verify
from flockana.base.errors import ArgumentError
from flockana.theorems.run_consistency import ensure_fits
from tests.toys.formulas import breakable

PAIR = ([[0.0, 0.0], [8.0, 0.5]], [[0.0, 0.0], [0.0, 1.0]])


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


def moved(values, by):
    """At the sixth sample, the first agent."""
    return values + (np.arange(len(values)) == 5)[:, None, None] * np.array([[by], [0.0]])


EDITS = {
    "an input": lambda run: replace(run, u=np.where(np.arange(len(run.t))[:, None, None] == 5, 1.001 * run.u, run.u)),
    "a position": lambda run: replace(run, q=moved(run.q, 1e-4)),
    "a velocity": lambda run: replace(run, p=moved(run.p, 1e-3)),
    "the law": lambda run: replace(run, law=Pushed()),
    "its gains": lambda run: replace(run, law=fl.Algorithm1(gains=fl.Gains(c1_alpha=30.001))),
}


@pytest.mark.parametrize("edit", EDITS.values(), ids=EDITS)
@pytest.mark.parametrize("how", [{}, {"t_eval": np.linspace(0.0, 2.0, 30)}, {"method": "RK4", "dt": 0.02}])
def test_samples_of_another_law_are_refused(edit, how: dict) -> None:
    run = fl.simulate(fl.Algorithm1(), *PAIR, (0.0, 2.0), **how)
    ensure_fits(run)
    with pytest.raises(ArgumentError, match="expected a run as simulate returned it; was it edited, or is it of ano"):
        ensure_fits(edit(run))


@pytest.mark.slow
def test_a_law_that_is_another_function_each_time_is_refused_as_simulated() -> None:
    with pytest.raises(ArgumentError, match="was it edited, or is it of another law"):
        verify("energy", fl.simulate(Gusty(), *PAIR, (0.0, 0.05)))


def test_a_run_that_leaps_over_a_spike_of_its_law_is_judged_not_accused() -> None:
    """The adjacency falls to -100 within a few thousandths of a length: steps of the usual tolerance may miss it."""
    law = fl.Algorithm1(breakable(c=100.0, o=1.29, w=300.0), fl.Gains(c1_alpha=0.05, c2_alpha=0.05))
    start = [[0.0, 0.0], [1.8, 0.0]], [[0.9, 0.0], [-0.9, 0.0]]
    verdict = verify("energy", law=law, q0=start[0], p0=start[1], t_span=(0.0, 0.6))
    assert verdict.claim("rate").status == "vacuous"
    assert verdict.claim("balance").status != "refuted"


@dataclass(frozen=True)
class Watched(fl.FixedSteps):
    """A map that notes the times at which it is asked to step."""

    asked: list = field(default_factory=list, compare=False)

    def step(self, t, q, p, memory):
        self.asked.append(t)
        return super().step(t, q, p, memory)


@pytest.mark.parametrize(("steps", "again"), [(50, 12), (5, 5), (12, 12)])
def test_steps_of_a_map_from_its_first_to_its_last_are_made_again(steps: int, again: int) -> None:
    law = Watched(fl.DeadZoneFlocking(), SemiImplicitEuler(0.125))
    run = fl.simulate(law, *PAIR, (0.0, 0.125 * steps))
    law.asked.clear()
    ensure_fits(run)
    assert (len(law.asked), law.asked[0], law.asked[-1]) == (again, 0.0, 0.125 * (steps - 1))
