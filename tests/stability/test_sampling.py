"""Largest sampling periods: against closed forms, the map's own multipliers, and runs that grow or decay."""

from functools import cache
from math import inf, sqrt

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from flockana import (
    Algorithm2,
    ExplicitEuler,
    Gains,
    NetConsensus,
    StaticTarget,
    TaylorStep,
    find_equilibrium,
    linearise,
    simulate,
)
from flockana.lattice import hexagonal_spiral
from flockana.solvers.semi_implicit_euler import SemiImplicitEuler
from flockana.sources.isola_2024.laws import MSNDiscretisation
from flockana.sources.vicsek_1995.laws import HeadingAveraging
from flockana.stability.law_studies import sampling_margin
from flockana.stability.sampling import scalar_period
from tests.refused import refused

LAW = Algorithm2(target=StaticTarget((0.0, 0.0)))
REST = find_equilibrium(LAW, hexagonal_spiral(8, 7.0)).q
MAPS = {
    "euler": ExplicitEuler,
    "hold": TaylorStep,
    "semi-implicit": SemiImplicitEuler,
    "msn": lambda law, dt: MSNDiscretisation(law, dt, in_place=False),
    "msn-in-place": MSNDiscretisation,
}


@cache
def margin_of(scheme):
    """The margin of the law in steps of a scheme, searched once."""
    return sampling_margin(MAPS[scheme](LAW, 0.1), REST)


@given(
    st.floats(0.01, 100.0),
    st.floats(0.01, 30.0),
    st.sampled_from([0.0, 0.5, 1.0, 1.5]),
    st.sampled_from([0.3, 0.999, 1.001, 1.1]),
)
def test_one_mode_is_stable_below_its_period_and_not_just_above(k, d, factor, share):
    """The multipliers of the step itself, as roots of a polynomial; far beyond some are stable again for f = 0."""
    period, there = scalar_period(k, d, factor)
    h = share * period
    roots = np.roots([1.0, h * d + factor * h * h * k - 2.0, 1.0 - h * d + (1.0 - factor) * h * h * k])
    assert (np.abs(roots).max() < 1.0) == (share < 1.0)
    at = np.roots([1.0, period * d + factor * period**2 * k - 2.0, 1.0 - period * d + (1.0 - factor) * period**2 * k])
    assert np.abs(at - there).min() < 1e-6
    assert abs(abs(there) - 1.0) < 1e-9


@pytest.mark.parametrize(
    ("k", "d", "factor", "period"),
    [
        (4.0, 3.0, 0.5, 2.0 / 3.0),  # flips at 2/d
        (4.0, 1.0, 0.5, 0.5),  # swings at 2d/k
        (4.0, 1.0, 0.0, 0.25),  # swings at d/k
        (4.0, 5.0, 0.0, 0.5),  # flips at 2/4, the faster of the roots −1 and −4
        (4.0, 0.0, 0.0, 0.0),
        (4.0, 0.0, 1.0, 0.0),  # semi-implicit keeps a swing that nothing damps
        (4.0, 0.0, 1.5, sqrt(2.0 / 4.0)),  # the MSN project's step damps it
        (0.0, 2.0, 1.0, 1.0),
        (0.0, 0.0, 0.5, 0.0),
    ],
)
def test_periods_in_closed_form(k, d, factor, period):
    assert scalar_period(k, d, factor)[0] == pytest.approx(period, rel=1e-14)


@pytest.mark.parametrize("scheme", MAPS)
def test_a_flock_is_stable_below_its_margin_and_not_just_above(scheme):
    """By the multipliers of the map, which are held against finite differences of its steps elsewhere."""
    found = margin_of(scheme)
    for share, stable in ((0.5, True), (0.999, True), (1.001, False), (1.05, False)):
        assert linearise(MAPS[scheme](LAW, share * found.period), REST).stable == stable, share
    at = linearise(MAPS[scheme](LAW, found.period), REST)
    assert np.abs(at.multipliers - found.first.multiplier).min() < 1e-5
    assert found.least <= found.period
    assert found.certified
    assert found.first.shape.shape == REST.shape
    assert np.linalg.norm(found.first.shape) == pytest.approx(1.0)


def test_a_law_is_held_as_in_the_taylor_step():
    hold, taylor = sampling_margin(LAW, REST), margin_of("hold")
    assert (hold.period, hold.least) == (taylor.period, taylor.least)
    assert hold.certified
    assert (1.0 - 1e-6) * hold.period < hold.least <= hold.period
    assert hold.first.frequency == pytest.approx(abs(np.angle(hold.first.multiplier)) / hold.period)


@pytest.mark.parametrize("share", [0.97, 1.03])
def test_runs_decay_below_the_margin_and_grow_above(share):
    """Nonlinear runs from a nudge along the mode that goes first."""
    found = margin_of("semi-implicit")
    start = REST + 1e-7 * np.real(found.first.shape)
    run = simulate(SemiImplicitEuler(LAW, share * found.period), start, 0.0 * start, (0.0, 120 * found.period))
    away = np.linalg.norm(run.q - REST, axis=(1, 2))
    grown = away[-10:].max() / away[:10].max()
    assert grown < 0.3 if share < 1.0 else grown > 3.0


def test_many_agents_flip_where_the_least_eigenvalue_of_m_vanishes():
    many = find_equilibrium(LAW, hexagonal_spiral(45, 7.0)).q
    found = sampling_margin(MAPS["msn"](LAW, 0.1), many)
    assert found.certified
    flow = linearise(LAW, many)
    k, d, h = flow.stiffness.toarray(), flow.damping.toarray(), found.period
    assert abs(np.linalg.eigvalsh(4.0 * np.eye(len(k)) - 2.0 * h * d - 2.0 * h * h * k)[0]) < 1e-9
    below = 0.999 * h
    assert np.linalg.eigvalsh(4.0 * np.eye(len(k)) - 2.0 * below * d - 2.0 * below**2 * k)[0] > 0.0


def test_what_is_not_damped_has_no_margin_and_drift_is_set_apart():
    swing = Algorithm2(gains=Gains(c1_gamma=4.0, c2_gamma=0.0), target=StaticTarget((0.0,)))
    assert sampling_margin(swing, [[0.0]]).period == 0.0
    free = Algorithm2(gains=Gains(c1_gamma=0.0, c2_gamma=0.0), target=StaticTarget((0.0,)))
    assert sampling_margin(free, [[0.0]]).period == inf
    assert sampling_margin(free, [[0.0]]).first is None


test_bad_input_is_refused = refused(
    (lambda: sampling_margin(HeadingAveraging(), REST), "or a map that steps one"),
    (lambda: sampling_margin("law", REST), "law = 'law': expected a law"),
    (lambda: sampling_margin(LAW, 1.1 * REST), "the state is no equilibrium"),
    (lambda: scalar_period(-1.0, 1.0), "k = -1"),
    (lambda: margin_of("euler").times(0.0), "dt = 0"),
    (
        lambda: sampling_margin(LAW, REST, limit=0.001),
        r"8 agents, 32 states in one component, would take about .* s and .* MB",
    ),
)


def test_a_margin_that_rounding_hides_is_not_called_certified():
    """A directed ring of five so near its threshold that multipliers grow by less than their rounding."""
    ring = np.roll(np.eye(5), 1, axis=1)
    threshold = np.sqrt(0.5 / np.tan(np.pi / 5.0) ** 2)
    for excess, certified in ((0.1, True), (1e-9, False)):
        flock = linearise(NetConsensus(ring, velocity=threshold * (1.0 + excess)), np.zeros((5, 1)))
        assert flock.sampling_margin().certified is certified
