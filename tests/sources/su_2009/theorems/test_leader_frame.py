"""Runs as their leader sees them, and what of them dies out, on motions by hand."""

import numpy as np
import pytest

from flockana import Algorithm2, AlphaInteraction, CircleTarget, Gains, LinearTarget, StaticTarget, compose
from flockana.sources.su_2009.theorems.leader_frame import as_the_leader_sees, comes_to_rest, gains_of, some_informed
from flockana.theorems.theorem_toolkit import Certificate, Observed
from tests.theorems.made_up import made_up

T = np.linspace(0.0, 40.0, 401)


def seen_by_leader(run):
    return as_the_leader_sees(Observed.alone(run)).run


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
    seen = seen_by_leader(made_up(law(1.0, 2.0, target), q, p, t=[2.0, 3.0, 5.0], u=7.0 * q))
    assert seen.q[:, 0].tolist() == [[-4.0, 1.0], [-5.0, 0.5], [-7.0, -0.5]]
    assert seen.p[:, 1].tolist() == [[3.0, 3.5]] * 3
    assert seen.u.tolist() == (7.0 * q).tolist()
    assert seen.t.tolist() == [2.0, 3.0, 5.0]
    assert seen.law.target == StaticTarget((0.0, 0.0))
    assert [x.tolist() for x in gains_of(seen)] == [[1.0, 1.0], [2.0, 2.0]]


@pytest.mark.parametrize("feedforward", [True, False])
def test_of_a_leader_on_a_circle_its_acceleration_is_taken_off_if_all_are_told(feedforward):
    """R (cos ωt, sin ωt): at t = 0 at R along x, with R ω along y, and −R ω² along x."""
    radius, omega = 9.0, 0.05
    circle = CircleTarget((0.0, 0.0), radius, omega / (2.0 * np.pi))
    own = compose(pair=AlphaInteraction(), consensus=9.0, navigation=circle, feedforward=feedforward)
    seen = seen_by_leader(made_up(own, np.zeros((1, 2, 2)), t=[0.0]))
    assert seen.q[0] == pytest.approx(np.tile([-radius, 0.0], (2, 1)), abs=1e-12)
    assert seen.p[0] == pytest.approx(np.tile([0.0, -radius * omega], (2, 1)), abs=1e-12)
    assert seen.u[0] == pytest.approx(np.tile([radius * omega**2 if feedforward else 0.0, 0.0], (2, 1)), abs=1e-12)


def dying(speeds, who, **options):
    """The claim of agents on their own lines, at speeds by agent and instant."""
    p = np.zeros((len(T), len(speeds), 2))
    p[:, :, 0] = np.transpose(speeds)
    run = made_up(law(1.0, 2.0), np.zeros_like(p), p, t=T)
    return comes_to_rest(Observed.alone(run), np.array(who), [], "velocities", **options)


def test_velocities_that_decay_are_evidence_and_those_of_others_do_not_count():
    decays, stays = 3.0 * np.exp(-T), np.ones_like(T)
    claim = dying([decays, stays], [True, False])
    assert (claim.status, claim.about) == ("inconclusive", "limit")
    assert "the largest difference falls by a factor of 1.6e+15" in claim.detail
    assert claim.computed == pytest.approx(3.0 * np.exp(-40.0), rel=1e-9, abs=0.0)
    assert claim.witness == {"time": 40.0, "agents": 1}
    both = dying([decays, stays], [True, True])
    assert (both.status, both.computed) == ("inconclusive", 1.0)
    assert "the largest difference falls by a factor of 3" in both.detail
    assert "the largest difference does not fall" in dying([stays], [True]).detail
    assert dying([decays, 0.5 * decays], [True, True]).computed == pytest.approx(claim.computed, rel=1e-12, abs=0.0)


def test_a_certificate_or_a_proof_decides_whatever_the_run_shows():
    stays = np.ones_like(T)
    assert dying([stays], [True], proof="matched-velocities").status == "verified"
    assert dying([stays], [True], certificates=[Certificate(0.5, "a basin")]).status == "verified"
    assert dying([stays], [True], certificates=[Certificate(-0.5, "no basin")]).status == "inconclusive"
