"""Modes and zero modes: exact ones of small flocks, their number and names, and the sparse search for slow ones."""

import itertools
from math import cos, pi, sqrt

import numpy as np
import pytest
from scipy.sparse import csr_array

from flockana import Algorithm1, Algorithm2, Algorithm3, MinimalFlocking, Sphere, StaticTarget, Wall, find_equilibrium
from flockana.base.errors import ArgumentError
from flockana.interactions import AlphaInteraction, Gains
from flockana.lattice import hexagonal_patch
from flockana.stability import Linearisation, linearise, slowest_modes
from flockana.stability.modes import SecondOrder

TETRAHEDRON = 7.0 / sqrt(8.0) * np.array([[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]], dtype=float)
PLANE = ["translation x", "translation y", "rotation"]


def names(modes):
    return [mode.name for mode in modes]


def a_patch(k=1, **gains):
    law = Algorithm2(gains=Gains(**gains), target=StaticTarget((1.0, -2.0)))
    return linearise(law, find_equilibrium(law, hexagonal_patch(k, 6.9)))


def test_two_agents_by_hand():
    """A link of stiffness k = c1 φ_α'(d_α) (d/√(1 + εd²))² and a damper c2 a: λ² + 2 c2 a λ + 2k = 0 along it."""
    alpha, gains = AlphaInteraction(), Gains()
    rho = 0.5 * (1.0 + cos(pi * (alpha.d_alpha / alpha.r_alpha - 0.2) / 0.8))
    k = gains.c1_alpha * rho * 5.0 * 49.0 / (1.0 + 0.1 * 49.0)  # φ'(0) = (a + b)/2 for a = b
    damping = 2.0 * gains.c2_alpha * rho
    found = linearise(Algorithm1(), [[0.0, 0.0], [7.0, 0.0]])
    along, across = (mode for mode in found.modes)
    assert along.name == "breathing"
    assert along.eigenvalue == pytest.approx(-0.5 * damping + 1j * sqrt(2.0 * k - 0.25 * damping**2), rel=1e-12)
    assert along.natural_frequency == pytest.approx(sqrt(2.0 * k), rel=1e-12)
    assert along.damping_ratio == pytest.approx(damping / sqrt(8.0 * k), rel=1e-12)
    np.testing.assert_allclose(np.abs(along.shape), [[sqrt(0.5), 0.0], [sqrt(0.5), 0.0]], atol=1e-12)
    assert (across.name, across.frequency, across.damping_ratio) == ("rotation", 0.0, 1.0)
    assert across.eigenvalue == pytest.approx(-damping, rel=1e-12)
    assert names(found.zero_modes) == PLANE
    np.testing.assert_array_equal(found.eigenvalues[:5], 0.0)


def test_one_agent_is_the_gamma_agents_own_oscillator():
    law = Algorithm2(gains=Gains(c1_gamma=25.0, c2_gamma=6.0), target=StaticTarget((1.0, 2.0)))
    found = linearise(law, [[1.0, 2.0]])
    assert names(found.modes) == ["translation x", "translation y"]
    assert [mode.eigenvalue for mode in found.modes] == [-3 + 4j, -3 + 4j]
    assert (found.zero_modes, found.decay_rate, found.spectral_abscissa) == ((), 3.0, -3.0)
    assert np.isnan(found.structural_decay_rate)


def test_critical_damping_is_exactly_double():
    """The default gains; a general solver would give −1.0488 ± 1e-8 and eigenvectors that are nearly parallel."""
    for c1 in (0.1, 0.3, 0.7, 1.1, 2.3, 3.1, 5.7):  # of some the discriminant does not round to zero
        gains = Gains(c1_gamma=c1, c2_gamma=2.0 * sqrt(c1))
        found = linearise(Algorithm2(target=StaticTarget((0.0,)), gains=gains), [[0.0]])
        assert [mode.eigenvalue for mode in found.modes] == [pytest.approx(-sqrt(c1), rel=1e-14)] * 2


@pytest.mark.parametrize(
    ("q", "zero", "drifting"),
    [
        (hexagonal_patch(1, 7.0), PLANE, 2),
        (hexagonal_patch(2, 7.0), PLANE, 2),
        ([[0.0], [7.0], [14.0]], ["translation x"], 1),
        (TETRAHEDRON, [f"{motion} {axis}" for motion in ("translation", "rotation") for axis in "xyz"], 3),
        ([[-7.0, 0.0], [0.0, 0.0], [7.0, 0.0]], [*PLANE, "soft 1"], 2),  # a chain bends at its middle agent: a hinge
        ([[0.0, 0.0], [70.0, 0.0]], [*PLANE, "soft 1"], 2),
    ],
)
def test_what_costs_nothing_under_algorithm_1(q, zero, drifting):
    found = linearise(Algorithm1(), q)
    assert names(found.zero_modes) == zero
    translations = [name for name in found.drifting if name.startswith("translation")]
    assert len(translations) == drifting
    assert not found.semisimple
    for mode in found.zero_modes:
        assert np.abs(found.stiffness @ mode.shape.ravel()).max() < 1e-12 * abs(found.stiffness).max() + 1e-300
        assert np.linalg.norm(mode.shape) == pytest.approx(1.0)


def test_agents_out_of_range_drift_apart_too():
    """Four velocities persist and four coordinates: eight zeros, in four Jordan blocks."""
    found = linearise(Algorithm1(), [[0.0, 0.0], [70.0, 0.0]])
    np.testing.assert_array_equal(found.eigenvalues, 0.0)
    assert found.drifting == ("rotation", "soft 1", "translation x", "translation y")
    assert found.modes == ()
    assert np.isnan(found.decay_rate)


def test_the_gamma_agent_leaves_the_rotations_only():
    found = a_patch()
    assert names(found.zero_modes) == ["rotation"]
    assert found.semisimple
    assert found.drifting == ()
    target = StaticTarget((0.0, 0.0, 0.0))
    law = Algorithm2(target=target)
    solid = linearise(law, find_equilibrium(law, TETRAHEDRON))
    assert names(solid.zero_modes) == ["rotation x", "rotation y", "rotation z"]
    assert solid.semisimple


def test_without_damping_everything_drifts_and_swings():
    law = Algorithm1(gains=Gains(c2_alpha=0.0))
    found = linearise(law, hexagonal_patch(1, 7.0))
    assert found.drifting == ("rotation", "translation x", "translation y")
    assert sum(found.eigenvalues == 0.0) == 6
    assert abs(found.decay_rate) < 1e-12 * found.modes[-1].natural_frequency


def test_without_a_pull_the_centre_stays_where_damping_leaves_it():
    found = a_patch(c1_gamma=0.0, c2_gamma=2.0)
    assert names(found.zero_modes) == PLANE
    assert found.semisimple
    assert names(found.modes)[:2] == ["translation x", "translation y"]
    # the pair terms of K and D, up to 1e3, cancel in the sum over agents
    assert found.modes[0].eigenvalue == pytest.approx(-2.0, abs=7.0 * 1e3 * np.finfo(float).eps)
    assert abs(found.modes[0].eigenvalue + 2.0) <= found.modes[0].error < 1e-10


def test_symmetries_that_are_no_axis_are_named_for_what_they_are():
    """A single agent pushed off a sphere about the γ-agent slides round it; by 30 degrees that is along no axis."""
    target, ball = StaticTarget((0.0, 0.0)), Sphere((0.0, 0.0), 2.0)
    law = Algorithm3(target=target, obstacles=(ball,))
    start = 5.0 * np.array([[cos(pi / 6.0), 0.5]])
    found = linearise(law, find_equilibrium(law, start))
    (mode,) = found.zero_modes
    assert mode.name == "translation"
    np.testing.assert_allclose(np.abs(mode.shape @ [0.5, -cos(pi / 6.0)]), 1.0, rtol=1e-6)
    wall = Algorithm3(target=target, obstacles=(Wall((1.0, 0.0), (1.0, 0.0)),))
    assert linearise(wall, find_equilibrium(wall, [[4.0, 0.5]])).zero_modes == ()


def test_every_mode_solves_the_quadratic_problem():
    found = a_patch(2)
    K, D = found.stiffness.toarray(), found.damping.toarray()
    for mode in found.modes:
        v = mode.shape.ravel()
        assert np.linalg.norm(v) == pytest.approx(1.0)
        residual = mode.eigenvalue**2 * v + mode.eigenvalue * (D @ v) + K @ v
        assert np.abs(residual).max() < 1e-9 * np.abs(K).max()
        assert np.linalg.norm(v.imag) <= np.linalg.norm(v.real)
        assert mode.eigenvalue.imag >= 0.0
    for slow, fast in itertools.pairwise(found.modes):
        assert slow.decay_rate <= fast.decay_rate + slow.error + fast.error
    numbers = [(k, mode.name) for k, mode in enumerate(found.modes, start=1) if mode.name.isdigit()]
    assert all(int(name) == k for k, name in numbers)


def test_a_hexagon_breathes_and_its_ring_turns_against_nothing():
    """Both are alone in their symmetry class: the shape is exact, the eigenvalue that of one degree of freedom."""
    found = a_patch()
    x = (found.q - found.q.mean(axis=0)).ravel()
    turn = np.stack([-found.q[:, 1], found.q[:, 0]], axis=1)
    turn = (turn - turn.mean(axis=0)).ravel()
    for name, v in (("breathing", x), ("rotation", turn)):
        v = v / np.linalg.norm(v)
        k, d = v @ (found.stiffness @ v), v @ (found.damping @ v)
        mode = next(mode for mode in found.modes if mode.name == name)
        assert abs(mode.shape.ravel() @ v) == pytest.approx(1.0, abs=1e-12)
        expected = -0.5 * d + 0.5 * np.sqrt(complex(d * d - 4.0 * k))
        if name == "rotation":
            assert k == pytest.approx(0.0, abs=1e-9)
            expected = -d
        assert mode.eigenvalue == pytest.approx(expected, rel=1e-10)


def test_a_breathing_mode_of_a_larger_patch_is_not_claimed_where_it_is_not_uniform():
    found = linearise(Algorithm1(), hexagonal_patch(2, 7.0))
    x = (found.q - found.q.mean(axis=0)).ravel()
    overlap = [abs(np.vdot(mode.shape.ravel(), x)) / np.linalg.norm(x) for mode in found.modes]
    assert [mode.name == "breathing" for mode in found.modes] == [value >= 0.99 for value in overlap]


def test_a_directed_tree_has_the_zero_modes_of_the_corrected_theorem():
    """Erratum J/B5: per edge the roots of s² + s + μ once and {0, −1} d − 1 times; the root moves freely."""
    law = MinimalFlocking(edges=[(0, 1), (1, 2), (1, 3)], spacing=1.0, mu=0.7)
    q = np.zeros((4, 2))
    for child, parent, angle in ((1, 0, 0.3), (2, 1, 1.1), (3, 1, 2.9)):
        q[child] = q[parent] + [np.cos(angle), np.sin(angle)]
    found = linearise(law, q)
    assert len(found.zero_modes) == 3 + 2  # (n − 1)(d − 1), and where the root is
    assert found.second_order.invariant.chains == 2  # the root keeps its velocity
    assert not found.second_order.split.exact
    root = -0.5 + 1j * sqrt(0.7 - 0.25)
    np.testing.assert_array_equal(found.eigenvalues[:7], 0.0)
    for value, count in ((root, 3), (root.conjugate(), 3), (-1.0, 3)):  # along the chain defective: good to √(rounding)
        assert np.sum(np.abs(found.eigenvalues - value) < 1e-6) == count
    with pytest.raises(ArgumentError, match="MinimalFlocking does not split"):
        found.ensure_split()


@pytest.mark.parametrize("law", ["Algorithm 1", "Algorithm 2"])
def test_the_sparse_search_finds_the_slowest_of_all(law):
    found = linearise(Algorithm1(), hexagonal_patch(4, 7.0)) if law == "Algorithm 1" else a_patch(3, c1_gamma=0.1)
    slow = slowest_modes(found, 10)
    assert [mode.decay_rate for mode in slow.modes] == pytest.approx([m.decay_rate for m in found.modes[:10]], rel=1e-9)
    frequencies = [mode.frequency for mode in found.modes[:10]]
    assert [mode.frequency for mode in slow.modes] == pytest.approx(frequencies, rel=1e-9, abs=1e-9)
    assert names(slow.modes) == names(found.modes[:10])
    assert slow.complete_to >= slow.modes[-1].decay_rate


def test_a_slow_mode_that_swings_fast_is_not_missed_or_its_absence_not_claimed():
    """99 springs of which one is stiff and hardly damped: its |λ| = 100 is the largest, its decay the slowest."""
    n = 99
    stiffness, damping = np.linspace(1.0, 2.0, n), np.full(n, 5.0)
    stiffness[0], damping[0] = 1e4, 0.02
    q = np.random.default_rng(0).standard_normal((n, 1))

    class Given(Linearisation):
        second_order = SecondOrder(q, csr_array(np.diag(stiffness)), csr_array(np.diag(damping)))

        def __init__(self):
            """Of no law."""

    slow = slowest_modes(Given(), 3)
    assert slow.complete_to < slow.modes[0].decay_rate


def test_how_far_the_list_is_complete_is_so_in_the_whole_spectrum():
    """With a consensus and a pull to the γ-agent every bound K < a + b D that serves has a < 0."""
    for found in (a_patch(6), linearise(Algorithm1(), hexagonal_patch(6, 7.0))):
        slow = slowest_modes(found, 5)
        assert slow.complete_to >= slow.modes[-1].decay_rate - 1e-9
        slower = [mode for mode in found.modes if mode.decay_rate < slow.modes[-1].decay_rate - 1e-9]
        assert len(slower) <= 5


def test_two_thousand_agents():
    """Eigenpairs of a problem whose dense matrix would hold 60 million numbers, without forming it."""
    found = linearise(Algorithm1(), hexagonal_patch(25, 7.0))
    assert found.q.shape == (1951, 2)
    slow = slowest_modes(found, 4)
    assert "A" not in vars(found)
    K, D = found.stiffness, found.damping
    for mode in slow.modes:
        v = mode.shape.ravel()
        residual = mode.eigenvalue**2 * v + mode.eigenvalue * (D @ v) + K @ v
        assert np.abs(residual).max() < 1e-9 * abs(K).max() * np.abs(v).max()
    assert slow.complete_to >= slow.modes[-1].decay_rate > slow.modes[0].decay_rate > 0.0
    # waves: (kR)² halves the rate per area doubled; R grows from 12 to 25 rings
    smaller = slowest_modes(linearise(Algorithm1(), hexagonal_patch(12, 7.0)), 1).modes[0]
    assert smaller.decay_rate / slow.modes[0].decay_rate == pytest.approx((25.5 / 12.5) ** 2, rel=0.05)


def test_bad_counts():
    found = linearise(Algorithm1(), hexagonal_patch(1, 7.0))
    with pytest.raises(ArgumentError, match="count = 0: expected a whole number"):
        slowest_modes(found, 0)
    with pytest.raises(ArgumentError, match=r"count = 12: expected fewer modes.*`modes`"):
        slowest_modes(found, 12)
