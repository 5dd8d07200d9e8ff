"""Controllability against exact ranks of Kalman's matrix, closed forms of Gramians, and known symmetries."""

from fractions import Fraction
from itertools import combinations
from math import exp

import numpy as np
import pytest
import sympy as sp

from flockana import Algorithm2, Gains, NetConsensus, StaticTarget, find_equilibrium, lattice, linearise
from flockana.stability import agents_to_inform, controllability
from flockana.stability.controllability import gramians, scaled_model
from tests.refused import refused

ROW = np.eye(5, k=1) + np.eye(5, k=-1)
RING = np.roll(np.eye(5), 1, axis=1)
CHAIN = np.eye(5, k=-1)
STAR = np.zeros((5, 5))
STAR[1:, 0] = 1.0
MESH = np.array([[0, 1, 0, 0, 2], [1, 0, 1, 0, 0], [0, 3, 0, 1, 0], [0, 0, 1, 0, 1], [1, 0, 0, 1, 0]])


def flock(net, position=1, velocity=2):
    return linearise(NetConsensus(net, position=position, velocity=velocity), np.zeros((len(net), 1)))


def kalman_rank(net, agents, position=1, velocity=2):
    """Rank of (B, AB, …) in exact arithmetic."""
    n = len(net)
    weights = sp.Matrix(n, n, lambda i, j: Fraction(float(net[i][j])))
    laplacian = sp.diag(*[sum(weights[i, :]) for i in range(n)]) - weights
    a = sp.Matrix(sp.BlockMatrix([[sp.zeros(n), sp.eye(n)], [-position * laplacian, -velocity * laplacian]]))
    b = sp.zeros(2 * n, len(agents))
    for column, agent in enumerate(agents):
        b[n + agent, column] = 1
    powers = [b]
    for _ in range(2 * n - 1):
        powers.append(a * powers[-1])
    return sp.Matrix.hstack(*powers).rank()


@pytest.mark.slow
@pytest.mark.parametrize("net", [ROW, RING, CHAIN, STAR, MESH], ids=["row", "ring", "chain", "star", "mesh"])
def test_ranks_are_those_of_kalmans_matrix(net):
    """Jordan blocks too: followers in a chain share their poles."""
    one = flock(net)
    for size in (1, 2):
        for agents in list(combinations(range(5), size))[::2]:
            rank = kalman_rank(net, agents)
            assert controllability(one, agents).controllable is (rank == 10), agents
            assert agents_to_inform(one, size, criterion="rank").value >= rank
    best = max(kalman_rank(net, (i,)) for i in range(5))
    chosen = agents_to_inform(one, 1, criterion="rank")
    assert chosen.value == best
    assert kalman_rank(net, chosen.agents) == best


def test_a_multiple_pole_needs_as_many_inputs():
    """All agents hear all: λ = 5 of L is fourfold, so that four agents must be informed."""
    full = np.ones((5, 5)) - np.eye(5)
    three, four = (controllability(flock(full), range(k)) for k in (3, 4))
    assert not three.controllable
    assert four.controllable
    lost = {round(one.pole.real, 9): (one.independent, one.reached) for one in three.lost}
    assert set(lost.values()) == {(4, 3)}
    assert three.distance == 0.0 < four.distance
    assert agents_to_inform(flock(full), 3, criterion="rank").value == 2 + 3 * 2
    assert three.table.shape == (3, 5)


def test_the_distance_is_that_of_a_small_change():
    """Agent 1 barely hears agent 0, on which the force acts: without that link it is lost."""
    one = flock(np.array([[0.0, 1.0], [1e-3, 0.0]]))
    assert one.stiffness.toarray().tolist() == [[1.0, -1.0], [-1e-3, 1e-3]]
    reach = one.controllability([0])
    assert reach.controllable
    pace = one.second_order.pace  # K and D of the link, in units of the fastest motion
    change = np.array([[1e-3, 1e-3], [2e-3, 2e-3]]) / np.array([[pace**2], [pace]])
    assert 0.0 < reach.distance <= np.linalg.norm(change) * (1.0 + 1e-9)


def test_the_gramian_of_a_lone_agent_is_a_closed_form():
    """x'' = −k x − d x' + u: for ever W = diag(1/(2dk), 1/(2d)); its horizon's differs by e^(At) W e^(Aᵀt)."""
    law = Algorithm2(gains=Gains(c1_gamma=4.0, c2_gamma=1.0), target=StaticTarget((0.0,)))
    one = linearise(law, [[0.0]])
    pace = one.second_order.pace
    k, d = 4.0 / pace**2, 1.0 / pace
    exact = np.diag([0.5 / (d * k), 0.5 / d])
    np.testing.assert_allclose(one.controllability([0]).gramian, exact, rtol=1e-12, atol=1e-14)
    assert one.controllability([0]).least_reach == pytest.approx(min(0.5 / (d * k), 0.5 / d))
    fast = one.controllability([0], horizon=40.0).gramian
    np.testing.assert_allclose(fast, exact, rtol=1e-8, atol=1e-8)


def test_the_gramian_over_a_horizon_of_a_free_agent():
    """x'' = −x' + u in units of its rate d, T = 3d, e = e^(−T): T − 2(1 − e) + (1 − e²)/2, (1 − e)²/2, (1 − e²)/2."""
    d, end = 0.5, exp(-0.5 * 3.0)
    model = scaled_model(flock(np.array([[0.0, 0.0], [d, 0.0]]), position=0, velocity=1))
    assert model.pace == d
    found = gramians(model, 3.0, [[1]])[0]
    place = 3.0 * d - 2.0 * (1.0 - end) + 0.5 * (1.0 - end**2)
    exact = [[place, 0.5 * (1.0 - end) ** 2], [0.5 * (1.0 - end) ** 2, 0.5 * (1.0 - end**2)]]
    np.testing.assert_allclose(found[np.ix_([1, 3], [1, 3])], exact, rtol=1e-10)
    assert not found[0].any()


def test_modulo_motions_a_flock_has_a_gramian_for_ever():
    law = Algorithm2(target=StaticTarget((0.0, 0.0)))
    rest = find_equilibrium(law, lattice.hexagonal_patch(1, 7.0))
    one = linearise(law, rest)
    assert one.controllability([1, 2]).gramian.shape == (27, 27)  # the orientation is divided out
    swings = linearise(NetConsensus(ROW, position=1.0, velocity=0.0), np.zeros((5, 1)))
    with pytest.raises(Exception, match="a motion does not decay"):
        _ = swings.controllability([0]).gramian
    assert swings.controllability([0], horizon=2.0).least_reach > 0.0


@pytest.mark.parametrize("criterion", ["rank", "trace", "log det", "least reach"])
def test_the_greedy_choice_is_as_good_as_it_says(criterion):
    one = flock(MESH)
    best = agents_to_inform(one, 2, criterion=criterion)
    greedy = agents_to_inform(one, 2, criterion=criterion, most=1)
    assert best.exhaustive
    assert not greedy.exhaustive
    assert greedy.value <= best.value * (1.0 + 1e-9)
    assert greedy.value >= greedy.share * best.value * (1.0 - 1e-9)
    assert greedy.share == pytest.approx({"trace": 1.0, "least reach": 0.0}.get(criterion, 1.0 - exp(-1.0)))
    values = [agents_to_inform(one, 1, criterion=criterion).value, best.value]
    assert values == sorted(values)


test_bad_input = refused(
    (lambda: controllability(flock(ROW), [5]), r"informed = \[5\]: expected different agents from 0 to 4"),
    (lambda: controllability(flock(ROW), []), "expected numbers of agents"),
    (lambda: controllability(flock(ROW), [0], horizon=0.0), "horizon = 0"),
    (lambda: agents_to_inform(flock(ROW), 6), "count = 6: expected at most 5"),
    (lambda: agents_to_inform(flock(ROW), 1, criterion="best"), "unknown criterion 'best'"),
)
