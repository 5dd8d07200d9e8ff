"""Terminal states, rigid motions, curvature and the gradient flow."""

from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

from flockana import Algorithm1, Algorithm2, AlphaInteraction, Gains, StaticTarget, simulate, verify
from flockana.base.errors import SolverError
from flockana.equilibria import descent
from flockana.equilibria.curvature import least_curvature
from flockana.equilibria.final_state import rigid_motions, surroundings, terminal_state
from flockana.equilibria.gradient_flow import gradient_flow, structural_force
from flockana.lattice import classify, hexagonal_patch

LAW1 = Algorithm1()
LAW2 = Algorithm2(gains=Gains(c1_alpha=2.0, c1_gamma=0.5), target=StaticTarget((3.0, 4.0)))


@pytest.mark.parametrize(
    ("q", "count"),
    [
        ([[0.0], [1.0]], 1),
        ([[0.0, 0.0], [1.0, 0.0]], 3),
        ([[2.0, 3.0], [2.0, 3.0]], 2),  # a point does not turn
        ([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0]], 5),  # a line in space turns about two axes only
        ([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]], 6),
    ],
)
def test_rigid_motions_are_counted(q, count):
    basis = rigid_motions(np.array(q))
    assert basis.shape[1] == count
    np.testing.assert_allclose(basis.T @ basis, np.eye(count), atol=1e-12)


@pytest.mark.parametrize("m", [2, 3])
def test_rigid_motions_keep_all_distances_to_first_order(m):
    q = np.random.default_rng(0).normal(size=(6, m)) + 100.0
    step = 1e-6
    for motion in rigid_motions(q).T:
        moved = q + step * motion.reshape(q.shape)
        before = np.linalg.norm(q[:, None] - q[None], axis=2)
        after = np.linalg.norm(moved[:, None] - moved[None], axis=2)
        assert np.abs(after - before).max() < 1e-10


def test_curvature_does_not_see_rigid_motions_and_sees_a_soft_hinge():
    def curvature(q):
        return least_curvature(surroundings(LAW1, q))[0]

    assert curvature(hexagonal_patch(1, 7.0)) > 0.1
    chain = np.array([[0.0, 0.0], [7.0, 0.0], [14.0, 0.0]])
    assert abs(curvature(chain)) < 1e-12  # three in a chain bend freely
    assert curvature(0.5 * chain) < -0.1  # squeezed, the chain buckles


def test_a_terminal_state_is_measured():
    q = np.array([[0.0, 0.0], [7.7, 0.0], [0.0, 0.0]])
    p = np.array([[1.0, 0.0], [3.0, 0.0], [2.0, 0.0]])
    end = terminal_state(LAW1, q, p)
    assert (end.links, end.coincident, end.connected) == (3, 1, True)
    assert (end.shortest, end.longest, end.strain) == (0.0, 7.7, 1.0)
    assert end.mismatch == pytest.approx(1.0 / 3.0)
    alpha = LAW1.alpha
    stress = alpha.phi_alpha(alpha.sigma_norm(7.7)) * 7.7 / np.sqrt(1.0 + 0.1 * 7.7**2)
    assert end.force == pytest.approx(2.0 * stress / alpha.strength, rel=1e-12)


def test_without_links_there_is_no_strain():
    end = terminal_state(LAW1, np.array([[0.0], [100.0]]), np.zeros((2, 1)))
    assert np.isnan(end.strain)
    assert (end.links, end.connected, end.force) == (0, False, 0.0)
    assert classify(end.strain, lattice=1e-6, quasi=0.1) == "neither"


@pytest.mark.parametrize("law", [LAW1, LAW2])
def test_the_structural_force_is_minus_the_gradient_of_the_structural_energy(law):
    q = np.random.default_rng(1).uniform(0.0, 14.0, (5, 2))
    force, step = structural_force(law, q), 1e-5
    for i in range(5):
        for k in range(2):
            nudge = np.zeros_like(q)
            nudge[i, k] = step
            slope = (law.structural_energy(q + nudge, 0 * q) - law.structural_energy(q - nudge, 0 * q)) / (2.0 * step)
            assert force[i, k] == pytest.approx(-slope, abs=1e-7)


class TestGradientFlow:
    def test_it_goes_downhill_to_an_equilibrium(self):
        q0 = np.random.default_rng(4).uniform(0.0, 14.0, (6, 2))
        limit = gradient_flow(LAW1, q0)
        assert limit.converged
        assert limit.force <= 1e-11
        assert LAW1.energy(0.0, limit.q, 0 * q0) < LAW1.energy(0.0, q0, 0 * q0)

    def test_it_keeps_the_centre_and_the_symmetry(self):
        q0 = np.array([[-3.0, 0.0], [3.0, 0.0]]) + 5.0
        limit = gradient_flow(LAW1, q0)
        np.testing.assert_allclose(limit.q.mean(axis=0), 5.0, atol=1e-9)
        np.testing.assert_allclose(limit.q[:, 0], [1.5, 8.5], atol=1e-9)

    def test_it_stays_in_the_basin_where_it_starts(self):
        """Two agents out of range attract nobody: no long step may bring them together."""
        q0 = np.array([[0.0], [9.0]])
        np.testing.assert_allclose(gradient_flow(LAW1, q0).q, q0)

    def test_it_is_told_the_slope_of_its_force(self, monkeypatch):
        """661 forces are asked for; with slopes by differences 997, with none 1742, with the wrong sign 4228."""
        asked, own = [], structural_force
        monkeypatch.setattr(
            "flockana.equilibria.gradient_flow.structural_force", lambda law, q: asked.append(q) or own(law, q)
        )
        assert gradient_flow(LAW1, np.random.default_rng(3).uniform(0.0, 20.0, (12, 2))).converged
        assert len(asked) < 850

    def test_where_the_force_overflows_it_says_so(self):
        law = Algorithm2(gains=Gains(c1_gamma=1e10), target=StaticTarget((0.0, 0.0)))
        with pytest.raises(SolverError, match=r"the force is not finite, with coordinates up to 1e\+300: start nearer"):
            gradient_flow(law, [[0.0, 0.0], [1e300, 0.0]])

    def test_a_flow_without_end_ends(self, monkeypatch):
        whole = gradient_flow(LAW1, [[0.0], [6.0]])
        monkeypatch.setattr("flockana.equilibria.gradient_flow._MOST_STEPS", 2)
        limit = gradient_flow(LAW1, [[0.0], [6.0]])
        assert not limit.converged
        assert 0.0 < limit.time < whole.time
        assert limit.force > 1e-6

    def test_threads_may_flow_at_once(self):
        starts = [np.random.default_rng(k).uniform(0.0, 14.0, (6, 2)) for k in range(4)]
        with ThreadPoolExecutor(4) as threads:
            together = list(threads.map(lambda q0: gradient_flow(LAW1, q0).q, starts))
        for q0, q in zip(starts, together, strict=True):
            np.testing.assert_array_equal(q, gradient_flow(LAW1, q0).q)

    def test_a_weak_bond_near_the_range_is_followed_to_its_end(self):
        """At 8.39 of 8.4 the pull is a hundred-thousandth of its greatest; the limit is still the distance d."""
        limit = gradient_flow(LAW1, [[0.0], [8.39]])
        assert limit.q[1, 0] - limit.q[0, 0] == pytest.approx(7.0, abs=1e-8)

    def test_a_short_horizon_is_said_not_to_have_converged(self):
        limit = gradient_flow(Algorithm1(AlphaInteraction(a=1e-3, b=1e-3)), [[0.0], [8.39]], horizon=1e-3)
        assert not limit.converged


def test_the_search_beside_a_last_state_is_short(monkeypatch):
    """Six agents fall onto each other for ever (k log s): 300,000 steps downhill, several times, took minutes."""
    counts = []
    monkeypatch.setattr(descent, "relax", lambda potential, q, steps, **_: counts.append(steps) or q)
    run = simulate(Algorithm1(), [[0.0, 0.0], [8.0, 0.0]], np.zeros((2, 2)), (0.0, 1.0))
    verify("linearised-decay-terminal", run)
    assert 0 < max(counts) <= 10_000
