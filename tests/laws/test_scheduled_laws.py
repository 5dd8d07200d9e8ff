"""Laws in turn: runs against products of exponentials, where steps end, and what is refused."""

import numpy as np
import pytest
from scipy.linalg import expm

import flockana as fl
from flockana.theorems.run_consistency import ensure_fits
from tests.refused import refused

LENGTHS = (0.7, 1.3, 0.4)
NETS = [fl.AverageConsensus(w) for w in np.random.default_rng(1).integers(0, 3, (3, 4, 4)) * (1.0 - np.eye(4))]
LAW = fl.VelocityInTurn(NETS, LENGTHS)
PUSHED = fl.InTurn([fl.NetConsensus(net.weights, 1.0, 2.0) for net in NETS], LENGTHS, since=-0.5)
Q, P = np.random.default_rng(2).normal(size=(2, 4, 1))
SWITCHES = np.array([0.7, 2.0, 2.4, 3.1, 4.4, 4.8, 5.5])


def exact(matrices, x, times):
    """The motion through turns that end at some times."""
    for k, length in enumerate(np.diff([0.0, *times])):
        x = expm(length * matrices[k % 3]) @ x
    return x


@pytest.mark.parametrize(("method", "dt"), [("DOP853", None), ("Radau", None), ("BDF", None), ("RK4", 0.02)])
def test_runs_are_products_of_exponentials_and_land_on_the_switches(method, dt):
    run = fl.simulate(LAW, Q, None, (0.0, 6.0), method=method, dt=dt)
    np.testing.assert_allclose(run.q[-1], exact([-net.laplacian for net in NETS], Q, [*SWITCHES, 6.0]), atol=2e-8)
    assert np.isin(SWITCHES.round(12), run.t.round(12)).all()
    ensure_fits(run)  # its velocity at a switch is the earlier net's, just after it the later one's
    k = int(np.argmin(abs(run.t - 0.7)))
    np.testing.assert_allclose(run.p[k], -NETS[0].laplacian @ run.q[k], atol=1e-14)
    np.testing.assert_allclose(run.p[k + 1], -NETS[1].laplacian @ run.q[k], atol=1e-13)


@pytest.mark.parametrize(("method", "dt", "error"), [("DOP853", None, 2e-8), ("RK4", 0.02, 1e-6)])
def test_laws_of_second_order_too(method, dt, error, tmp_path):
    run = fl.simulate(PUSHED, Q, P, (0.0, 6.0), method=method, dt=dt)
    zero, one = np.zeros((4, 4)), np.eye(4)
    matrices = [np.block([[zero, one], [-net.laplacian, -2.0 * net.laplacian]]) for net in NETS]
    end = exact(matrices, np.vstack([Q, P]), [*(SWITCHES[SWITCHES > 0.5] - 0.5), 6.0])  # the first ends at 0.2
    np.testing.assert_allclose(np.vstack([run.q[-1], run.p[-1]]), end, atol=error)
    if dt:  # the order is kept
        half = fl.simulate(PUSHED, Q, P, (0.0, 6.0), method=method, dt=dt / 2.0)
        assert abs(half.q[-1] - end[:4]).max() * 12.0 < abs(run.q[-1] - end[:4]).max()
    run.save(tmp_path / "turns.nc")
    again = fl.Trajectory.load(tmp_path / "turns.nc")
    ensure_fits(again)
    assert (again.law, again.law.switches(0.0, 2.0).tolist()) == (PUSHED, PUSHED.switches(0.0, 2.0).tolist())


def test_a_run_may_begin_at_a_switch_and_a_last_turn_may_last():
    late = fl.simulate(LAW, Q, None, (0.7, 2.0))
    np.testing.assert_allclose(late.q[-1], expm(-1.3 * NETS[1].laplacian) @ Q, atol=1e-8)
    once = fl.InTurn(PUSHED.laws, (1.0, 2.0, np.inf))
    assert once.switches(0.0, 1e6).tolist() == [1.0, 3.0]
    assert once.acting(1e9) is once.laws[2]
    slow = fl.rescale(PUSHED, time=2.0)
    assert (slow.lengths, slow.since, slow.laws[0].velocity) == ((1.4, 2.6, 0.8), -1.0, 1.0)


def test_the_rate_is_the_least_of_all_nets_and_an_uneven_one_is_named():
    ring = np.roll(np.eye(3), 1, axis=1)  # λ₂ of (L + Lᵀ)/2 is 3/2, of the second net 6
    law = fl.VelocityInTurn([fl.AverageConsensus(4.0 * ring.T), fl.AverageConsensus(ring)], (0.5, 0.25))
    verdict = fl.verify("average-switching", fl.simulate(law, Q[:3], None, (0.0, 3.0)))
    assert verdict.status == "verified"
    assert "λ₂ = 1.5;" in verdict.claim("decay").detail.replace("λ₂ of (L + Lᵀ)/2", "λ₂")
    uneven = fl.VelocityInTurn([law.laws[1], fl.AverageConsensus(ring + np.eye(3, k=1))], (1.0, 1.0))
    row = fl.applicable(uneven, Q[:3]).set_index("claim").loc["average"]
    assert (row.status, row.need.split(": ")[0]) == ("unmet", "every net is balanced")
    assert "net 1" in row.need


test_what_is_refused = refused(
    (lambda: fl.InTurn(NETS, LENGTHS), r"laws\[0\] is of type AverageConsensus: expected a Law without"),
    (lambda: fl.InTurn([fl.Delayed(PUSHED.laws[0], 0.1)], [1.0]), r"laws\[0\] is of type Delayed"),
    (lambda: fl.VelocityInTurn([LAW], [1.0]), r"laws\[0\] is of type VelocityInTurn"),
    (lambda: fl.VelocityInTurn(NETS, [1.0, np.inf, 2.0]), "lengths = .*: expected 3 times > 0"),
    (lambda: fl.VelocityInTurn([], []), "expected 0 times > 0"),
    (lambda: fl.RK4(PUSHED, 0.1), "steps of exactly dt would lead over its switches"),
    (lambda: fl.simulate(fl.Delayed(LAW, 0.1), Q, None, (0.0, 1.0), dt=0.1), "and no delay or clock around it"),
    (lambda: fl.VelocityInTurn(NETS, [1e-12] * 3).switches(0.0, 1e6), "the times of switches"),
)
