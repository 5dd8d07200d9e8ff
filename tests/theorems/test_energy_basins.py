"""The basin of a minimum: curvature, barrier, Lipschitz constant, certificate, against closed forms."""

from math import inf, sqrt

import numpy as np
import pytest

from flockana.theorems import energy_basins as module
from flockana.theorems.energy_basins import (
    ALONE,
    Basin,
    barrier,
    connected_within,
    curvatures,
    excess,
    lipschitz_constant,
)


@pytest.mark.parametrize(
    ("basin", "margin", "word"),
    [
        (Basin(), -1.0, "no basin of a strict minimum is certified here"),
        (Basin(0.5, 2.0), 0.75, "certified to stay near a strict minimum of U (0.5 above it; 2 needed to leave)"),
        (Basin(3.0, 2.0), -0.5, "not certified to stay"),
        (Basin(50.0, 2.0), -1.0, "not certified to stay"),
        (ALONE, 1.0, "certified to stay"),
        (Basin(0.1, 2.0, stability=0.9), 0.5, "certified to stay"),  # a map may use a tenth of the barrier
        (Basin(0.1, 2.0, stability=0.3), 0.3, "certified to stay"),  # and is no surer than its step is stable
        (Basin(0.3, 2.0, stability=0.9), -0.5, "not certified to stay"),
        (Basin(0.0, 2.0, stability=-0.4), -0.4, "too long"),
        (Basin(0.0, 2.0, stability=-4.0), -1.0, "too long"),
    ],
)
def test_the_certificate_compares_the_energy_with_the_barrier(basin, margin, word):
    assert basin.certificate.margin == pytest.approx(margin, rel=1e-12)
    assert word in basin.certificate.text


def test_how_far_a_caught_flock_gets():
    """U = ½λx²: with the energy E above the minimum it goes out to √(2E/λ); the bound is √2 of that."""
    assert Basin(2.0, 9.0, 0.25, 0.5).reach == 0.25 + 4.0
    assert ALONE.reach == 0.0


def test_curvatures_leave_out_the_rigid_motions():
    spring = 3.0 * np.array([[1.0, -1.0], [-1.0, 1.0]])
    least, largest = curvatures(spring, np.full((2, 1), sqrt(0.5)))
    assert largest == pytest.approx(6.0, rel=1e-14)
    assert 6.0 * (1.0 - 1e-12) < least < 6.0  # its rounding is taken off
    least, largest = curvatures(np.zeros((1, 1)), np.ones((1, 1)))
    assert np.isnan(least)
    assert largest == 0.0


def test_the_barrier_of_a_cubic_well():
    """U = ½λx² − (L/6)|x|³ rises to 2λ³/(3L²); within half of the way, ρ = λ/2L, its barrier is ρ²(½λ − Lρ/6)."""
    curvature, lipschitz = 2.0, 3.0
    reach = 0.5 * curvature / lipschitz
    wide, constant = barrier(curvature, 0.0, [0.1, 10.0], lambda window: lipschitz)
    assert constant == lipschitz
    assert wide == pytest.approx(reach**2 * (0.5 * curvature - lipschitz * reach / 6.0), rel=1e-14)
    assert wide < 2.0 * curvature**3 / (3.0 * lipschitz**2)
    assert barrier(curvature, 1.0, [4.0], lambda window: 0.0)[0] == 0.0  # the minimum is too far for its window


@pytest.mark.parametrize(("distance", "found"), [(0.08, True), (0.09, False)])
def test_a_minimum_near_by_lowers_the_curvature_that_is_left(distance, found):
    """ρ = λ/2L = 1/3 takes a minimum within ρ/4; what is left of the curvature is λ − L times the distance."""
    curvature, lipschitz, reach = 2.0, 3.0, 1.0 / 3.0
    height = barrier(curvature, distance, [10.0], lambda window: lipschitz)[0]
    left = curvature - lipschitz * distance
    assert height == pytest.approx(found * reach**2 * (0.5 * left - lipschitz * reach / 6.0), rel=1e-14)
    assert barrier(np.nan, 0.0, [1.0], lambda window: 1.0)[0] == 0.0


def test_the_lipschitz_constant_of_one_pair_is_exact():
    """Two agents on a line: the Hessian is F'' (1, -1)ᵀ(1, -1), of norm 2F'', which changes by 2T |Δs| = 2T √2 |a|."""
    assert lipschitz_constant(2, np.array([[0, 1]]), np.array([5.0])) == pytest.approx(2.0 * sqrt(2.0) * 5.0)
    assert lipschitz_constant(2, np.empty((0, 2), dtype=int), np.empty(0)) == 0.0
    assert lipschitz_constant(4, np.array([[0, 1], [2, 3]]), np.array([5.0, 1.0])) == pytest.approx(10.0 * sqrt(2.0))


def test_a_state_known_to_a_distance_may_be_higher_and_must_lie_in_the_basin():
    """U = ½Λx² about x = 1, known to 0.1: at most |g|Δ + ½ΛΔ² above; and a window of 1 holds no state 2 away."""
    p = np.array([[1.0], [-1.0]])
    exact = excess(p, 0.0, 0.2, 2.0, 0.0, 5.0, 3.0)
    assert exact == pytest.approx(1.0 + 0.2**2 / 2.0, rel=1e-12)
    blurred = excess(p, 0.0, 0.2, 2.0, 0.1, 5.0, 3.0)
    assert blurred - exact == pytest.approx(0.2 * 0.1 + 0.5 * (5.0 + 0.3) * 0.01, rel=1e-9)
    assert excess(p, 0.5, 0.2, 2.0, 0.0, 5.0, 3.0) == pytest.approx(0.5 * (sqrt(2.0) + 0.5) ** 2 + 0.02, rel=1e-12)
    assert barrier(2.0, 0.0, [1.0], lambda window: 0.0, off=0.5)[0] == 1.0
    assert barrier(2.0, 0.0, [1.0], lambda window: 0.0, off=2.0)[0] == 0.0


def test_a_net_is_connected_within_its_reach():
    q = np.array([[0.0], [1.0], [3.0]])
    assert connected_within(q, 2.5)
    assert not connected_within(q, 1.5)
    assert not connected_within(q, -inf)


@pytest.mark.parametrize("rise", [0.0, 0.3, 2.0, 8.0])
@pytest.mark.parametrize("distance", [0.0, 0.02])
def test_of_many_windows_the_best_is_taken_as_if_each_were_looked_into(rise, distance):
    windows = np.geomspace(0.01, 3.0, 25)

    def lipschitz(window):
        return rise * (1.0 + window**2)

    each = [barrier(2.0, distance, [window], lipschitz)[0] for window in windows.tolist()]
    assert barrier(2.0, distance, windows, lipschitz)[0] == max(each) > 0.0


def test_a_pair_turns_by_the_root_of_two():
    assert module.gyration(np.array([[-1.0, 0.0], [1.0, 0.0]])) == np.sqrt(2.0)
