"""Verdicts that may not change: under other units, places, frames, numbers of the agents, clocks, outputs, methods."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from flockana import Algorithm1, verify
from tests.adversarial import truth
from tests.adversarial.cases import effort
from tests.adversarial.strategies import flocks, seeds
from tests.adversarial.transforms import UNITS, UnchangedError, boosted, delayed_start, in_units, renumbered, rigid

BY_LAW = {
    1: ("os-1", "energy", "collision-energy", "alpha-flocking", "alpha-flocking-strict", "lattice-limit-printed"),
    2: ("os-3", "energy", "collision-energy", "alpha-flocking", "lattice-limit-printed", "E13"),
}
opposite = {("verified", "refuted"), ("refuted", "verified")}


def statuses(case):
    names = BY_LAW[1 if isinstance(case.law, Algorithm1) else 2]
    return {f"{name}:{c.name}": c.status for name in names for c in verify(name, case.run).claims}


def agree(case, other):
    one, two = statuses(case), statuses(other)
    flips = {name: (one[name], two[name]) for name in one if (one[name], two[name]) in opposite}
    assert not flips, f"{flips}\n  {case!r}\n  {other!r}"


@st.composite
def small(draw):
    case = draw(flocks())
    case = replace(case, options={}, until=min(case.until, 8.0 * truth.law_time(case.law)))
    assume(case.run.stats["steps"] < 1000)  # what is stiff takes a minute by LSODA, and changes no other way
    return case


def turned(rng, m, *, plain=False):
    return np.eye(m) if plain else np.linalg.qr(rng.normal(size=(m, m)))[0]


CHANGES = {
    "units": lambda case, rng: in_units(case, *list(UNITS.values())[rng.integers(3)]),
    "place": lambda case, rng: rigid(case, np.eye(np.shape(case.q0)[1]), 30.0 * case.law.alpha.d * rng.normal()),
    "turn": lambda case, rng: rigid(case, turned(rng, np.shape(case.q0)[1]), 0.0),
    "mirror": lambda case, rng: rigid(case, -np.eye(np.shape(case.q0)[1]), 0.0),
    "frame": lambda case, rng: boosted(case, 3.0 * case.law.alpha.d / truth.law_time(case.law) * rng.normal()),
    "numbers": lambda case, rng: renumbered(case, rng.permutation(len(case.q0))),
    "clock": lambda case, rng: delayed_start(case, 50.0 * truth.law_time(case.law) * rng.normal()),
    "output": lambda case, rng: replace(case, options={"t_eval": np.linspace(0.0, case.until, rng.integers(2, 300))}),
    "method": lambda case, rng: replace(case, options={"method": ["RK45", "LSODA"][rng.integers(2)], "rtol": 1e-6}),
    "half": lambda case, rng: replace(case, options={"rtol": 0.5e-8}),
    "double": lambda case, rng: replace(case, options={"rtol": 2e-8}),
    "hundredth": lambda case, rng: replace(case, options={"rtol": 1e-10}),
}


@pytest.mark.parametrize("change", CHANGES)
@effort(0.08)
@given(case=small(), seed=seeds)
def test_nothing_turns_into_its_opposite(change, case, seed):
    try:
        other = CHANGES[change](case, np.random.default_rng(seed))
    except UnchangedError:
        assume(False)
    agree(case, other)
