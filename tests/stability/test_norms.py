"""Norms against closed forms, python-control, and the bounds that hold for every flock."""

from math import inf, pi, sqrt

import control
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from flockana import (
    Algorithm1,
    Algorithm2,
    Algorithm3,
    Disturbed,
    StaticTarget,
    TaylorStep,
    find_equilibrium,
    linearise,
    simulate,
)
from flockana.base.errors import ArgumentError
from flockana.interactions import AlphaInteraction, Gains
from flockana.lattice import hexagonal_spiral
from flockana.stability.law_studies import law_blocks, norms_against_size
from flockana.stability.norms import disturbance_system, h2_norm, hinf_norm, stationary_covariance
from flockana.stability.second_order_blocks import blocks
from tests.refused import refused

ALPHA = AlphaInteraction()
ORIGIN = StaticTarget((0.0, 0.0))


def oscillator(k, d):
    return control.ss([[0.0, 1.0], [-k, -d]], [[0.0], [1.0]], [[1.0, 0.0]], 0.0)


@given(st.floats(0.1, 50.0), st.floats(0.05, 20.0))
@settings(max_examples=30, deadline=None)
def test_a_scalar_oscillator_has_the_textbooks_norms(k, d):
    assert h2_norm(oscillator(k, d)) == pytest.approx(1.0 / sqrt(2.0 * d * k), rel=1e-9)
    resonant = d * d < 2.0 * k
    norm, peak = hinf_norm(oscillator(k, d))
    assert norm == pytest.approx(1.0 / (d * sqrt(k - d * d / 4.0)) if resonant else 1.0 / k, rel=1e-8)
    # the peak is flat: its place is known to the square root of the tolerance
    assert peak == pytest.approx(sqrt(max(0.0, k - d * d / 2.0)), abs=2e-3 * sqrt(k))


def test_a_direct_feedthrough_counts_in_each_norm_as_it_must():
    """S4: 1/(s + 1) + 5 peaks at 6 at rest; its white noise has no variance, but that of a sequence has."""
    both = control.ss(-1, 1, 1, 5)
    assert hinf_norm(both) == (pytest.approx(6.0, rel=1e-9), 0.0)
    assert h2_norm(both) == inf
    with pytest.raises(ArgumentError, match="D has an entry 5: expected 0 in continuous time"):
        stationary_covariance(both)
    high = control.ss(-1, 1, -1, 5)  # 5 − 1/(s + 1) rises to 5
    assert hinf_norm(high) == (pytest.approx(5.0), inf)
    step = control.ss([[-0.5]], 1, 1, 2.0, 0.1)
    assert h2_norm(step) == pytest.approx(sqrt(4.0 / 3.0 + 4.0), rel=1e-14)
    assert stationary_covariance(step, 3.0).item() == pytest.approx(9.0 * (4.0 / 3.0 + 4.0), rel=1e-14)
    assert hinf_norm(step) == (pytest.approx(8.0 / 3.0), 0.0)  # 2 + 1/(z + ½) at z = 1
    assert hinf_norm(control.ss([[-0.5]], 1, -1, 2.0, 0.1)) == (pytest.approx(4.0), pytest.approx(10.0 * pi))
    assert hinf_norm(control.ss([], [], [], [[3.0, 4.0]]))[0] == 5.0
    assert h2_norm(control.ss([], [], [], [[3.0, 4.0]], True)) == 5.0


@pytest.mark.parametrize("seed", range(6))
def test_systems_in_discrete_time_against_a_grid_and_the_impulse_response(seed):
    rng = np.random.default_rng(seed)
    a = rng.standard_normal((5, 5))
    a *= 0.95 / np.abs(np.linalg.eigvals(a)).max()
    b, c, d = rng.standard_normal((5, 2)), rng.standard_normal((3, 5)), rng.standard_normal((3, 2)) * (seed % 2)
    system = control.ss(a, b, c, d, 0.2)
    pulses, state = [d], b
    for _ in range(900):
        pulses, state = [*pulses, c @ state], a @ state
    assert h2_norm(system) == pytest.approx(np.linalg.norm(pulses), rel=1e-10)
    circle = np.exp(1j * np.linspace(0.0, pi, 20_001))[:, None, None]
    largest = np.linalg.norm(c @ np.linalg.solve(circle * np.eye(5) - a, b) + d, 2, axis=(1, 2)).max()
    norm, peak = hinf_norm(system)
    assert largest * (1.0 - 1e-12) <= norm < largest * (1.0 + 1e-4)
    assert np.linalg.norm(system(np.exp(0.2j * peak)), 2) == pytest.approx(norm, rel=1e-9)


def test_maps_have_the_norms_of_their_own_time():
    """S4: the map of a lone agent, against python-control in discrete time."""
    law = Algorithm2(gains=Gains(c1_gamma=4.0, c2_gamma=3.0), target=StaticTarget((0.0,)))
    system = linearise(TaylorStep(law, 0.1), [[0.0]]).state_space
    assert h2_norm(system) == pytest.approx(control.norm(system, 2, method="scipy"), rel=1e-9)


@pytest.mark.parametrize("time", [1e-9, 1e-6, 1.0, 1e6])
def test_units_of_time_change_norms_by_their_power_alone(time):
    """S5: h2 is in length over force, times the square root of a rate."""
    law = Algorithm2(target=ORIGIN)
    q = find_equilibrium(law, hexagonal_spiral(7, 7.0)).q
    flock = law_blocks(law, q)
    other = blocks(flock.stiffness / time**2, flock.damping / time, q)
    assert h2_norm(disturbance_system(other)) / time**1.5 == pytest.approx(0.04182836, rel=1e-6)
    assert hinf_norm(disturbance_system(other))[0] / time**2 == pytest.approx(0.01109939, rel=1e-6)


@pytest.mark.parametrize("drag", [1e-11, 1e-6, 1.0])
def test_a_pair_that_is_hardly_damped_has_the_norm_of_its_oscillator(drag):
    """S5: 1/√(2 d k) of their distance over √2."""
    flock = law_blocks(Algorithm1(gains=Gains(c2_alpha=drag)), [[0.0, 0.0], [7.0, 0.0]])
    k, d = 2.0 * flock.stiffness[0, 0], 2.0 * flock.damping[0, 0]
    assert h2_norm(disturbance_system(flock)) == pytest.approx(1.0 / sqrt(2.0 * d * k), rel=1e-4)


def test_unstable_and_integrating_systems_have_no_norm():
    for system in (oscillator(1.0, -0.1), oscillator(1.0, 0.0), oscillator(0.0, 1.0)):
        assert (h2_norm(system), hinf_norm(system)[0]) == (inf, inf)


@pytest.mark.parametrize("law", [Algorithm1(), Algorithm2(target=ORIGIN)])
def test_against_python_control(law):
    """Its scipy fallback for H₂ and its bisection for H∞ (tolerance 1e-6), on a flock of seven."""
    system = disturbance_system(law_blocks(law, find_equilibrium(law, hexagonal_spiral(7, 7.0)).q))
    assert h2_norm(system) == pytest.approx(control.norm(system, 2, method="scipy"), rel=1e-9)
    more = system.ninputs - system.noutputs  # its fallback takes as many outputs as inputs only (control 0.10.2)
    square = control.ss(system.A, system.B, np.vstack([system.C, np.zeros((more, system.nstates))]), 0.0)
    assert hinf_norm(system)[0] == pytest.approx(control.norm(square, "inf", method="scipy"), rel=3e-6)


def test_the_quotient_is_exact():
    """What is left of the spectrum is the whole, less one zero for each neutral or drifting motion."""
    for law, gone in ((Algorithm1(), 5), (Algorithm2(target=ORIGIN), 1)):
        flock = law_blocks(law, find_equilibrium(law, hexagonal_spiral(7, 7.0)).q)
        every, left = np.linalg.eigvals(flock.matrix()), np.linalg.eigvals(flock.quotient()[0])
        assert len(every) - len(left) == gone
        every = every[np.argsort(np.abs(every))]
        assert np.abs(every[:gone]).max() < 1e-5
        np.testing.assert_allclose(np.sort_complex(every[gone:].round(8)), np.sort_complex(left.round(8)), atol=1e-6)
        assert left.real.max() < 0.0


def test_norms_grow_with_the_flock():
    table = norms_against_size(Algorithm2(target=ORIGIN), [3, 7, 12])
    assert table.sizes == (3, 7, 12)
    assert np.all(np.diff(table.h2) > 0.0)
    assert np.all(np.diff(table.hinf) > 0.0)
    np.testing.assert_allclose(table.h2, [0.02118798, 0.04182836, 0.06465914], rtol=1e-6)  # frozen: our own values
    np.testing.assert_allclose(table.hinf, [0.00683181, 0.01109939, 0.01846696], rtol=1e-6)


def test_per_agent_gains_keep_one_neutral_rotation():
    law = Algorithm2(target=ORIGIN, gains=Gains(c1_gamma=np.linspace(0.5, 2.0, 7), c2_gamma=np.linspace(3.0, 1.0, 7)))
    flock = law_blocks(law, find_equilibrium(law, hexagonal_spiral(7, 7.0)).q)
    assert (flock.neutral.shape[1], flock.drifting.shape[1]) == (1, 0)
    assert 0.0 < h2_norm(disturbance_system(flock)) < inf


test_refusals = refused(
    (lambda: law_blocks(Algorithm1(), [[0.0], [6.0]]), "no equilibrium: residual force .* finds one"),
    (lambda: law_blocks(Algorithm3(target=ORIGIN), [[0.0, 0.0]]), "expected Algorithm1 or Algorithm2"),
    (lambda: law_blocks(Algorithm1(), np.zeros((1001, 2))), "n m = 2002: expected at most 2000"),
    (lambda: law_blocks(Algorithm2(target=ORIGIN), [[0.0]]), "the target has 2 components"),
    (lambda: norms_against_size(Algorithm1(), [0]), "sizes = 0"),
)


def test_one_agent_has_no_shape():
    system = disturbance_system(law_blocks(Algorithm2(target=ORIGIN), [[0.0, 0.0]]))
    assert (h2_norm(system), hinf_norm(system)) == (0.0, (0.0, 0.0))


def test_an_ensemble_of_noisy_runs_has_the_power_that_the_h2_norm_says():
    """Two agents in the plane and the γ-agent, 24 seeds: the shape's power with its interval, four standard errors."""
    law = Algorithm2(target=StaticTarget((0.0, 0.0)))
    q = find_equilibrium(law, [[0.0, 0.0], [7.0, 0.0]]).q
    flock, s = law_blocks(law, q), 0.05
    predicted = (s * h2_norm(disturbance_system(flock))) ** 2
    away = np.eye(q.size) - flock.rigid @ flock.rigid.T
    powers = []
    for seed in range(24):
        noisy, times = Disturbed(law, intensity=s, seed=seed), np.arange(4.0, 12.0, 0.1)
        run = simulate(noisy, q, 0.0 * q, (0.0, 12.0), dt=0.005, t_eval=times)
        shape = (run.q - q).reshape(len(run.t), -1) @ away
        powers.append(np.mean(np.sum(shape**2, axis=1)))
    error = np.std(powers, ddof=1) / np.sqrt(len(powers))
    assert abs(np.mean(powers) - predicted) < 4.0 * error
    assert error < 0.1 * predicted
