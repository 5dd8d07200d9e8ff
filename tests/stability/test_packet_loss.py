"""Largest packet losses in mean square, against scalar closed forms and the mean square of many runs."""

import numpy as np
import pytest
from scipy.sparse import csr_array

from flockana import Algorithm2, Linearisation, StaticTarget, find_equilibrium, linearise
from flockana.base.errors import ArgumentError
from flockana.lattice import hexagonal_patch
from flockana.stability.packet_loss import _step, loss_margin

LAW = Algorithm2(target=StaticTarget((0.0,)))


def net(k, d):
    n = len(k)
    a = np.block([[np.zeros((n, n)), np.eye(n)], [-np.asarray(k), -np.asarray(d)]])
    places, links = np.arange(n, dtype=float)[:, None], np.zeros((0, 2), dtype=np.int32)
    return Linearisation(LAW, places, 0.0 * places, 0.0, 0.0, links, csr_array(a), 1e-12)


@pytest.mark.parametrize("gain", [0.5, 1.5, 1.9])
def test_an_unforced_integrator_bears_any_loss_of_a_stable_gain(gain):
    """v⁺ = (1 − θ g) v: E = p + (1 − p)(1 − g)² < 1 for every p < 1 iff |1 − g| < 1."""
    assert loss_margin(net([[0.0]], [[gain]]), 1.0).loss == 1.0
    assert loss_margin(net([[0.0]], [[gain]]), 1.0).radius == pytest.approx((1.0 - gain) ** 2)


def test_the_margin_is_where_the_mean_of_both_patterns_has_radius_one():
    """A mass on a spring and a damper, its input lost now and then."""
    flock = net([[1.0]], [[1.0]])
    found = loss_margin(flock, 0.8, lost="all")
    step = _step(flock, 0.8, "all", "zero")

    def radius(p):
        good = step.lost + step.heard[0]
        return np.abs(np.linalg.eigvals(p * np.kron(step.lost, step.lost) + (1.0 - p) * np.kron(good, good))).max()

    assert radius(0.999 * found.loss) < 1.0
    assert found.loss == 1.0 or radius(1.001 * found.loss) > 1.0


@pytest.mark.parametrize("lost", ["all", "agent", "link"])
@pytest.mark.parametrize("on_loss", ["zero", "hold"])
def test_the_expectation_is_that_of_all_patterns_of_losses(lost, on_loss):
    """Of two agents: the mean of A ⊗ A over the patterns, with their probabilities."""
    flock, p = net([[2.0, -1.0], [-0.5, 1.0]], [[1.5, -0.5], [0.0, 1.0]]), 0.3
    step = _step(flock, 0.4, lost, on_loss)
    patterns = [(0,), (1,)] if lost == "all" else [(a, b) for a in (0, 1) for b in (0, 1)]
    assert len(step.heard) == len(patterns[0])
    total = 0.0
    for pattern in patterns:
        a = step.lost + sum(theta * x for theta, x in zip(pattern, step.heard, strict=True))
        weight = np.prod([1.0 - p if theta else p for theta in pattern])
        total = total + weight * np.kron(a, a)
    assert step.radius(p) == pytest.approx(np.abs(np.linalg.eigvals(total)).max(), rel=1e-9)
    k, d = flock.stiffness.toarray(), flock.damping.toarray()
    one, h = np.eye(2), 0.4
    whole = np.block([[one, h * one], [0 * one, one]]) - np.vstack([0.5 * h * h * one, h * one]) @ np.hstack([k, d])
    assert step.radius(0.0) == pytest.approx(np.abs(np.linalg.eigvals(whole)).max() ** 2, rel=1e-9)


def test_links_between_velocities_that_are_lost_one_by_one():
    """v_i⁺ = v_i + θ_i g (v_j − v_i): w = v_1 − v_2 gets 1 − g (θ_1 + θ_2), and its mean square is below 1 iff

    p² + 2 p (1 − p) (1 − g)² + (1 − p)² (1 − 2 g)² < 1."""
    g = 1.05
    flock = net(np.zeros((2, 2)), [[g, -g], [-g, g]])
    p = loss_margin(flock, 1.0, lost="link").loss
    at_zero = (1.0 - 2.0 * g) ** 2
    assert loss_margin(flock, 1.0, lost="link").radius == pytest.approx(at_zero)
    assert p == 0.0  # without any loss it overshoots
    step = _step(flock, 1.0, "link", "zero")
    for loss in (0.1, 0.5, 0.9):
        mean = loss**2 + 2 * loss * (1 - loss) * (1 - g) ** 2 + (1 - loss) ** 2 * at_zero
        assert step.radius(loss) == pytest.approx(mean, rel=1e-12)


def test_what_an_agent_does_by_itself_is_not_lost_with_a_link():
    """The pull to its own place stays; a link that is pressed together is refused."""
    flock = net([[3.0, -1.0], [0.0, 2.0]], [[3.0, -1.0], [0.0, 2.0]])
    step = _step(flock, 0.2, "link", "zero")
    assert len(step.heard) == 1  # agent 1 hears no one
    alone = _step(net(np.diag([2.0, 2.0]), np.diag([2.0, 2.0])), 0.2, "all", "zero")
    assert np.sort(np.abs(np.linalg.eigvals(step.lost))) == pytest.approx(
        np.sort(np.abs(np.linalg.eigvals(alone.lost + alone.heard[0])))
    )
    law = Algorithm2(target=StaticTarget((0.0, 0.0)))
    pressed = find_equilibrium(law, hexagonal_patch(1, 7.0))
    with pytest.raises(ArgumentError, match=r"the link from agent \d to \d carries a force at this equilibrium"):
        loss_margin(linearise(law, pressed), 0.01, lost="link")


def test_held_inputs_harm_where_zeroed_ones_do_not():
    zeroed, held = (loss_margin(net([[1.0]], [[1.0]]), 1.0, on_loss=way).loss for way in ("zero", "hold"))
    assert 0.0 < held < zeroed


def test_many_states_are_refused_and_an_iteration_agrees_with_the_whole():
    with pytest.raises(ArgumentError, match="the flock has 42 states: expected at most 40"):
        loss_margin(net(np.eye(21), np.eye(21)), 0.1)
    with pytest.raises(ArgumentError, match="what is lost"):
        loss_margin(net([[1.0]], [[1.0]]), 0.1, lost="pair")
    rng = np.random.default_rng(0)
    k = np.diag(rng.uniform(2.0, 3.0, 7)) - rng.uniform(0.0, 0.2, (7, 7))
    step = _step(net(k, k), 0.1, "agent", "zero")
    mean = step.lost + 0.7 * sum(step.heard)
    whole = np.kron(mean, mean) + 0.21 * sum(np.kron(x, x) for x in step.heard)
    assert step.radius(0.3) == pytest.approx(np.abs(np.linalg.eigvals(whole)).max(), rel=1e-7)
