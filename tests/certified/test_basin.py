"""Certified basins: what they claim is true where algebra or a run can tell, and what has no basin is refused."""

from itertools import pairwise

import numpy as np
import pytest
from flint import arb

from flockana import DeadZoneFlocking, Gains, StaticTarget, certify, find_equilibrium, simulate
from flockana.base.errors import ArgumentError, FlockanaError
from flockana.certified.curvature_shells import SHELLS
from flockana.interactions import AlphaInteraction
from flockana.laws.olfati_saber import Algorithm1, Algorithm2
from tests.certified.conftest import ALL, STARTS, basin_of, displaced


def energy(basin, x):
    """U in floating point."""
    law, c1 = basin.law, 0.0 if basin.law.target is None else basin.law.gains.c1_gamma
    i, j = np.triu_indices(len(x), 1)
    lengths = np.linalg.norm(x[j] - x[i], axis=1)
    return law.gains.c1_alpha * float(law.alpha.energy(lengths).sum()) + 0.5 * c1 * float((x**2).sum())


def force(basin, x):
    """−∇U."""
    still = np.zeros_like(x)
    return basin.law.flow(0.0, x, still)[0] - basin.law.flow(0.0, x, still)[0].mean(axis=0)


@pytest.mark.parametrize("algorithm", [1, 2])
def test_two_agents_are_a_potential_on_a_line(algorithm):
    """U(ℓ) = c1α ψ_α(‖ℓ‖_σ) + ¼ c1γ ℓ²; a distance δ from the orbit is a stretch by √2 δ."""
    basin = basin_of("pair", algorithm)
    rest = float(np.linalg.norm(basin.rest[1] - basin.rest[0]))
    ends = [basin.rest * (1.0 + sign * np.sqrt(2.0) * float(basin.radius) / rest) for sign in (-1.0, 1.0)]
    rises = [energy(basin, x) - energy(basin, basin.rest) for x in ends]
    assert 0.0 < float(basin.level) < min(rises)
    assert float(basin.level) > 0.6 * min(rises)  # and no less than shells and slack cost
    assert 0.06 < basin.share < (basin.law.alpha.r - rest) / np.sqrt(2.0) / basin.law.alpha.d
    assert float(basin.distance) == pytest.approx(rest - np.sqrt(2.0) * float(basin.radius), abs=2e-3)
    weight = basin.law.alpha.adjacency(basin.law.alpha.sigma_norm(rest + np.sqrt(2.0) * float(basin.radius)))
    damping = 2.0 * weight * basin.law.gains.c2_alpha + (algorithm == 2) * basin.law.gains.c2_gamma
    assert 0.99 * damping < float(basin.damping) <= damping


@ALL
def test_no_sampled_curvature_slope_or_energy_is_below_what_is_proved(basin):
    rng, step = np.random.default_rng(0), float(basin.radius) / SHELLS
    curvatures = [float(k.p) / float(k.q) for k in basin.proof.shells.curvatures]
    at_rest, least = energy(basin, basin.rest), float(basin.curvature)
    slack = []
    for shell in [*range(SHELLS)] * 3:
        t = step * (shell + rng.uniform())
        w = displaced(basin, t / float(basin.radius), rng)
        x = basin.rest + w
        unit = w.ravel() / t
        hessian = basin.law.stiffness(x)
        curvature = float(unit @ (hessian @ unit))
        slack.append(curvature - curvatures[shell])
        assert slack[-1] > 0.0
        assert -float((force(basin, x) * w).sum()) >= least * t**2
        assert energy(basin, x) - at_rest >= 0.5 * least * t**2
    assert all(b <= a for a, b in pairwise(curvatures))


@ALL
def test_starts_in_the_basin_end_in_the_orbit_no_slower_than_promised(basin):
    rng = np.random.default_rng(1)
    x = basin.rest + displaced(basin, 0.9, rng)
    assert not basin.holds(basin.rest + displaced(basin, 1.001, rng), np.zeros_like(x))
    excess = energy(basin, x) - energy(basin, basin.rest)
    v = rng.standard_normal(x.shape)
    v -= v.mean(axis=0)
    spare = float(basin.level) - excess
    x, spare = (x, spare) if spare > 0.0 else (basin.rest.copy(), float(basin.level))
    v *= np.sqrt(2.0 * 0.98 * spare) / np.linalg.norm(v)
    assert basin.holds(x, v)
    run = simulate(basin.law, x, v, (0.0, 4.0), rtol=1e-10, atol=1e-12)
    first = basin.above(run.q[0], run.p[0])[1]
    for k in np.linspace(1, len(run.t) - 1, 6).astype(int):
        distance, left = basin.above(run.q[k], run.p[k])
        assert distance < basin.radius.numerator / basin.radius.denominator
        bound = float(basin.overshoot) * float(first) * np.exp(-2.0 * float(basin.rate) * run.t[k])
        assert float(left) <= bound + 1e-9
    assert basin.holds(run.q[-1], run.p[-1])


@pytest.mark.parametrize("name", ["triangle", "tetrahedron"])
def test_a_start_is_seen_from_any_side_and_a_mirror_image_is_another_orbit(name):
    basin = basin_of(name, 2)
    m, rng = basin.rest.shape[1], np.random.default_rng(2)
    turn = np.linalg.qr(rng.standard_normal((m, m)))[0]
    turn[:, 0] *= np.linalg.det(turn)
    x, still = basin.rest + displaced(basin, 0.3, rng), np.zeros_like(basin.rest)
    distance, above = basin.above(x, still)
    assert float(distance) == pytest.approx(0.3 * float(basin.radius), rel=1e-12)
    assert float(above) == pytest.approx(energy(basin, x) - energy(basin, basin.rest), rel=1e-9)
    moved = basin.above(x @ turn.T + 100.0, still + [5.0] * m)
    assert [float(y) for y in moved] == pytest.approx([float(distance), float(above)], rel=1e-9)
    mirrored = basin.rest * ([-1.0] + [1.0] * (m - 1))
    assert not basin.holds(mirrored, still)
    assert basin.holds(basin.rest, still)


def test_only_what_is_below_both_bounds_is_in():
    basin = basin_of("triangle", 1)
    fast = np.zeros((3, 2))
    fast[:, 0] = [1.0, -1.0, 0.0]
    level = float(basin.level)
    assert basin.holds(basin.rest, fast * np.sqrt(0.999 * level))  # ½‖v‖² = 0.999 ΔH
    assert not basin.holds(basin.rest, fast * np.sqrt(1.001 * level))
    with pytest.raises(ArgumentError, match=r"q has shape \(2, 2\): expected \(3, 2\)"):
        basin.holds(basin.rest[:2], fast)


LAW, PAIR, HINGE = Algorithm1(), STARTS["pair"], [[-7.0, 0.0], [0.0, 0.0], [7.0, 0.0]]  # a hinge bends freely
PER_AGENT = Algorithm2(gains=Gains(c1_gamma=(1.0, 2.0)), target=StaticTarget((0.0, 0.0)))


@pytest.mark.parametrize(
    ("q", "law", "message"),
    [
        ([[0.0, 0.0], [6.0, 0.0]], LAW, r"no equilibrium beside these positions.*find_equilibrium"),
        ([[0.0, 0.0], [7.0, 0.0], [30.0, 0.0], [37.0, 0.0]], LAW, "disconnected"),
        ([[0.0, 0.0], [7.0, 0.0], [7.0, 0.0]], LAW, "the equilibrium has coincident agents"),
        (HINGE, LAW, r"strict minimum|isolated equilibrium|no equilibrium beside"),
        ([[0.0, 0.0, 0.0], [7.0, 0.0, 0.0]], LAW, "on one line in space"),
        (PAIR, None, "law = None: expected the law"),
        (PAIR, DeadZoneFlocking(), "expected Algorithm1 or Algorithm2"),
        (PAIR, Algorithm1(alpha=AlphaInteraction(unit=2.0)), r"unit = 2: expected 1; rescale"),
        (PAIR, PER_AGENT, "given per agent"),
        (PAIR, Algorithm1(gains=Gains(c1_alpha=0.0)), "c1_alpha = 0: expected more than 0"),
        (PAIR[:1], LAW, "1 agent: expected two or more"),
        (PAIR, Algorithm1(gains=Gains(c2_alpha=0.0)), "c2_alpha = 0 and no c2_gamma: expected a gain that damps"),
    ],
)
def test_what_the_argument_does_not_cover_is_refused(q, law, message):
    with pytest.raises(FlockanaError, match=message):
        certify(q, law=law)


def test_a_saddle_is_refused():
    saddle = find_equilibrium(Algorithm2(target=StaticTarget((0.0, 0.0))), HINGE, method="root")
    assert saddle.kind == "saddle"
    with pytest.raises(ArgumentError, match="expected a strict minimum"):
        certify(saddle)


def test_a_set_of_states_is_in_the_basin_only_if_all_of_it_is():
    basin = basin_of("triangle", 2)
    still = [[arb(0)] * 2] * 3
    for width, inside in (("0.01", True), ("1", False)):
        states = [[arb(float(x)) + arb(0, width) for x in row] for row in basin.rest]
        assert basin.holds(states, still) is inside
    assert not basin.holds(basin.rest, [[arb(0, 3)] * 2] * 3)


@pytest.mark.parametrize("bad", [float("nan"), float("inf")])
def test_a_state_that_is_no_number_is_refused(bad):
    with pytest.raises(ArgumentError, match="q holds a number that is not finite"):
        basin_of("pair", 1).holds([[bad, 0.0], [7.0, 0.0]], np.zeros((2, 2)))
