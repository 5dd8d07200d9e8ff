"""What claims about limits share: the noise of an integrator, what is settled, strains where a flock can flex."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from flockana import Algorithm1, Gains, Tolerances, simulate
from flockana.base.scales import Scales
from flockana.theorems.asymptotics import lattice_limit, numerical_noise, rest_certificate, settled, velocities_match
from flockana.theorems.rounding import frame_error

LAW = Algorithm1()
TOLERANCES = Tolerances()


@pytest.mark.parametrize(
    ("stats", "noise"),
    [({}, 0.0), ({"rtol": 1e-6}, 10.0 * 1e-2 * 1e-6 * 3.0), ({"rtol": 1e-6, "atol": 2e-5}, 10.0 * 2e-5 / 2.0 * 3.0)],
)
def test_an_integrator_leaves_ten_absolute_tolerances(stats, noise):
    run = SimpleNamespace(stats=stats, scales=Scales(2.0, 0.5))
    assert numerical_noise(run, 3.0) == pytest.approx(noise, rel=1e-14)


@pytest.mark.parametrize(
    ("force", "mismatch", "expected"),
    [(1.0, 1.0, True), (1.01, 1.0, False), (1.0, 1.01, False), (0.0, 0.0, True)],
)
def test_settled_is_within_both_tolerances(force, mismatch, expected):
    scales = Scales(2.0, 0.5)
    state = SimpleNamespace(force=force * TOLERANCES.force, mismatch=mismatch * TOLERANCES.velocity * scales.energy)
    assert settled(state, TOLERANCES, scales) is expected


def falling(rate, until, samples=201):
    """Two agents that stand d apart, moving together, with a relative speed that falls by a rate."""
    run = simulate(
        LAW, [[0.0, 0.0], [7.0, 0.0]], np.zeros((2, 2)), (0.0, until), t_eval=np.linspace(0.0, until, samples)
    )
    p = np.zeros_like(run.p)
    p[:, 0, 1] = 0.5 * np.exp(-rate * run.t)
    p[:, 1, 1] = -p[:, 0, 1]
    return SimpleNamespace(
        t=run.t,
        p=p,
        stats=run.stats,
        scales=run.scales,
        metric=lambda name: {"normalised_velocity_mismatch": 0.5 * np.sum(p**2, axis=(1, 2)) / 2.0}[name],
    )


def test_velocities_that_fall_far_enough_match():
    run = falling(1.0, 40.0)
    claim = velocities_match(run, TOLERANCES, [], name="ii")
    assert claim.status == "verified"
    assert claim.computed == pytest.approx(0.5 * 0.25 * np.exp(-80.0), abs=1e-30)
    assert claim.witness == {"time": 40.0, "K̃ at the start": pytest.approx(0.125)}
    assert claim.stated == f"K̃ -> 0 (below {TOLERANCES.velocity:g} of the law's speed² it counts as 0)"


def test_what_counts_as_rest_has_the_noise_of_the_run_added():
    """√K̃ of 0.01 of the floor, and noise of ten times the floor: nothing is seen to die out."""
    run = falling(1.0, 40.0)
    assert rest_certificate(run, TOLERANCES).margin > 0.0
    floor = float(np.sqrt(TOLERANCES.velocity)) * run.scales.speed
    run.stats = {"rtol": 1e-8, "atol": floor * run.scales.time}
    assert not rest_certificate(run, TOLERANCES).margin > 0.0
    far = falling(1.0, 40.0)
    far.p = far.p + floor / np.finfo(float).eps
    assert frame_error(far.p) > floor
    assert not rest_certificate(far, TOLERANCES).margin > 0.0


def test_where_a_net_can_flex_the_strain_and_the_speeds_must_both_die_out():
    """A chain of three in the plane bends freely: no strict minimum; at rest with links of d it is a lattice."""
    chain = np.array([[-5.0, 5.0], [0.0, 0.0], [5.0, 5.0]]) * 7.0 / np.sqrt(50.0)
    law = Algorithm1(gains=Gains(c2_alpha=2.0))
    run = simulate(law, 1.03 * chain, [[0.0, 0.1], [0.0, -0.2], [0.0, 0.1]], (0.0, 400.0))
    settles = lattice_limit(run, [], TOLERANCES, name="i")
    assert settles.status == "verified"
    assert settles.computed < 1e-9
    assert settles.margin == pytest.approx(TOLERANCES.lattice, rel=1e-3)
    assert settles.witness["links"] == 2
    short = lattice_limit(simulate(law, 1.05 * chain, np.zeros((3, 2)), (0.0, 1e-3)), [], TOLERANCES, name="i")
    assert short.status == "inconclusive"
    assert short.computed == pytest.approx(0.05, rel=0.05)
    assert "at the end:" in short.detail
