"""What rounding may have done to a rate, against matrices whose eigenvalues are known exactly."""

from math import inf, pi, sqrt

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.linalg import expm

from flockana import Algorithm1, Algorithm2, DeadZoneFlocking, Gains, StaticTarget, find_equilibrium, rescale
from flockana.lattice import hexagonal_patch, hexagonal_spiral
from flockana.stability import linearise, slowest_modes
from flockana.stability.centre_path import centre_path
from flockana.stability.centre_transfer import CentreOfMass
from flockana.stability.decay import decay
from flockana.stability.delay import DelaySystem, delay_margin
from flockana.stability.delay_roots import rightmost_roots, root_error
from flockana.stability.eigenvalue_errors import eigen, eigenvalues, slowest_first
from flockana.stability.gain_sweeps import gain_sweep
from flockana.stability.law_studies import delay_system, law_blocks
from flockana.stability.norms import disturbance_system, h2_bounds, h2_norm, hinf_norm

UNITS = [(1e-6, 1e3), (1e3, 1e-3)]
ORIGIN = StaticTarget((0.0, 0.0))


def similar(matrix, seed, stretch=1.0):
    """The same matrix in another basis, orthonormal but for a stretch of its axes."""
    rng = np.random.default_rng(seed)
    turn = np.linalg.qr(rng.standard_normal(matrix.shape))[0]
    axes = np.geomspace(1.0, stretch, len(matrix))[:, None] * turn
    return np.linalg.solve(axes, matrix @ axes)


@given(st.integers(0, 50), st.floats(1.0, 1e4))
@settings(max_examples=40, deadline=None)
def test_undamped_swings_have_no_rate_beyond_their_error(seed, stretch):
    omega = np.random.default_rng(seed).uniform(0.1, 30.0, 4)
    blocks = [np.array([[0.0, w], [-w, 0.0]]) for w in omega]
    matrix = np.zeros((8, 8))
    for k, block in enumerate(blocks):
        matrix[2 * k : 2 * k + 2, 2 * k : 2 * k + 2] = block
    values, _, errors = eigen(similar(matrix, seed, stretch))
    assert np.all(np.abs(values.real) <= errors)
    for value, error in zip(values, errors, strict=True):
        assert np.abs(np.abs(value.imag) - omega).min() <= error
    assert errors.max() < 1e-6 * omega.max()  # and yet a damping of a millionth is seen


@pytest.mark.parametrize("seed", range(12))
def test_eigenvalues_that_are_equal_and_real_come_out_real_one_by_one(seed):
    """As a conjugate pair, which rounding makes of them on some processors, two modes would be one."""
    matrix = similar(np.diag([1.0, 1.0, 1.0, 1.0, -3.0, -3.0]), seed)
    values, vectors, _ = eigen(matrix)
    assert not values.imag.any()
    assert np.sort(values.real) == pytest.approx([-3.0, -3.0, 1.0, 1.0, 1.0, 1.0], abs=1e-13)
    assert np.linalg.norm(matrix @ vectors - vectors * values, axis=0).max() < 1e-12
    assert np.linalg.matrix_rank(vectors, tol=1e-3) == 6


@pytest.mark.parametrize("size", [2, 3, 4, 5])
def test_coalesced_roots_move_as_roots_and_the_error_says_so(size):
    """A Jordan block of −1: computed values lie on a circle of radius (rounding)^(1/size)."""
    chain = -np.eye(size) + np.eye(size, k=1)
    for matrix in (chain, *(similar(chain, seed) for seed in range(5))):
        values, _, errors = eigen(matrix)
        assert np.all(np.abs(values + 1.0) <= errors)
        assert errors.max() < 30.0 * np.finfo(float).eps ** (1.0 / size) * size


def test_the_error_has_the_unit_of_the_rate():
    """A flock's matrix mixes 1 and 1/time²; in milliseconds or kiloseconds the same digits are lost."""
    stiff, damp = np.diag([450.0, 30.0]), np.array([[9.0, -2.0], [-2.0, 4.0]])
    shares = []
    for time in (1e-6, 1e-3, 1.0, 1e3, 1e6):
        zero, one = np.zeros((2, 2)), np.eye(2)
        _, _, errors = eigen(np.block([[zero, one], [-stiff / time**2, -damp / time]]))
        shares.append(np.sort(errors) * time)
    for share in shares:
        np.testing.assert_allclose(share, shares[2], rtol=0.5)  # balanced by powers of two
    assert shares[2].max() < 1e-11


def test_ties_are_ordered_by_frequency_and_then_as_given():
    values = np.array([-1.0 + 3.0j, -1.0 - 1e-15 + 2.0j, -1.0 + 1e-15 + 2.0j, -0.5 + 9.0j])
    assert slowest_first(values, np.full(4, 1e-14)) == [3, 1, 2, 0]
    assert slowest_first(values, np.zeros(4)) == [3, 2, 0, 1]
    assert slowest_first(np.zeros(0), np.zeros(0)) == []


def test_modes_of_equal_rates_are_in_one_order():
    """All agents in range, so that every shape decays at k₂ n/2 = 3.5: the slowest swing is named first."""
    law = DeadZoneFlocking()
    found = linearise(law, find_equilibrium(law, hexagonal_patch(1, 3.5)))
    assert found.decay_rate == pytest.approx(3.5, rel=1e-12)
    swings = [mode.frequency for mode in found.modes[:11]]
    assert np.all(np.diff(swings) > -1e-9)
    assert found.stable


@pytest.mark.parametrize(("length", "time"), UNITS)
@pytest.mark.parametrize("law", [Algorithm1(), Algorithm2(target=ORIGIN), DeadZoneFlocking()])
def test_modes_rates_margins_and_norms_in_every_unit(law, length, time):
    spacing = 3.5 if isinstance(law, DeadZoneFlocking) else 7.0
    there = rescale(law, length=length, time=time)
    here, found = (
        linearise(one, find_equilibrium(one, hexagonal_patch(1, size)))
        for one, size in ((law, spacing), (there, length * spacing))
    )
    assert [mode.name for mode in found.zero_modes] == [mode.name for mode in here.zero_modes]
    assert found.drifting == here.drifting
    assert [m.name for m in found.modes if not m.name.isdigit()] == [m.name for m in here.modes if not m.name.isdigit()]
    rates = [[mode.decay_rate for mode in one.modes] for one in (here, found)]
    np.testing.assert_allclose(time * np.array(rates[1]), rates[0], rtol=1e-9, atol=1e-9 * max(rates[0]))
    assert decay(found).measured * time == pytest.approx(decay(here).measured, rel=1e-4)
    if isinstance(law, DeadZoneFlocking):
        return
    margins = [delay_margin(delay_system(one, flock.q)) for one, flock in ((law, here), (there, found))]
    assert margins[1].delay == pytest.approx(time * margins[0].delay, rel=1e-9)
    assert margins[1].frequency * time == pytest.approx(margins[0].frequency, rel=1e-9)
    norms = [h2_norm(disturbance_system(law_blocks(one, x.q))) for one, x in ((law, here), (there, found))]
    assert norms[1] == pytest.approx(time**1.5 * norms[0], rel=1e-8)  # length over a force of white noise
    peaks = [hinf_norm(disturbance_system(law_blocks(one, x.q)))[0] for one, x in ((law, here), (there, found))]
    assert peaks[1] == pytest.approx(time**2 * peaks[0], rel=1e-7)


@pytest.mark.parametrize("law", [Algorithm1(), Algorithm2(target=ORIGIN)])
@pytest.mark.parametrize("n", [2, 3, 12])
def test_a_bracket_holds_its_norm_even_where_it_is_closed(law, n):
    """Of a bond and of a triangle D is a multiple of 1 on shapes: both bounds are the norm itself."""
    flock = law_blocks(law, find_equilibrium(law, hexagonal_spiral(n, 7.0)).q)
    low, high = h2_bounds(flock)
    assert low <= h2_norm(disturbance_system(flock)) <= high
    if isinstance(law, Algorithm1) and n <= 3:
        assert high / low - 1.0 < 1e-10


def test_the_sparse_modes_know_their_errors():
    found = linearise(Algorithm2(target=ORIGIN), find_equilibrium(Algorithm2(target=ORIGIN), hexagonal_patch(3, 7.0)))
    exact = [mode.eigenvalue for mode in found.modes]
    for mode in slowest_modes(found, 8).modes:
        assert mode.decays
        assert min(abs(mode.eigenvalue - other) for other in exact) <= 2.0 * mode.error < 1e-4


def test_a_slow_flock_is_still_told_from_one_at_rest():
    """Damping of 1e-9 of the frequency is far above rounding; none is not; and neither depends on the processor."""
    for damping, stable in ((1e-9, True), (0.0, False)):
        found = linearise(Algorithm1(gains=Gains(c2_alpha=damping)), hexagonal_patch(1, 7.0))
        assert found.stable is stable
        assert all(mode.decays is stable for mode in found.modes if mode.frequency > 0.0)


# ---- delays ---------------------------------------------------------------------------------------------------------


def scalar(k, d, neutral=0):
    zero = np.zeros((1, 1))
    return DelaySystem((zero, zero), (np.array([[k]]), np.array([[d]])), neutral)


def test_without_damping_any_delay_feeds_energy_in():
    """Roots on the axis, or within rounding of it: the phase there is 0 or 2π by the last bit."""
    for k in (0.1, 1.0, 9.0, 450.0):
        assert delay_margin(scalar(k, 0.0)).delay == 0.0
    stiff = similar(np.diag([1.0, 4.0, 9.0]), 0)
    assert delay_margin(DelaySystem((0.0 * stiff, 0.0 * stiff), (stiff, 0.0 * stiff))).delay == 0.0
    assert delay_margin(scalar(0.0, 0.0, neutral=2)).delay == inf


def test_roots_come_in_pairs_and_with_an_error_that_covers_them():
    system = scalar(0.0, 1.0, neutral=1)
    for count in (1, 2, 3, 5):
        found = rightmost_roots(system, 0.5 * pi, count=count)
        assert found.size == count
        for k in range(0, count - 1, 2):
            assert found[k] == found[k + 1].conjugate()
    root = rightmost_roots(system, 0.5 * pi, count=1)[0]
    assert abs(root - 1j) <= root_error(system, root, 0.5 * pi) < 1e-13
    assert root_error(system, root + 1e-6, 0.5 * pi) == pytest.approx(1e-6, rel=1e-3)  # of a root that is none yet


# ---- the centre of mass ---------------------------------------------------------------------------------------------


@pytest.mark.parametrize("c1", [0.1, 0.3, 0.7, 1.1, 2.3, 3.1, 5.0, 5.7, 1e-9, 1e9])
def test_critical_damping_is_double_and_has_no_period(c1):
    """c2 = 2√c1 as stored: whether c2²/4 − c1 rounds to 0, above or below it says nothing."""
    centre = CentreOfMass(Gains(c1_gamma=c1, c2_gamma=2.0 * sqrt(c1)))
    assert centre.period == inf
    assert centre.poles[0] == centre.poles[1]
    assert centre.poles[0].real == pytest.approx(-sqrt(c1), rel=1e-15)


@pytest.mark.parametrize("off", [0.0, 1e-15, -1e-15, 1e-12, -1e-12, 1e-8, -1e-8, 1e-4, -1e-4])
def test_the_centre_near_critical_damping_keeps_all_its_digits(off):
    gains = Gains(c1_gamma=4.0, c2_gamma=4.0 * (1.0 + off))
    t = np.array([0.0, 1e-6, 0.3, 2.0, 9.0])
    path = centre_path(gains, StaticTarget((0.0,)), t, [1.0], [-1.0])[:, 0]
    matrix = np.array([[0.0, 1.0], [-4.0, -4.0 * (1.0 + off)]])
    exact = [(expm(matrix * s) @ [1.0, -1.0])[0] for s in t]
    np.testing.assert_allclose(path, exact, rtol=1e-11)


def test_a_sweep_keeps_its_neutral_columns_in_every_unit():
    law, values = Algorithm1(), np.linspace(1.0, 12.0, 5)
    here = gain_sweep(law, hexagonal_spiral(4, 7.0), "c2_alpha", values, follow=False)
    there = gain_sweep(rescale(law, time=1e3), hexagonal_spiral(4, 7.0), "c2_alpha", values / 1e3, follow=False)
    assert here.neutral == there.neutral == 5
    np.testing.assert_allclose(1e3 * there.abscissa, here.abscissa, rtol=1e-8)


def test_a_block_triangular_matrix_has_the_eigenvalues_of_its_blocks():
    """A row of 50 equal blocks, numbered from the end: no Jordan block smears, and vectors solve the whole."""
    block = np.array([[-0.2, 1.0], [-1.0, -0.2]])
    for n in (3, 50):
        matrix = np.kron(np.eye(n), block) + np.kron(np.eye(n, k=1), [[0.0, 0.0], [0.3, 0.0]])
        values, errors = eigenvalues(matrix)
        assert np.abs(values.real + 0.2).max() <= errors.max() < 1e-14
        whole, vectors, bounds = eigen(matrix)
        np.testing.assert_array_equal(whole, values)
        np.testing.assert_array_equal(bounds, errors)
        assert np.abs(matrix @ vectors - vectors * values).max() < 1e-10
        np.testing.assert_allclose(np.linalg.norm(vectors, axis=0), 1.0, rtol=1e-12)
    other = np.array([[-1.0, 0.5, 0.0], [0.0, -2.0, 0.0], [1.0, 1.0, -3.0]])
    values, vectors, _ = eigen(other)
    assert sorted(values.real) == [-3.0, -2.0, -1.0]
    assert np.abs(other @ vectors - vectors * values).max() < 1e-14
