"""What the γ-agent does, by its positions: every shipped path, paths that lie, jump, or move between samples only."""

import numpy as np
import pytest

from flockana import Algorithm2, Algorithm3, Trajectory, simulate, verify
from flockana.environment import targets
from flockana.theorems.gamma_agent_checks import consistent, declared_rate_is_true, slip, target_rests

HERE, AWAY = (3.0, 1.0), (2.0, -1.0)


def run(target, t=None):
    """A flock of one at rest, for the times given: only the γ-agent is looked at."""
    t = np.linspace(0.0, 5.0, 41) if t is None else np.asarray(t)
    q = np.zeros((t.size, 1, 2))
    return Trajectory(t, q, q, q, Algorithm2(target=target))


MOVING = [
    targets.LinearTarget(HERE, AWAY),
    targets.SineTarget(HERE, AWAY, 3.0, 0.3),
    targets.CircleTarget(HERE, 3.0, 0.3),
    targets.CallableTarget(lambda t: ((np.sin(t), 1.0), (np.cos(t), 0.0)), changes_slower_than=1.0),
]


@pytest.mark.parametrize("target", MOVING, ids=lambda target: type(target).__name__)
def test_a_path_with_its_own_velocity_is_consistent_and_moves(target):
    assert consistent(run(target)).status == "met"
    assert declared_rate_is_true(run(target)).status == "met"
    assert target_rests(run(target), any_p_r=True).status == "unmet"
    assert target_rests(run(target), any_p_r=False).status == "unmet"


def test_a_step_of_one_rounding_is_no_interval():
    """Its middle is one of its ends: the velocity seen there would be 0/0."""
    t = np.insert(np.linspace(0.0, 5.0, 41), 3, np.nextafter(0.25, 1.0))
    assert consistent(run(MOVING[3], t)).status == "met"


@pytest.mark.parametrize("target", MOVING[:3], ids=lambda target: type(target).__name__)
@pytest.mark.parametrize("factor", [0.0, 0.5, 0.999, 1.001])
def test_a_velocity_that_is_told_wrongly_is_seen_to_a_thousandth(target, factor):
    told = targets.RescaledVelocity(target, factor)
    speed = np.linalg.norm([target.rate(t) for t in np.linspace(0.0, 5.0, 400)], axis=1).max()
    found = consistent(run(told))
    assert found.status == "unmet"
    assert -found.margin == pytest.approx(abs(1.0 - factor) * speed, rel=0.05)
    assert 0.0 < found.error < -found.margin
    assert declared_rate_is_true(run(told)).status == "met"


def test_rest_and_the_velocity_that_is_told_beside_it():
    for told, status in (((0.0, 0.0), "met"), (AWAY, "unmet")):
        found = [target_rests(run(targets.StaticTarget(HERE, told)), any_p_r=some).status for some in (True, False)]
        assert found == ["met", status]
    assert target_rests(run(targets.LinearTarget(HERE, (0.0, 0.0))), any_p_r=False).status == "met"
    assert consistent(run(targets.StaticTarget(HERE, AWAY))).status == "unmet"


def test_a_function_that_was_seen_at_rest_but_for_rounding_is_assumed_to_be():
    found = target_rests(run(targets.CallableTarget(lambda t: (HERE, (0.0, 0.0)))), any_p_r=False)
    assert found.status == "assumed"
    assert "as seen at 561 times" in found.detail  # 41 samples, 40 middles and six points in each of 80 halves
    noisy = targets.CallableTarget(lambda t: ((5.0 * np.cos(t) ** 2 + 5.0 * np.sin(t) ** 2, 1.0), (0.0, 0.0)))
    assert target_rests(run(noisy), any_p_r=False).status == "assumed"


@pytest.mark.slow
def test_a_function_is_assumed_until_its_user_states_how_slowly_it_changes():
    def path(t):
        return (np.sin(t), 1.0), (np.cos(t), 0.0)

    for slow, status in ((None, "assumed"), (1.0, "met"), (1e-5, "assumed")):  # the last asks for 2e6 times
        target = targets.CallableTarget(path, changes_slower_than=slow)
        assert consistent(run(target)).status == declared_rate_is_true(run(target)).status == status
    still = targets.CallableTarget(lambda t: (HERE, AWAY), changes_slower_than=0.1)
    assert target_rests(run(still), any_p_r=True).status == "met"
    assert consistent(run(still)).status == "unmet"


def test_closed_forms_decide_where_the_samples_see_nothing():
    """Samples, and Gauss nodes of whole periods, see a circle at rest; the subclass has the name and another motion."""
    whole = np.linspace(0.0, 4.0, 5)
    circle = targets.RescaledVelocity(targets.CircleTarget(HERE, 3.0, 2.0), 0.3)
    assert target_rests(run(circle, whole), any_p_r=True).status == "unmet"
    assert consistent(run(circle, whole)).status == "unmet"
    other = type(
        "StaticTarget", (targets.StaticTarget,), {"state": lambda self, t: (np.sin(2 * np.pi * t) * np.ones(2), HERE)}
    )
    assert (other(HERE).consistent, other(HERE).constant_velocity) == (None, None)
    assert target_rests(run(other(HERE, AWAY), [0.0, 0.3, 1.0]), any_p_r=True).status == "unmet"


@pytest.mark.parametrize("between", [0.02, 0.11])
def test_a_jump_between_two_samples_is_seen(between):
    jumps = targets.CallableTarget(lambda t: ((0.0 if t < 1.0 + between else 1e-3, 0.0), (0.0, 0.0)))
    assert target_rests(run(jumps), any_p_r=False).status == "unmet"
    assert consistent(run(jumps)).status == "unmet"


def test_a_motion_that_vanishes_at_every_sample_is_seen_and_samples_too_sparse_leave_it_open():
    h = 5.0 / 40.0
    between = targets.CallableTarget(lambda t: ((np.sin(2.0 * np.pi * t / h), 0.0), (0.0, 0.0)))
    assert target_rests(run(between), any_p_r=True).status == "unmet"
    fast = targets.CallableTarget(targets.CircleTarget(HERE, 3.0, 7.3).state)
    assert consistent(run(fast, np.linspace(0.0, 5.0, 4))).status == "assumed"
    assert slip(run(MOVING[0], [1.0]), lambda t: np.zeros(2))[1] == np.inf


@pytest.mark.slow
@pytest.mark.parametrize("options", [{}, {"method": "RK4", "dt": 0.05}], ids=["adaptive", "fixed steps"])
@pytest.mark.parametrize("instants", [[0.0, 1.0, 2.0, 3.0], None], ids=["sparse", "default"])
def test_a_jump_between_samples_is_seen_at_the_solver_s_steps(instants, options):
    """The target is away for 1.2 < t < 1.3 only, and rests at all whole times."""
    jumps = targets.CallableTarget(lambda t: ((400.0 if 1.2 < t < 1.3 else 0.0, 0.0), (0.0, 0.0)))
    q = np.array([[0.0, 0.0], [6.0, 0.0], [3.0, 5.0]])
    seen = simulate(Algorithm3(target=jumps), q, 0.0 * q, (0.0, 3.0), t_eval=instants, **options)
    verdict = verify("energy", seen)
    assert {one.status for one in verdict.hypotheses if "declared rate" in one.name} == {"unmet"}
    assert verdict.claim("balance").status == "vacuous"
