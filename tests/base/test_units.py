"""The same law in other units: forces, energies, rates and derivatives change by their powers, nothing else does."""

import numpy as np
import pytest
import sympy as sp

import flockana as fl
from flockana import CallableTarget, Capsule, MinimalFlocking, Polygon, RescaledVelocity, SineTarget, rescale, symbolic
from flockana.base.natural_scales import Scales
from flockana.sources.notebook_r2.laws import PushedAlgorithm2
from tests.refused import refused

LENGTH, TIME = 1e-6, 1e3  # metres to megametres, seconds to milliseconds
ROUNDING = 1e-12

SINE = SineTarget((1.0, -2.0), (0.5, 0.1), amplitude=3.0, frequency=0.2, phase=0.3)
OBSTACLES = (
    fl.Sphere((6.0, 6.0), 2.0),
    fl.Wall((0.0, -12.0), (0.0, 1.0)),
    Capsule((-9.0, 0.0), (-9.0, 6.0), 1.0),
    Polygon([(9.0, -9.0), (12.0, -9.0), (12.0, -6.0)]),
)
LAWS = (
    fl.Algorithm1(alpha=fl.AlphaInteraction(a=1.0, b=4.0)),
    fl.Algorithm2(target=SINE),
    fl.Algorithm2(gains=fl.Gains(c1_gamma=[0.1] * 12, c2_gamma=[0.2] * 12), target=RescaledVelocity(SINE, 0.5)),
    fl.Algorithm3(target=CallableTarget(SINE.state), obstacles=OBSTACLES),
    PushedAlgorithm2(target=SINE, min_distance=2.0),
    fl.DeadZoneFlocking(),
    MinimalFlocking(radius=9.0, normalised=False, sigma=0.5, mu=2.0),
    MinimalFlocking(radius=9.0, spacing=4.0, sigma=0.0),
)


def state(seed: int = 3) -> tuple[np.ndarray, np.ndarray]:
    """Twelve agents in range of each other and of the obstacles."""
    rng = np.random.default_rng(seed)
    return rng.uniform(-8.0, 3.0, (12, 2)), rng.normal(0.0, 2.0, (12, 2))


SLOW = [pytest.param(law, marks=pytest.mark.slow) if isinstance(law, fl.Algorithm3) else law for law in LAWS]


@pytest.mark.parametrize("law", SLOW, ids=lambda law: type(law).__name__)
def test_accelerations_energies_and_derivatives_change_by_their_powers(law: fl.Law) -> None:
    q, p = state()
    there = rescale(law, length=LENGTH, time=TIME)
    t, q_there, p_there = 0.7 * TIME, LENGTH * q, LENGTH / TIME * p
    u, rate = law.flow(0.7, q, p)
    u_there, rate_there = there.flow(t, q_there, p_there)
    assert np.abs(u).max() > 0.0
    np.testing.assert_allclose(
        u_there, u * LENGTH / TIME**2, rtol=0.0, atol=ROUNDING * np.abs(u).max() * LENGTH / TIME**2
    )
    by_q, by_p = law.derivatives(0.7, q, p) if "Pushed" not in type(law).__name__ else (None, None)
    if by_q is not None:
        by_q_there, by_p_there = there.derivatives(t, q_there, p_there)
        for here, found, factor in ((by_q, by_q_there, TIME**-2), (by_p, by_p_there, 1.0 / TIME)):
            size = abs(here).max() * factor
            np.testing.assert_allclose(found.toarray(), factor * here.toarray(), rtol=0.0, atol=10.0 * ROUNDING * size)
    energy = law.hamiltonian(0.7, q, p)
    if np.isfinite(energy):
        assert there.hamiltonian(t, q_there, p_there) == pytest.approx(energy * (LENGTH / TIME) ** 2, rel=ROUNDING)
        assert rate_there == pytest.approx(rate * LENGTH**2 / TIME**3, rel=100.0 * ROUNDING)


@pytest.mark.parametrize("law", LAWS, ids=lambda law: type(law).__name__)
def test_scales_change_with_the_units(law: fl.Law) -> None:
    here, there = law.scales, rescale(law, length=LENGTH, time=TIME).scales
    assert there.length == pytest.approx(here.length * LENGTH, rel=ROUNDING)
    assert there.time == pytest.approx(here.time * TIME, rel=ROUNDING)


@pytest.mark.slow
def test_the_unit_of_sigma_1_stands_in_the_formulas_too() -> None:
    """Kernel and sympy agree on the law whose σ₁ counts in lengths of 3, and so do its vectors."""
    numbers = {"eps": 0.02, "h": 0.3, "a": 1.0, "b": 4.0, "d": 5.0, "r": 7.0, "unit": 3.0}
    alpha, symbols = fl.AlphaInteraction(**numbers), symbolic.AlphaSymbols(**numbers)
    beta, beta_symbols = fl.BetaInteraction(4.0, 5.0, 0.02, 0.5, unit=3.0), symbolic.BetaSymbols(0.02, 0.5, 4, unit=3)
    for x in (0.5, 4.0, 6.0):
        z = alpha.sigma_norm(x)
        exact = sp.Rational(float(z))
        assert alpha.phi_alpha(z) == pytest.approx(float(symbolic.phi_alpha(exact, alpha=symbols)), rel=1e-12)
        assert alpha.psi_alpha(z) == pytest.approx(float(symbolic.psi_alpha(exact, alpha=symbols).evalf(20)), rel=1e-11)
        if x < beta.d:
            assert beta.phi_beta(z) == pytest.approx(float(symbolic.phi_beta(exact, beta=beta_symbols)), rel=1e-12)
            assert beta.psi_beta(z) == pytest.approx(
                float(symbolic.psi_beta(exact, beta=beta_symbols).evalf(20)), rel=1e-11
            )
    q = np.array([[0.0, 0.0], [3.0, 2.0]])
    force = alpha.forces(q, 0.0 * q, stiffness=1.0, damping=0.0)[0][0]
    x = np.linalg.norm(q[1])
    np.testing.assert_allclose(
        force, alpha.phi_alpha(alpha.sigma_norm(x)) * q[1] / np.sqrt(1.0 + 0.02 * x**2), rtol=1e-12
    )
    law = fl.Algorithm3(
        alpha=alpha,
        beta=beta,
        gains=fl.Gains(c1_alpha=0.0, c2_alpha=0.0, c1_beta=1.0, c2_beta=0.0, c1_gamma=1.0, c2_gamma=0.0),
        target=fl.StaticTarget((0.0, 9.0)),
        obstacles=(fl.Wall((0.0, 0.0), (0.0, 1.0)),),
    )
    here = np.array([[1.0, 2.5]])
    away, gap = here[0] - [0.0, 9.0], np.array([0.0, -2.5])
    pull = -away / np.sqrt(1.0 + away @ away / 9.0)
    push = beta.phi_beta((np.sqrt(1.0 + 0.02 * 2.5**2) - 1.0) / 0.02) * gap / np.sqrt(1.0 + 0.02 * 2.5**2)
    np.testing.assert_allclose(law.flow(0.0, here, 0.0 * here)[0][0], pull + push, rtol=1e-12)


@pytest.mark.parametrize("units", [{"k": (-2, -2)}, {"k": (-2, 0)}])
@pytest.mark.parametrize("compose", [fl.Algorithm1, lambda alpha: fl.Algorithm2(alpha, target=fl.StaticTarget((9.0,)))])
def test_a_formula_has_the_time_in_its_parameters_or_in_its_gain(compose, units) -> None:
    """Once, not twice: V = k (s − 7)² (s − 9)² is a squared speed, or a squared length as ψ_α is."""
    pair = fl.pair_law(
        "k*(s-d)**2*(s-r)**2", adjacency="(1-s/r)**2", range=9.0, length=7.0, parameters={"k": 0.01}, units=units
    )
    law, length, time = compose(pair), 3.0, 1000.0
    q, p = np.array([[0.0], [5.0], [11.0]]), np.array([[1.0], [0.0], [-0.5]])
    other = rescale(law, length=length, time=time)
    u = other.acceleration(0.0, length * q, length / time * p) * time**2 / length
    np.testing.assert_allclose(u, law.acceleration(0.0, q, p), rtol=1e-12)
    energy = other.energy(0.0, length * q, length / time * p) * (time / length) ** 2
    assert energy == pytest.approx(law.energy(0.0, q, p), rel=1e-12)


def test_powers_of_two_change_nothing_but_the_exponent() -> None:
    q, p = state()
    law = fl.Algorithm2(target=SINE)
    u = law.flow(0.5, q, p)[0]
    there = rescale(law, length=2.0**-20, time=2.0**10)
    assert np.array_equal(there.flow(0.5 * 2.0**10, q * 2.0**-20, p * 2.0**-30)[0] * 2.0**40, u)


test_what_cannot_be_rescaled_says_so = refused(
    (lambda: rescale(MinimalFlocking(), time=60.0), r"rate 1 per time unit, as printed.*expected time = 1"),
)


def test_a_law_without_position_gains_takes_its_time_from_the_others() -> None:
    alpha = fl.AlphaInteraction()
    assert fl.Algorithm1(alpha, fl.Gains(c1_alpha=0.0, c2_alpha=4.0)).scales == Scales(7.0, 0.25)
    assert fl.Algorithm1(alpha, fl.Gains(c1_alpha=0.0, c2_alpha=0.0)).scales == Scales(7.0, 1.0)
    target = fl.StaticTarget((0.0,))
    assert fl.Algorithm2(alpha, fl.Gains(c1_alpha=0.0, c1_gamma=[0.0, 4.0]), target).scales == Scales(7.0, 0.5)
    strong = fl.Algorithm1(alpha, fl.Gains(c1_alpha=2.0)).scales
    assert strong.force == pytest.approx(2.0 * alpha.strength)
