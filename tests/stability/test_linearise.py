"""Linearisation about an equilibrium: matrices, frames, python-control systems, limits, and what is refused."""

from dataclasses import dataclass
from math import pi, sqrt

import control
import numpy as np
import pytest
from scipy.linalg import expm

from flockana import (
    Algorithm3,
    DeadZoneFlocking,
    DeadZoneInteraction,
    Law,
    Sphere,
    Wall,
    find_equilibrium,
    linearise,
    pair_law,
    rescale,
    simulate,
)
from flockana.base.errors import ArgumentError
from flockana.environment.targets import CircleTarget, LinearTarget, StaticTarget
from flockana.equilibria.potential import Potential
from flockana.equilibria.solve import finish
from flockana.interactions import AlphaInteraction, Gains
from flockana.lattice import hexagonal_patch
from flockana.laws.olfati_saber import Algorithm1, Algorithm2
from tests.refused import refused

HEXAGON = hexagonal_patch(1, 7.0)
STILL = StaticTarget((1.0, -2.0))
ALPHA = AlphaInteraction()


def pair_force(s):
    """φ_α(z(s)) s/√(1 + εs²) of a pair at distance s with the default parameters; s may be complex."""
    z = (np.sqrt(1.0 + 0.1 * s * s) - 1.0) / 0.1
    rho = 0.5 * (1.0 + np.cos(pi * (z / ALPHA.r_alpha - 0.2) / 0.8))
    x = z - ALPHA.d_alpha
    return rho * 5.0 * x / np.sqrt(1.0 + x * x) * s / np.sqrt(1.0 + 0.1 * s * s), rho


def strongest():
    """The largest pair force, by a search over the lengths."""
    return max(abs(float(pair_force(s)[0])) for s in np.linspace(0.0, 8.4, 20_001))


def assert_same_spectrum(found, expected, tol):
    assert len(found) == len(expected)
    left = list(expected)
    for value in found:
        k = int(np.argmin(np.abs(np.array(left) - value)))
        assert abs(left.pop(k) - value) < tol


def test_the_spectrum_of_seven_agents_is_that_of_the_law_s_jacobian():
    law = Algorithm2(target=STILL, gains=Gains(c1_gamma=1.1, c2_gamma=3.0))  # apart from critical damping
    found = linearise(law, find_equilibrium(law, HEXAGON))
    np.testing.assert_array_equal(found.A, law.jacobian(0.0, found.q, 0.0 * found.q))
    values = np.linalg.eigvals(found.A)
    assert_same_spectrum(found.eigenvalues, values, 1e-10)
    off = np.sort(-values.real)[1:]  # one zero mode, the rotation
    assert found.decay_rate == pytest.approx(off[0], rel=1e-10)
    assert found.spectral_abscissa == -found.decay_rate
    # the centre is slower than the shape: λ² + 3λ + 1.1
    assert found.decay_rate == pytest.approx(1.5 - sqrt(2.25 - 1.1), rel=1e-12)
    centre = 1.5 + np.array([-1.0, 1.0])[:, None] * sqrt(2.25 - 1.1)
    shape = off[np.all(np.abs(off - centre) > 1e-6, axis=0)]
    assert len(shape) == 28 - 1 - 4
    assert found.structural_decay_rate == pytest.approx(shape[0], rel=1e-9)


def test_the_nonlinear_flock_follows_to_first_order_and_ends_at_the_limit():
    law = Algorithm2(target=STILL, gains=Gains(c1_alpha=3.0, c2_alpha=2.0))
    found = linearise(law, find_equilibrium(law, HEXAGON))
    rng = np.random.default_rng(3)
    dq, dp = rng.standard_normal((2, 7, 2))
    state = np.concatenate([dq.ravel(), dp.ravel()])
    errors = []
    for size in (1e-3, 1e-4):
        run = simulate(law, found.q + size * dq, size * dp, (0.0, 1.0), rtol=1e-12, atol=1e-14)
        linear = size * (expm(found.A) @ state)[:14].reshape(7, 2)
        errors.append(np.abs(run.q[-1] - found.q - linear).max() / size)
    assert errors[0] < 1e-2
    assert errors[0] / errors[1] == pytest.approx(10.0, rel=0.05)  # what is left is of second order
    end = expm(60.0 * found.A) @ state
    np.testing.assert_allclose(end[:14].reshape(7, 2), found.limit(dq, dp), atol=1e-10)
    np.testing.assert_allclose(end[14:], 0.0, atol=1e-10)
    (turn,) = found.zero_modes
    along = found.limit(dq, dp)
    np.testing.assert_allclose(along, np.vdot(turn.shape, along) * turn.shape, atol=1e-14)
    np.testing.assert_allclose(found.limit(turn.shape, 0.0 * dp), turn.shape, atol=1e-12)


def test_the_limit_of_a_damped_free_flock_and_of_one_without_zero_modes():
    """With c1γ = 0 the centre coasts to q_c + p_c/c2γ."""
    law = Algorithm2(target=STILL, gains=Gains(c1_gamma=0.0, c2_gamma=4.0))
    found = linearise(law, find_equilibrium(law, HEXAGON))
    push = np.tile([2.0, -1.0], (7, 1))
    np.testing.assert_allclose(found.limit(0.0 * push, push), push / 4.0, atol=1e-12)
    alone = linearise(Algorithm2(target=STILL), [[1.0, -2.0]])
    np.testing.assert_array_equal(alone.limit([[1.0, 1.0]], [[3.0, 0.0]]), [[0.0, 0.0]])


def test_a_drifting_flock_has_no_limit():
    found = linearise(Algorithm1(), HEXAGON)
    with pytest.raises(ArgumentError, match=r"drift \(translation x, translation y\).*subtract the mean"):
        found.limit(0.0 * HEXAGON, 0.0 * HEXAGON)
    with pytest.raises(ArgumentError, match=r"dq has shape \(1, 2\): expected \(7, 2\)"):
        found.limit([[0.0, 0.0]], [[0.0, 0.0]])


@pytest.mark.parametrize(
    "target", [LinearTarget((1.0, -2.0), (5.0, 1.0)), CircleTarget((1.0, -2.0), 20.0, frequency=0.1)]
)
def test_algorithm_2_is_linearised_in_the_frame_of_the_centre_for_any_motion(target):
    still = linearise(Algorithm2(target=STILL), find_equilibrium(Algorithm2(target=STILL), HEXAGON))
    law = Algorithm2(target=target)
    moving = linearise(law, still.q, t=3.0)
    np.testing.assert_array_equal(moving.p, np.tile(target.rate(3.0), (7, 1)))
    np.testing.assert_allclose(moving.A, still.A, rtol=0.0, atol=1e-12 * np.abs(still.A).max())
    assert moving.residual < 1e-13


def test_algorithm_3_is_linearised_where_its_gamma_agent_moves_steadily():
    law = Algorithm3(target=LinearTarget((1.0, -2.0), (5.0, 1.0)))
    found = linearise(law, find_equilibrium(law, HEXAGON))
    np.testing.assert_array_equal(found.p, np.tile([5.0, 1.0], (7, 1)))
    assert [mode.name for mode in found.zero_modes] == ["rotation"]
    still = Algorithm3(target=STILL)
    np.testing.assert_allclose(found.A, linearise(still, found.q).A, rtol=0.0, atol=1e-11 * np.abs(found.A).max())
    round_ = Algorithm3(target=CircleTarget((1.0, -2.0), 20.0, frequency=0.1))
    at = find_equilibrium(round_, HEXAGON)
    with pytest.raises(ArgumentError, match=r"Jacobian of Algorithm3 changes along the motion.*allow_residual"):
        linearise(round_, at)
    assert linearise(round_, at, allow_residual=True).residual < 1e-9


def test_algorithm_3_at_a_wall_has_no_zero_modes_and_no_split():
    law = Algorithm3(target=STILL, obstacles=(Wall((-6.0, 0.0), (1.0, 0.0)), Sphere((1.0, -14.0), 2.0)))
    found = linearise(law, find_equilibrium(law, HEXAGON + np.array([4.0, 0.0])))
    assert found.zero_modes == ()
    assert found.decay_rate > 0.0
    assert found.law.obstacle_field.links(found.q, found.p).agent.size
    for system in ("structural", "translational", "structural_decay_rate"):
        with pytest.raises(ArgumentError, match=r"Algorithm3 does not split.*no gains that differ"):
            getattr(found, system)


def test_unequal_gains_do_not_split():
    law = Algorithm2(target=STILL, gains=Gains(c1_gamma=np.linspace(0.9, 1.1, 7), c2_gamma=2.0))
    found = linearise(law, find_equilibrium(law, HEXAGON))
    assert [mode.name for mode in found.zero_modes] == ["rotation"]
    assert_same_spectrum(found.eigenvalues, np.linalg.eigvals(found.A), 1e-9)
    with pytest.raises(ArgumentError, match="Algorithm2 does not split"):
        found.structural  # noqa: B018
    equal = Algorithm2(target=STILL, gains=Gains(c1_gamma=np.full(7, 1.0), c2_gamma=2.0))
    assert linearise(equal, find_equilibrium(equal, HEXAGON)).translational.nstates == 4


# ---- python-control -------------------------------------------------------------------------------------------------


def gain(system, s, output, given):
    """One entry of the transfer matrix at s, by name."""
    return system(s)[system.output_labels.index(output), system.input_labels.index(given)]


def test_the_systems_are_labelled_and_agree_with_each_other():
    law = Algorithm2(target=STILL)
    found = linearise(law, find_equilibrium(law, HEXAGON))
    whole, shape, centre = found.state_space, found.structural, found.translational
    assert isinstance(whole, control.StateSpace)
    np.testing.assert_array_equal(whole.A, found.A)
    assert whole.state_labels[:3] + whole.state_labels[-1:] == ["q0_x", "q0_y", "q1_x", "p6_y"]
    assert whole.input_labels[:2] + whole.input_labels[14:] == ["f0_x", "f0_y", "qr_x", "qr_y", "pr_x", "pr_y"]
    assert whole.output_labels[:3] == ["qc_x", "qc_y", "x0_x"]
    assert whole.output_labels[16:] == [f"l{i}_{j}" for i, j in found.links.tolist()]
    assert (shape.nstates, centre.nstates) == (24, 4)
    assert centre.state_labels == ["qc_x", "qc_y", "pc_x", "pc_y"]
    poles = np.concatenate([shape.poles(), centre.poles()])
    assert_same_spectrum(poles, whole.poles(), 1e-6)  # critical damping is double: good to √(rounding)
    s = 0.3 + 2.0j
    for output, given in (("x3_y", "f5_x"), ("x6_x", "f6_x"), ("l0_1", "f2_y")):
        assert gain(whole, s, output, given) == pytest.approx(gain(shape, s, output, given), abs=1e-12)
    for given in ("f5_x", "qr_x", "pr_x", "qr_y"):
        assert gain(whole, s, "qc_x", given) == pytest.approx(gain(centre, s, "qc_x", given), abs=1e-12)
        assert abs(gain(whole, s, "x0_x", "qr_x")) < 1e-13  # the γ-agent does not touch the shape
    # the derived transfer functions: c1/(s² + c2 s + c1), c2/(…), (1/n)/(…)
    c1, c2 = 1.1, 2.0 * sqrt(1.1)
    for given, numerator in (("qr_x", c1), ("pr_x", c2), ("f5_x", 1.0 / 7.0)):
        assert gain(centre, s, "qc_x", given) == pytest.approx(numerator / (s * s + c2 * s + c1), rel=1e-12)


def test_outputs_measure_what_they_say():
    found = linearise(Algorithm1(), HEXAGON)
    system = found.state_space
    assert "qr_x" not in system.input_labels
    step = 1e-6 * np.random.default_rng(0).standard_normal((7, 2))
    out = dict(zip(system.output_labels, system.C @ np.concatenate([step.ravel(), np.zeros(14)]), strict=True))
    after = HEXAGON + step
    assert out["qc_y"] == pytest.approx(step.mean(axis=0)[1], rel=1e-9)
    assert out["x4_x"] == pytest.approx((step - step.mean(axis=0))[4, 0], rel=1e-9)
    for i, j in found.links.tolist():
        longer = np.linalg.norm(after[j] - after[i]) - np.linalg.norm(HEXAGON[j] - HEXAGON[i])
        assert out[f"l{i}_{j}"] == pytest.approx(longer, abs=1e-11)


def test_algorithm_3_tells_how_its_gamma_agent_pulls():
    """A static push on q_r far away moves a lone agent as far; σ₁ softens nothing at the equilibrium itself."""
    law = Algorithm3(target=STILL, gains=Gains(c1_gamma=2.0, c2_gamma=3.0))
    system = linearise(law, [[1.0, -2.0]]).state_space
    assert gain(system, 0.0, "qc_x", "qr_x") == pytest.approx(1.0)
    off = linearise(law, [[1.75, -2.0]], allow_residual=True).state_space  # 1/√(1 + x²) = 0.8: 0.8³ along, 0.8 across
    np.testing.assert_allclose(off.B[2:, 2:4], np.diag([2.0 * 0.8**3, 2.0 * 0.8]), rtol=1e-14)


def test_links_may_be_given():
    found = linearise(Algorithm1(), HEXAGON, links=[[1, 4]])
    assert found.state_space.output_labels[-1] == "l1_4"
    with pytest.raises(ArgumentError, match="links"):
        linearise(Algorithm1(), HEXAGON, links=[[0, 9]])


# ---- what is refused ------------------------------------------------------------------------------------------------


def test_a_state_that_is_no_equilibrium_is_refused_with_its_residual():
    q = [[0.0, 0.0], [7.5, 0.0]]
    expected = float(pair_force(7.5)[0]) / strongest()
    with pytest.raises(ArgumentError, match=f"no equilibrium of Algorithm1: its residual is {expected:.3g}, .*1e-09"):
        linearise(Algorithm1(), q)
    found = linearise(Algorithm1(), q, allow_residual=True)
    assert found.residual == pytest.approx(expected, rel=1e-6)  # the scale is a grid's greatest value
    assert linearise(Algorithm1(), q, force_tolerance=1.1 * expected).residual == found.residual
    np.testing.assert_array_equal(found.A, Algorithm1().jacobian(0.0, q, np.zeros((2, 2))))


def test_agents_that_move_against_each_other_are_no_equilibrium():
    """Here even without a force: the velocity alone, 2 in √(force scale · d)."""
    law = Algorithm1(gains=Gains(c2_alpha=0.0))
    p = np.zeros((7, 2))
    p[0] = [2.0 * 7.0 / 6.0, 0.0]
    residual = 2.0 / sqrt(30.0 * strongest() * 7.0)
    with pytest.raises(ArgumentError, match=f"its residual is {residual:.3g}"):
        linearise(law, HEXAGON, p)


@dataclass(frozen=True)
class Spring(Law):
    """Two agents on a line and a spring between unit vectors: coincident agents have no direction."""

    swing: float = 0.0

    def flow(self, t, q, p):
        gap = q[1] - q[0]
        pull = gap - gap / np.linalg.norm(gap)
        return np.array([pull, -pull]) + self.swing * np.sin(t), float("nan")

    def jacobian(self, t, q, p, *, sparse=False):
        from scipy.sparse import csr_array

        K = np.array([[1.0, -1.0], [-1.0, 1.0]]) * (1.0 if q[0] != q[1] else np.nan)
        return csr_array(np.block([[np.zeros((2, 2)), np.eye(2)], [-K, -0.1 * np.abs(K)]]))


def test_any_law_with_a_jacobian_will_do():
    found = linearise(Spring(), [[0.0], [1.0]])
    assert found.links.shape == (0, 2)
    assert_same_spectrum(found.eigenvalues, np.linalg.eigvals(found.A), 1e-12)
    assert found.state_space.noutputs == 3
    with pytest.raises(ArgumentError, match="Spring: its residual is 1,"):
        linearise(Spring(), [[0.0], [2.0]])


def test_coincident_agents_are_named_where_the_law_is_not_differentiable():
    with pytest.raises(ArgumentError, match="Spring has no Jacobian at this state, where agents 0 and 1 are 0 apart"):
        linearise(Spring(), [[3.0], [3.0]])
    # the σ-norm is smooth at zero: under Algorithm 1 two agents at one place are an equilibrium, a repulsive one
    with np.errstate(all="raise"):
        found = linearise(Algorithm1(), [[0.0], [0.0]])
    assert found.decay_rate < 0.0


test_other_bad_input = refused(
    (lambda: linearise("law", HEXAGON), "expected a law such as"),
    (lambda: linearise(Algorithm2(target=STILL), [[0.0]]), "expected equal dimensions"),
    (lambda: linearise(Algorithm1(), HEXAGON, [[0.0, 0.0]]), "expected equal shapes"),
    (lambda: linearise(Algorithm1(), HEXAGON, zero=0.0), "zero = 0: expected a number > 0"),
)


def test_a_dense_matrix_that_would_not_fit_is_refused_before_it_is_allocated():
    """Half a million agents out of range of each other; the sparse matrix is there all the same."""
    found = linearise(Algorithm1(), np.arange(500_000.0)[:, None] * 10.0)
    assert found.A_sparse.shape == (1_000_000, 1_000_000)
    for name in ("A", "modes", "eigenvalues", "zero_modes", "state_space", "structural"):
        with pytest.raises(ArgumentError, match=r"A of shape \(1000000, 1000000\) would take 8e\+12 bytes.*A_sparse"):
            getattr(found, name)


@pytest.mark.parametrize("time", [1e-6, 1.0, 1e6])
def test_a_motion_that_is_not_steady_is_refused_in_every_unit_of_time(time):
    """K is 1/time², and beside the ones of A it may be nothing: it is compared with itself."""
    law, line = (
        rescale(Algorithm3(target=target), time=time)
        for target in (CircleTarget((1.0, -2.0), 20.0, frequency=0.1), LinearTarget((1.0, -2.0), (5.0, 1.0)))
    )
    with pytest.raises(ArgumentError, match="Jacobian of Algorithm3 changes along the motion"):
        linearise(law, find_equilibrium(law, HEXAGON))
    assert linearise(line, find_equilibrium(line, HEXAGON)).residual < 1e-9


@pytest.mark.parametrize("gap", [3e-6, 1e-7, 1e-8, -1e-8])
def test_a_link_that_lets_go_at_r_is_a_soft_mode_as_the_equilibrium_says(gap):
    """Two coincident pairs at distance r, from which side the solver came: four directions fall, and no fifth."""
    x = 8.4 * (1.0 - gap)
    found = finish(Potential(Algorithm1()), np.array([[0.0, 0.0], [0.0, 0.0], [x, 0.0], [x, 0.0]]), True, "given")
    flock = linearise(Algorithm1(), found)
    assert (found.index, found.zero_modes) == (4, 1)
    assert sum(mode.name.startswith("soft") for mode in flock.zero_modes) == 1
    assert sum(mode.decay_rate < 0.0 for mode in flock.modes) == 4


KINKED = Algorithm1(
    pair_law(
        "(1+k)*(s-d)**2/2 + k*Abs(s-d)*(s-d)", range=6.0, length=2.0, parameters={"k": 0.2}, adjacency="(1-s/r)**2"
    )
)


def test_a_kink_is_refused_and_each_side_has_its_own_stiffness():
    """S6: V'' = 1 + k ∓ 2k on the sides of d, times the gain; the pair swings by k₁ + k₁ = 2 k₁ along it."""
    with pytest.raises(ArgumentError, match="agents 0 and 1 are 2 apart, where the pair law has no slope"):
        linearise(KINKED, [[0.0, 0.0], [2.0, 0.0]])
    for side, stiffness in (("inner", 0.8), ("outer", 1.6)):
        found = linearise(KINKED, [[0.0, 0.0], [2.0, 0.0]], side=side)
        assert found.stiffness[0, 0] == pytest.approx(KINKED.gains.c1_alpha * stiffness, rel=1e-9)
        assert [mode.name for mode in found.zero_modes] == ["translation x", "translation y", "rotation"]
        assert found.q.tolist() == [[0.0, 0.0], [2.0, 0.0]]
    with pytest.raises(ArgumentError, match=r"side.*'left'"):
        linearise(KINKED, [[0.0, 0.0], [2.0, 0.0]], side="left")


def test_a_kink_elsewhere_or_a_pair_beside_it_is_smooth():
    far = linearise(KINKED, [[0.0, 0.0], [2.0 * (1.0 + 1e-8), 0.0]], allow_residual=True)
    assert far.stiffness[0, 0] == pytest.approx(KINKED.gains.c1_alpha * 1.6, rel=1e-6)
    assert linearise(Algorithm1(), [[0.0], [7.0]], side="inner").decay_rate > 0.0  # no kink: the side does not matter


def test_a_jump_of_the_force_has_a_side_at_rest_alone():
    """The dead zone with its printed jumps: at its edge the force is 0 inside, and pushes at once outside."""
    law = DeadZoneFlocking(interaction=DeadZoneInteraction(ramp=0.0, k1=0.0))
    q = [[0.0, 0.0], [law.interaction.d1, 0.0]]
    with pytest.raises(ArgumentError, match=r"apart, where .* jumps at s = 3.5"):
        linearise(law, q)
    assert abs(linearise(law, q, side="outer").stiffness).max() == 0.0
    with pytest.raises(ArgumentError, match="no equilibrium"):
        linearise(law, q, side="inner")
