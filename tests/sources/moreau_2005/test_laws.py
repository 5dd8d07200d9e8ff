"""Averages over nets in turn: schedules, steps and limits against products of matrices."""

import numpy as np
import pytest

import flockana as fl
from flockana import NetAveraging
from flockana.sources.moreau_2005.theorems import HALVES
from tests.refused import refused

TURNS = NetAveraging(HALVES, lengths=(2, 1, 2, 1), growth=(1, 0, 1, 0))
LINE = np.array([[0.0], [0.0], [1.0]])


def test_nets_act_in_turn_for_lengths_that_grow():
    expected = [0, 0, 1, 2, 2, 3, 0, 0, 0, 1, 2, 2, 2, 3, *[0] * 4, 1, *[2] * 4, 3]
    assert [TURNS.net_at(step) for step in range(len(expected))] == expected
    plain = NetAveraging(HALVES, lengths=(3, 1, 1, 2))
    assert [plain.net_at(step) for step in range(700, 707)] == [0, 0, 0, 1, 2, 3, 3]


def test_a_run_is_the_product_of_its_nets():
    law = NetAveraging(np.random.default_rng(0).dirichlet(np.ones(4), (3, 4)), lengths=(1, 2, 1), dt=0.5)
    q = np.random.default_rng(1).normal(size=(4, 2))
    run = fl.simulate(law, q, 0.0 * q, (0.0, 5.0))
    product = np.eye(4)
    for step in range(10):
        product = np.array(law.nets[law.net_at(step)]) @ product
    np.testing.assert_allclose(run.q[-1], product @ q, atol=1e-14)
    np.testing.assert_allclose(run.p[-1], (run.q[-1] - run.q[-2]) / 0.5, atol=1e-14)
    assert run.metric("spread")[-1] == pytest.approx(np.ptp(run.q[-1], axis=0).max(), rel=1e-12)


def test_rounds_that_grow_keep_the_product_of_what_each_keeps():
    """Agent 1 begins at the end: the first half of a round keeps all, then each keeps 1 − 2⁻ᴸ⁻¹, and so on."""
    run = fl.simulate(TURNS, LINE, 0.0 * LINE, (0.0, 400.0))
    q = LINE[:, 0].copy()
    for length in range(2, 21):
        for end in (0, 2):
            for _ in range(length):
                q[1] = 0.5 * (q[1] + q[end])
            q[end] = 0.5 * (q[1] + q[end])
    apart = float(run.q[-1, 2, 0] - run.q[-1, 0, 0])
    assert apart == pytest.approx(q[2] - q[0], abs=1e-5)
    assert apart > 0.5
    assert fl.verify("growing-windows", run).status == "verified"


def test_poles_of_a_net_that_stays_are_its_eigenvalues():
    """Of a directed ring of three in halves: ½(1 + e^(2πik/3)), and as many zeros, of the velocities."""
    ring = 0.5 * (np.eye(3) + np.roll(np.eye(3), 1, axis=1))
    found = fl.linearise(NetAveraging(ring), np.zeros((3, 1)))
    expected = 0.5 * (1.0 + np.exp(2j * np.pi * np.arange(3) / 3.0))
    for value in expected:
        assert np.abs(found.multipliers - value).min() < 1e-8
    assert found.stable


def test_a_leader_is_where_all_come_to():
    run = fl.scenario("averaging-leader").run()
    np.testing.assert_allclose(run.q[-1], run.q[0, [0] * 4], atol=1e-5)


def test_a_net_that_acts_ever_longer_must_have_a_root_by_itself():
    leads = [[[1.0, 0.0], [0.5, 0.5]], np.eye(2)]
    for growth, status in (((1, 0), "verified"), ((0, 1), "vacuous")):
        law = NetAveraging(leads, growth=growth)
        run = fl.simulate(law, LINE[1:], 0.0 * LINE[1:], (0.0, 20.0))
        assert fl.verify("rooted-averaging", run).claim("agreement").status == status


test_bad_input = refused(
    (lambda: NetAveraging([[1.0, 0.0]]), r"nets has shape \(1, 1, 2\): expected square arrays of weights"),
    (
        lambda: NetAveraging([[0.5, 0.4], [0.0, 1.0]]),
        r"row 0 of nets\[0\] sums to 0.9: expected 1; divide it by its sum",
    ),
    (lambda: NetAveraging([[1.5, -0.5], [0.0, 1.0]]), r"nets\[0\]\[0, 1\] = -0.5: expected"),
    (lambda: NetAveraging(np.eye(2), lengths=(1, 2)), "expected 1 whole numbers >= 1, one for each net"),
    (lambda: NetAveraging(np.eye(2), growth=(-1,)), "expected 1 whole numbers >= 0, one for each net"),
    (
        lambda: fl.simulate(NetAveraging(np.eye(2)), LINE, 0.0 * LINE, (0, 2)),
        "nets are of 2 agents and the state is of 3",
    ),
    (lambda: fl.simulate(NetAveraging(np.eye(3)), LINE, LINE, (0, 2)), r"agent 2 starts at \[1.0\]: expected p0 = 0"),
)
