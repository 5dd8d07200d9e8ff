"""No step leaps over a pole of a force; a run that meets one ends as failed."""

from __future__ import annotations

import numpy as np
import pytest

import flockana as fl
from flockana.dynamics.encounters import Encounters, State
from flockana.kernels.encounter_checks import Ends
from flockana.kernels.pole_crossings import crossing_listed
from flockana.sources.zavlanos_2007.laws import LinkKeeping

METHODS = [
    {"rtol": 1e-4},
    {"rtol": 1e-4, "method": "scipy-DOP853"},
    {"rtol": 1e-3, "method": "RK45"},
    {"rtol": 1e-4, "method": "LSODA"},
    {"rtol": 1e-4, "method": "BDF"},
    {"method": "RK4", "dt": 0.01},
]


@pytest.mark.parametrize("how", METHODS, ids=lambda how: how.get("method", "DOP853"))
@pytest.mark.parametrize("gap", [1e-5, 1e-8])
def test_no_link_leaps_over_its_pole(how, gap):
    """ψ = k s²/(r − s) holds a link for ever, as energy is conserved; a step over the pole would let it go."""
    law, length = LinkKeeping(((0, 1),), r=1.0, k=1.0, c=0.0), 1.0 - gap
    run = fl.simulate(law, [[0.0, 0.0], [length, 0.0]], [[0.0, 0.0], [1e-3, 0.0]], (0.0, 0.02), **how)
    longest = np.linalg.norm(run.q[:, 1] - run.q[:, 0], axis=1).max()
    assert longest < 1.0
    reasons = ("where their potential is infinite", "gave up", "left the finite numbers", "steps collapse")
    assert run.status == "complete" or any(reason in run.message for reason in reasons)


@pytest.mark.parametrize(
    "how",
    [{}, {"method": "scipy-DOP853"}, {"method": "LSODA"}, *({"method": "RK4", "dt": dt} for dt in (0.1, 0.01))],
    ids=lambda how: f"{how.get('method', 'DOP853')}-{how.get('dt', 0)}",
)
@pytest.mark.parametrize("compiled", [True, False])
def test_agents_that_no_potential_keeps_apart_meet_at_a_pole_and_the_run_fails(how, compiled):
    """An attraction −1/s²: two at rest fall into each other in a finite time, π/√2 for s = 2."""
    pair = fl.pair_law("-1/s", range=8.0, length=2.0, adjacency="1 - s/r")
    law = (fl.Algorithm1 if compiled else Plain)(pair, gains=fl.Gains(c1_alpha=1.0, c2_alpha=0.0))
    run = fl.simulate(law, [[0.0], [2.0]], [[0.0], [0.0]], (0.0, 10.0), **how)
    assert run.status == "failed"
    # relative motion s'' = −2/s² from s = 2: T = π/2 · √(2³/(2 · 2)) = π/√2
    assert run.t[-1] == pytest.approx(np.pi / np.sqrt(2.0), rel=1e-2)
    assert (run.q[:, 1] > run.q[:, 0]).all()


class Plain(fl.Algorithm1):
    """Algorithm 1, which the library must take for another law."""

    def flow(self, t, q, p):
        """As it was."""
        return super().flow(t, q, p)


def moved(q0, q1, h=1.0):
    """Two states of straight motion, and the paths between them."""
    p = (q1 - q0) / h
    still = np.zeros_like(q0)
    return State(q0, p, still), State(q1, p, still)


@pytest.mark.parametrize(
    ("ends", "pole", "crosses"),
    [
        (((0.0, 0.9), (0.0, 1.1)), 1.0, True),  # outwards
        (((0.0, 1.1), (0.0, 0.9)), 1.0, True),  # inwards
        (((0.0, 0.5), (0.0, 0.9)), 1.0, False),
        (((0.0, 3.0), (0.0, -3.0)), 1.0, True),  # in and out again
        (((0.0, 0.5), (0.0, -0.5)), 0.0, True),  # through each other
        (((0.0, 0.5), (0.0, 0.1)), 0.0, False),
    ],
)
def test_what_crosses(ends, pole, crosses):
    (a0, b0), (a1, b1) = ends
    before, after = moved(np.array([[a0], [b0]]), np.array([[a1], [b1]]))
    found = Encounters(np.empty((2, 0)), np.inf, poles=np.array([pole])).share(1.0, before, after)
    assert found == (-0.5 if crosses else 1.0)
    pairs = np.array([0], np.uint32), np.array([1], np.uint32)
    assert crossing_listed(Ends(1.0, *before, *after), (0.0, 10.0), np.array([pole]), 1.0, *pairs) == crosses


def test_pairs_that_no_pole_concerns_cross_as_they_like():
    before, after = moved(np.array([[0.0], [0.5], [0.8]]), np.array([[0.0], [0.6], [1.8]]))
    for among, crosses in ((None, True), (np.array([[0, 1]], np.int32), False), (np.array([[0, 2]], np.int32), True)):
        found = Encounters(np.empty((3, 0)), np.inf, poles=np.array([1.0]), among=among).share(1.0, before, after)
        assert (found < 0.0) == crosses


@pytest.mark.parametrize(("last", "half"), [(0.6, False), (0.4, True), (-0.1, True)])
def test_a_step_of_fixed_length_goes_half_of_the_way_to_a_pole_at_most(last, half):
    """From 1 towards a pole at 0; and as much from 1 towards one at 2."""
    pairs = np.array([0], np.uint32), np.array([1], np.uint32)
    for pole, end in ((0.0, last), (2.0, 2.0 - last)):
        before, after = moved(np.array([[0.0], [1.0]]), np.array([[0.0], [end]]))
        assert crossing_listed(Ends(1.0, *before, *after), (0.0, 1.0), np.array([pole]), 0.5, *pairs) == half


def test_no_pair_near_a_pole_crosses_none():
    before, after = moved(np.array([[0.0], [3.0]]), np.array([[0.1], [3.1]]))
    pairs = np.array([0], np.uint32), np.array([1], np.uint32)
    assert not crossing_listed(Ends(1.0, *before, *after), (0.0, 0.1), np.array([0.0, 1.0]), 1.0, *pairs)


def test_laws_say_where_their_poles_are():
    assert fl.Algorithm1().poles == ()
    assert fl.DeadZoneFlocking().poles == (0.0,)
    assert fl.pair_law("s**2/(3 - s)", range=3.0, length=1.0, adjacency="1 - s/r").poles == (3.0,)
    assert fl.pair_law("1/s", range=3.0, length=1.0, adjacency="1 - s/r").poles == (0.0,)
