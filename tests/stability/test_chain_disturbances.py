"""Disturbances along chains, growth before decay and passivity: closed forms of equal followers, and a fine grid."""

from math import sqrt

import numpy as np
import pytest
from scipy.linalg import expm
from scipy.sparse import csr_array

from flockana import Algorithm1, Algorithm2, Linearisation, MinimalFlocking, StaticTarget, find_equilibrium, linearise
from flockana.lattice import hexagonal_patch
from flockana.stability.chain_disturbances import passivity, string_gains, string_stability, transient_growth
from tests.refused import refused

LAW = Algorithm2(target=StaticTarget((0.0,)))


def net(k, d):
    n = len(k)
    a = np.block([[np.zeros((n, n)), np.eye(n)], [-np.asarray(k), -np.asarray(d)]])
    places, links = np.arange(n, dtype=float)[:, None], np.zeros((0, 2), dtype=np.int32)
    return Linearisation(LAW, places, 0.0 * places, 0.0, 0.0, links, csr_array(a), 1e-12)


@pytest.mark.parametrize(("k", "d"), [(1.0, 1.0), (4.0, 0.5), (1.0, 3.0)])
def test_gains_along_a_chain_are_powers_of_the_first(k, d):
    """(d s + k)/(s² + d s + k) of each follower: its peak exceeds 1 whatever the damping."""
    n = 6
    chain = np.eye(n) - np.eye(n, k=-1)
    chain[0, 0] = 0.0
    found = string_gains(net(k * chain, d * chain))
    w = np.linspace(1e-4, 10.0, 400_001)
    peak = np.abs((1j * w * d + k) / (k - w * w + 1j * w * d)).max()
    np.testing.assert_allclose(found.gains, peak ** np.arange(n), rtol=1e-6)
    assert found.amplifies


def test_followers_with_a_drag_of_their_own_pass_on_less():
    n = 5
    chain, drag = np.eye(n) - np.eye(n, k=-1), 4.0 * np.eye(n)
    chain[0, 0] = 0.0
    found = string_gains(net(chain, drag))  # k/(s² + 4 s + k) falls from 1 at rest
    np.testing.assert_allclose(found.gains, 1.0, rtol=1e-8)
    assert not found.amplifies
    np.testing.assert_array_equal(found.peaks, 0.0)


def chain_of(k, d, drag=0.0, back=0.0):
    """Chains of n agents on a line: each hears the one before, and the one behind with a share of the weight."""

    def build(n):
        heard = np.eye(n) - np.eye(n, k=-1) + back * (np.diag([1.0] * (n - 1) + [0.0]) - np.eye(n, k=1))
        heard[0, 0] -= 1.0
        return net(k * heard, d * heard + drag * np.eye(n))

    return build


def test_one_link_decides_chains_of_every_length():
    """k/(s² + drag s + k) exceeds 1 iff drag² < 2 k: its peak is k/(drag √(k − drag²/4))."""
    for drag in (1.0, 1.4, 1.5):
        found = string_stability(chain_of(1.0, 0.0, drag), (2, 4, 7))
        peak = 1.0 / (drag * sqrt(1.0 - drag**2 / 4.0)) if drag**2 < 2.0 else 1.0
        assert found.link == pytest.approx(peak, rel=1e-8)
        assert found.stable is (drag**2 > 2.0)
        np.testing.assert_allclose(found.gains, peak ** np.array([1, 3, 6]), rtol=1e-6)
    assert "no chain amplifies" in found.why


def test_chains_of_other_forms_are_measured_and_say_so():
    both = string_stability(chain_of(1.0, 1.0, back=0.5), (3, 6))
    assert both.stable is None
    assert both.why.startswith("measured only")
    twisted = np.array([[2.0, 6.0], [0.0, 2.0]])  # two axes: an answer above 1 whose powers fall

    def plane(n):
        k = np.kron(np.eye(n), 4.0 * np.eye(2)) - np.kron(np.eye(n, k=-1), twisted)
        a = np.block([[np.zeros((2 * n, 2 * n)), np.eye(2 * n)], [-k, -8.0 * np.eye(2 * n)]])
        places = np.arange(2.0 * n).reshape(n, 2)
        return Linearisation(LAW, places, 0.0 * places, 0.0, 0.0, np.zeros((0, 2), dtype=np.int32), csr_array(a), 1e-12)

    found = string_stability(plane, (2, 12))
    assert found.gains[0] == pytest.approx(np.linalg.norm(twisted / 4.0, 2), rel=1e-6)
    assert found.gains[0] > 1.0 > found.gains[1]
    assert found.stable is None
    assert string_stability(chain_of(1.0, 1.0), (2, 3)).stable is False


@pytest.mark.slow
@pytest.mark.parametrize("n", [1, 4, 8])
def test_growth_before_decay_against_a_fine_grid(n):
    """A chain that amplifies threefold from each to the next."""
    k = np.eye(n) - 3.0 * np.eye(n, k=-1)
    flock = net(k, 2.0 * np.eye(n))
    found, pace = transient_growth(flock), np.abs(flock.eigenvalues).max()
    a = np.block([[np.zeros((n, n)), pace * np.eye(n)], [-k / pace, -2.0 * np.eye(n)]])
    sizes = [np.linalg.norm(expm(a * t), 2) for t in np.linspace(0.0, 40.0, 4001)]
    assert found.growth == pytest.approx(max(sizes), rel=1e-4)
    assert found.growth >= max(sizes) * (1.0 - 1e-9)
    assert np.linalg.norm(expm(a * found.time), 2) == pytest.approx(found.growth, rel=1e-9)


test_bad_input = refused(
    (lambda: string_stability(lambda n: n, (2, 3)), r"chain\(2\) = 2: expected what linearise\(law, q\) returns"),
    (lambda: string_stability(chain_of(1.0, 1.0), (1, 3)), r"sizes = \(1, 3\): expected rising numbers of agents"),
    (lambda: string_stability(lambda n: net(np.eye(4), np.eye(4)), (3,)), r"chain\(3\) has 4 agents: expected 3"),
    (
        lambda: string_gains(net(np.diag([0.0, 1.0]), np.eye(2)), first=1),
        "the others are not stable while agent 1 is held",
    ),
    (lambda: string_gains(net(np.eye(2), np.eye(2)), first=2), "first = 2: expected one of 2 agents"),
    (lambda: transient_growth(net([[1.0]], [[-1.0]])), "the flock is not stable"),
)


@pytest.mark.parametrize("unit", [1.0, 1.2, 1.5, 1e3])
def test_growth_and_distances_do_not_depend_on_the_unit_of_time(unit):
    """x'' = −x' − (x − x₀), measured by its rate 1, only falls: A + Aᵀ <= 0."""
    follower = net(unit**2 * np.array([[0.0, 0.0], [-1.0, 1.0]]), unit * np.array([[0.0, 0.0], [-1.0, 1.0]]))
    assert transient_growth(follower).growth == pytest.approx(1.0, abs=1e-9)
    ring = np.eye(3) - np.roll(np.eye(3), 1, axis=1)
    found, known = (net(t**2 * ring, 2.0 * t * ring) for t in (unit, 1.0))
    assert transient_growth(found).growth == pytest.approx(transient_growth(known).growth, rel=1e-6)
    assert found.controllability([0]).distance == pytest.approx(known.controllability([0]).distance, rel=1e-5)


def test_passive_are_the_flocks_whose_matrices_say_so():
    q = find_equilibrium(Algorithm1(), hexagonal_patch(1, 7.0))
    assert passivity(linearise(Algorithm1(), q)).passive
    chain = linearise(MinimalFlocking(edges=((0, 1),), spacing=1.0, radius=2.0), [[0.0], [1.0]])
    assert not passivity(chain).passive
    assert passivity(chain).asymmetry == pytest.approx(1.0)
    assert not passivity(net(np.diag([1.0, -1e-6]), np.eye(2))).passive
    assert passivity(net(np.eye(2), [[1.0, 5.0], [-5.0, 1.0]])).passive  # what turns only takes no energy
    found = passivity(net(np.eye(2), [[1.0, 3.0], [0.0, 1.0]]))
    assert (found.passive, found.damping) == (False, pytest.approx(-0.5 / 4.0))
