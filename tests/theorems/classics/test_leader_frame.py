"""Runs as their leader sees them, and what of them dies out, on motions by hand."""

from __future__ import annotations

import numpy as np
import pytest

from flockana import CircleTarget, LinearTarget, StaticTarget, compose
from flockana.interactions import AlphaInteraction, Gains
from flockana.laws.olfati_saber import Algorithm2
from flockana.theorems import Tolerances
from flockana.theorems.classics.leader_frame import as_the_leader_sees, comes_to_rest, gains_of, some_informed
from tests.theorems.made_up import made_up

T = np.linspace(0.0, 40.0, 401)


def law(pull, match, target=None):
    return Algorithm2(gains=Gains(c1_gamma=pull, c2_gamma=match), target=target or StaticTarget((0.0, 0.0)))


@pytest.mark.parametrize(
    ("pull", "match", "alike", "informed"),
    [
        ((1.0, 1.0, 0.0), (2.0, 2.0, 0.0), True, 2),
        (1.0, 2.0, True, 3),
        ((1.0, 1.5, 0.0), (2.0, 2.0, 0.0), False, 2),  # two c1
        ((1.0, 1.0, 0.0), (2.0, 2.5, 0.0), False, 2),  # two c2
        ((1.0, 1.5, 0.0), (2.0, 2.5, 0.0), False, 2),  # two of both
        ((1.0, 1.0, 0.0), (2.0, 2.0, 2.0), False, 2),  # one that matches and is not pulled
        ((1.0, 1.0, 0.0), (2.0, 0.0, 0.0), False, 2),  # one that is pulled and does not match
        (0.0, 0.0, False, 0),
    ],
)
def test_the_informed_are_alike_and_the_others_feel_nothing(pull, match, alike, informed):
    run = made_up(law(pull, match), np.zeros((1, 3, 2)))
    found = some_informed(run)
    assert found.status == ("met" if alike else "unmet")
    assert found.detail == f"{informed} of 3 agents are informed"
    assert [x.shape for x in gains_of(run)] == [(3,), (3,)]


def test_positions_and_velocities_are_less_those_of_the_leader():
    target = LinearTarget((3.0, -1.0), (1.0, 0.5))
    q, p = np.ones((3, 2, 2)), np.full((3, 2, 2), 4.0)
    seen = as_the_leader_sees(made_up(law(1.0, 2.0, target), q, p, t=[2.0, 3.0, 5.0], u=7.0 * q))
    assert seen.q[:, 0].tolist() == [[-4.0, 1.0], [-5.0, 0.5], [-7.0, -0.5]]
    assert seen.p[:, 1].tolist() == [[3.0, 3.5]] * 3
    assert seen.u.tolist() == (7.0 * q).tolist()
    assert seen.t.tolist() == [2.0, 3.0, 5.0]
    assert seen.law.target == StaticTarget((0.0, 0.0))
    assert [x.tolist() for x in gains_of(seen)] == [[1.0, 1.0], [2.0, 2.0]]


@pytest.mark.parametrize("told", [True, False])
def test_of_a_leader_on_a_circle_its_acceleration_is_taken_off_if_all_are_told(told):
    """R (cos ωt, sin ωt): at t = 0 at R along x, with R ω along y, and −R ω² along x."""
    radius, omega = 9.0, 0.05
    own = compose(
        pair=AlphaInteraction(),
        consensus=9.0,
        navigation=CircleTarget((0.0, 0.0), radius, omega / (2.0 * np.pi)),
        told=told,
    )
    seen = as_the_leader_sees(made_up(own, np.zeros((1, 2, 2)), t=[0.0]))
    assert seen.q[0] == pytest.approx(np.tile([-radius, 0.0], (2, 1)), abs=1e-12)
    assert seen.p[0] == pytest.approx(np.tile([0.0, -radius * omega], (2, 1)), abs=1e-12)
    assert seen.u[0] == pytest.approx(np.tile([radius * omega**2 if told else 0.0, 0.0], (2, 1)), abs=1e-12)


def dying(speeds, who):
    """The claim of agents on their own lines, at speeds by agent and instant."""
    p = np.zeros((len(T), len(speeds), 2))
    p[:, :, 0] = np.transpose(speeds)
    run = made_up(law(1.0, 2.0), np.zeros_like(p), p, t=T)
    return comes_to_rest(run, np.array(who), [], Tolerances(), "velocities")


def test_velocities_that_decay_come_to_rest_and_those_of_others_do_not_count():
    decays, stays = 3.0 * np.exp(-T), np.ones_like(T)
    claim = dying([decays, stays], [True, False])
    assert claim.status == "verified"
    assert claim.computed == pytest.approx(3.0 * np.exp(-40.0), rel=1e-9, abs=0.0)
    assert claim.witness == {"time": 40.0, "agents": 1}
    assert dying([decays, stays], [True, True]).status == "inconclusive"
    assert dying([decays, stays], [True, True]).computed == 1.0
    assert dying([decays, 0.5 * decays], [True, True]).computed == pytest.approx(claim.computed, rel=1e-12, abs=0.0)


def test_what_is_still_above_what_counts_as_0_is_not_at_rest():
    """√K̃ of the tolerance, in units of the law's speed."""
    scale = law(1.0, 2.0).scales.speed * np.sqrt(Tolerances().velocity)
    for share, status in ((0.3, "verified"), (3.0, "inconclusive")):
        slow = scale * np.maximum(share, 1e6 * np.exp(-T))
        assert dying([slow], [True]).status == status


def test_far_from_rest_of_the_frame_rounding_is_all_that_is_left():
    """Of agents that are not asked about: 4 ε of the fastest are added to every speed."""
    scale = law(1.0, 2.0).scales.speed * np.sqrt(Tolerances().velocity)
    eps = np.finfo(float).eps
    decays = 1e6 * scale * np.exp(-T)
    for fastest, status in ((0.1, "verified"), (10.0, "inconclusive")):
        fast = np.full_like(T, fastest * scale / (4.0 * eps))
        assert dying([decays, fast], [True, False]).status == status
