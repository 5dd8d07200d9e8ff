"""Spectra of nets that are not strongly connected, and zero modes beside stiff links: closed forms and mpmath."""

from math import cos, pi, sin, sqrt

import mpmath
import numpy as np
import pytest
from scipy.sparse import csr_array

from flockana import Algorithm2, Gains, MinimalFlocking, StaticTarget, find_equilibrium, linearise, slowest_modes
from flockana.stability.modes import SecondOrder
from flockana.stability.strong_components import strong_components
from flockana.stability.zero_modes import kernel_of, zero_threshold

ROOT = complex(-0.5, 0.5 * sqrt(3.0))  # of s² + s + 1


def chain(n, angle=0.0):
    """A row of n agents, each of which keeps its distance from the one before (issue S2)."""
    law = MinimalFlocking(radius=2.0, spacing=1.0, edges=tuple((k, k + 1) for k in range(n - 1)))
    return linearise(law, np.arange(n)[:, None] * [cos(angle), sin(angle)])


@pytest.mark.parametrize(("n", "angle"), [(5, 0.0), (13, 0.0), (13, 0.7), (40, 0.3)])
def test_equal_blocks_of_a_chain_do_not_smear(n, angle):
    """Each follower adds (s² + s)(s² + s + 1); the leader moves freely."""
    flock = chain(n, angle)
    expected = np.concatenate([np.zeros(4 + n - 1), np.full(n - 1, -1.0), np.repeat([ROOT, ROOT.conjugate()], n - 1)])
    distance = np.abs(np.sort_complex(flock.eigenvalues.round(9)) - np.sort_complex(expected.round(9)))
    assert distance.max() < 1e-8
    assert flock.decay_rate == pytest.approx(0.5, abs=1e-13)
    assert flock.spectral_abscissa == -flock.decay_rate
    assert flock.stable
    assert all(mode.error < 1e-13 for mode in flock.modes)
    assert len(flock.zero_modes) == 2 + n - 1
    assert flock.second_order.invariant.chains == 2


def test_modes_of_a_tree_with_a_cycle_solve_the_quadratic_problem():
    """Masses on springs and dampers: a directed cycle of three leads a tree whose poles are all different."""
    rng = np.random.default_rng(1)
    n = 9
    heard = {0: [1], 1: [2], 2: [0], 3: [0], 4: [3, 1], 5: [4], 6: [2], 7: [6, 5], 8: [3]}
    k, d = np.zeros((n, n)), np.zeros((n, n))
    for i, sources in heard.items():
        for j in sources:
            k[i, j], d[i, j] = -rng.uniform(0.5, 2.0), -rng.uniform(0.5, 2.0)
    k, d = (x - np.diag(x.sum(axis=1)) for x in (k, d))
    problem = SecondOrder(np.zeros((n, 1)), csr_array(k), csr_array(d))
    assert len(problem.parts) == 7
    assert problem.invariant.chains == 1  # they keep their velocity
    np.testing.assert_allclose(np.abs(problem.invariant.kernel), 1.0 / 3.0, rtol=1e-12)
    whole = np.linalg.eigvals(np.block([[np.zeros((n, n)), np.eye(n)], [-k, -d]]))
    assert np.sum(problem.eigenvalues == 0.0) == 2
    for value in problem.eigenvalues:
        assert np.abs(whole - value).min() < 1e-6
    for mode in problem.modes:
        v = mode.shape.ravel()
        assert np.linalg.norm(v) == pytest.approx(1.0)
        assert np.abs(mode.eigenvalue**2 * v + mode.eigenvalue * (d @ v) + k @ v).max() < 1e-12
    assert len(problem.modes) == (2 * n - 2) - sum(mode.frequency > 0.0 for mode in problem.modes)


@pytest.mark.slow
def test_shapes_of_equal_followers_are_that_of_the_last():
    """A defective pole has one shape; 60 equal answers in a row grow beyond all numbers."""
    for n in (4, 60):
        k = np.eye(n) - np.eye(n, k=-1)
        problem = SecondOrder(np.zeros((n, 1)), csr_array(k), csr_array(2.0 * k))
        for mode in problem.modes:
            assert mode.eigenvalue == -1.0
            assert abs(mode.shape[-1, 0]) == pytest.approx(1.0, abs=1e-6)


@pytest.mark.slow
def test_a_stiff_chain_without_a_zero_mode_has_none():
    """K = 1 on the diagonal and −2 beside it has the singular value 2^-60, and no eigenvalue but 1."""
    n = 60
    k = np.eye(n) - 2.0 * np.eye(n, k=-1)
    problem = SecondOrder(np.zeros((n, 1)), csr_array(k), csr_array(3.0 * k))
    assert problem.invariant.zero == ()
    assert problem.modes[0].decay_rate == pytest.approx(1.5 - sqrt(1.25), rel=1e-12)


def test_what_hinders_a_follower_is_no_zero_mode_of_the_whole():
    """A leader that nothing holds pushes one that can give way without end: one zero mode, in a chain of four."""
    k, d = np.array([[0.0, 0.0], [-1.0, 0.0]]), np.zeros((2, 2))
    problem = SecondOrder(np.zeros((2, 1)), csr_array(k), csr_array(d))
    np.testing.assert_array_equal(problem.eigenvalues, 0.0)
    assert [np.abs(mode.shape.ravel()).tolist() for mode in problem.invariant.zero] == [[0.0, 1.0]]
    assert problem.invariant.chains == 3


@pytest.mark.parametrize("q", [[[-3.5, 0.0], [3.5, 0.0]], [[-3.5, 0.1], [3.5, -0.1]]])
@pytest.mark.parametrize(
    ("pull", "drag"), [((1e-5, 1e-5), (2.0, 1.87)), ((1e-8, 3e-8), (2.0, 2.0)), ((2.0, 1e-5), (2.0, 1e-5))]
)
def test_weak_pulls_beside_stiff_links_hold(pull, drag, q):
    """S9: the spectrum of the same matrices in 40 digits; the rotation alone is free."""
    law = Algorithm2(gains=Gains(c1_gamma=pull, c2_gamma=drag), target=StaticTarget((0.0, 0.0)))
    flock = linearise(law, find_equilibrium(law, q).q)
    assert [mode.name for mode in flock.zero_modes] == ["rotation"]
    with mpmath.workdps(40):
        exact = mpmath.eig(mpmath.matrix(flock.A.tolist()), left=False, right=False)
    exact = np.array(sorted(exact, key=abs), dtype=complex)[1:]
    assert flock.decay_rate == pytest.approx(-exact.real.max(), rel=1e-7, abs=1e-12)


def test_an_agent_held_by_one_part_in_a_million_million_is_in_doubt():
    scales = np.array([1.0, 1.0, 1e3, 1e3])
    matrix = np.diag([1.0, 1.0, 1e3, 1e-9])
    kernel = kernel_of(matrix, scales, 1e-13, symmetric=True)
    assert kernel.right.shape[1] == 0
    np.testing.assert_allclose(kernel.doubtful(1e-13), [1e-12])
    assert kernel_of(matrix, scales, 1e-11, symmetric=False).right.shape[1] == 1
    assert kernel_of(matrix, scales, 1e-17, symmetric=False).doubtful(1e-17).size == 0


def test_what_counts_as_zero_is_rounding_and_the_force_that_is_left():
    stiffness = csr_array(np.diag([4.0, 4.0]))
    assert zero_threshold(stiffness, np.zeros((1, 2)), 1.0) == pytest.approx(64.0 * 2.0**-52 * sqrt(2.0))
    assert zero_threshold(stiffness, np.array([[1e-10, 0.0]]), 2.0) == pytest.approx(16.0 * 1e-10 / 4.0 / 2.0)
    assert zero_threshold(stiffness, np.ones((1, 2)), 1.0) == 1e-8


def test_the_slowest_modes_of_a_directed_net_are_those_of_its_components():
    flock = chain(30, 0.4)
    slow = slowest_modes(flock, 3)
    assert [mode.eigenvalue for mode in slow.modes] == pytest.approx([ROOT] * 3, abs=1e-13)
    assert slow.complete_to == np.inf
    k, d = flock.stiffness, flock.damping
    for mode in slow.modes:
        v = mode.shape.ravel()
        assert np.abs(mode.eigenvalue**2 * v + mode.eigenvalue * (d @ v) + k @ v).max() < 1e-9


def test_a_ring_has_the_poles_of_its_circulant():
    """Each of seven hears the one before: s² + (s + 1)(1 − e^(2πij/7)) = 0."""
    n = 7
    k = np.eye(n) - np.roll(np.eye(n), -1, axis=1)
    assert len(strong_components(k)) == 1
    problem = SecondOrder(np.zeros((n, 1)), csr_array(k), csr_array(k))
    roots = np.concatenate([np.roots([1.0, x, x]) for x in 1.0 - np.exp(2j * pi * np.arange(n) / n)])
    for value in problem.eigenvalues:
        assert np.abs(roots - value).min() < 1e-7


@pytest.mark.parametrize("seed", range(8))
def test_a_bent_chain_has_the_poles_of_its_links(seed):
    """Along each link s² + s + 1, across it s² + s: rounding of lengths made rows and columns of K differ in rank."""
    rng = np.random.default_rng(seed)
    n = int(rng.integers(3, 7))
    ways = pi / 3.0 * rng.integers(0, 6, n - 1) if seed % 2 else rng.uniform(0.0, 2.0 * pi, n - 1)
    q = np.cumsum([[0.0, 0.0], *np.column_stack([np.cos(ways), np.sin(ways)])], axis=0)
    law = MinimalFlocking(radius=9.0, spacing=1.0, edges=tuple((k, k + 1) for k in range(n - 1)))
    flock = linearise(law, q)
    followers = n - 1
    expected = [ROOT] * followers + [ROOT.conjugate()] * followers + [-1.0] * followers + [0.0] * (4 + followers)
    assert flock.stable
    assert np.sort_complex(flock.eigenvalues.round(9)) == pytest.approx(
        np.sort_complex(np.round(expected, 9)), abs=1e-8
    )
