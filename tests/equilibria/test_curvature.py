"""Signs of curvatures against normal forms with a known answer, at links that let go, at kinks, and in every unit."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.sparse import csr_array

import flockana as fl
from flockana import Algorithm3, DeadZoneFlocking, DeadZoneInteraction, StaticTarget, Wall, rescale
from flockana.base.errors import SolverError
from flockana.equilibria.classify import falling, landscape, spectrum
from flockana.equilibria.curvature import Landscape, descent_direction, least_curvature
from flockana.equilibria.final_state import rigid_motions, surroundings, terminal_state
from flockana.equilibria.potential import Potential
from flockana.equilibria.solve import find_equilibrium, finish
from flockana.lattice import hexagonal_patch, hexagonal_spiral
from flockana.laws.olfati_saber import Algorithm1, Algorithm2
from flockana.sources.geschwender_2016.theorems.e03_strained_limits import rhombus_with_double_agent

UNITS = [(1.0, 1.0), (1e-6, 1e3), (1e3, 1e-3)]
LAW = Algorithm1()


def cubic(curvature, bend, force, length=1.0):
    """One agent on a line in U = ½ curvature x² + ⅙ bend x³, with that force left."""
    here, rigid, unit = np.zeros((1, 1)), np.zeros((1, 0)), abs(curvature) * length
    stiffness = lambda q: csr_array([[curvature + bend * q[0, 0]]])  # noqa: E731
    return Landscape(stiffness, here, rigid, force=force, length=length, unit=unit)


@given(st.floats(-3.0, 3.0), st.floats(-6.0, -1.0), st.sampled_from([-1.0, 1.0]))
@settings(max_examples=60, deadline=None)
def test_a_sign_is_given_where_the_residual_leaves_one_and_nowhere_else(log_bend, log_curvature, sign):
    """λ² = 4 L ρ is where it ends: a hundredth of that force leaves the sign, a hundred times takes it."""
    bend, curvature = 10.0**log_bend, sign * 10.0**log_curvature
    limit = curvature**2 / (4.0 * bend)
    if 100.0 * limit > 1e-3 * abs(curvature):
        return  # the critical point would be farther away than the law's own length
    assert cubic(curvature, bend, 0.01 * limit).curvatures().signs.tolist() == [int(sign)]
    assert cubic(curvature, bend, 100.0 * limit).curvatures().signs.tolist() == [0]


def test_it_is_no_stricter_than_newton_needs_by_more_than_two():
    """Half of 2Lρ = λ², beyond which there need be no critical point at all, is decided; twice it is not."""
    for ratio, sign in ((0.49, 1), (1.01, 0)):
        assert cubic(2e-3, 8.0, ratio * 2e-3**2 / (4.0 * 8.0)).curvatures().signs.tolist() == [sign]


def test_nothing_stiff_and_nothing_free():
    found = cubic(0.0, 0.0, 0.0)
    assert (found.curvatures().signs.tolist(), least_curvature(found)) == ([0], (0.0, 0.0))
    pair = surroundings(LAW, np.array([[3.0]]))
    assert np.isnan(least_curvature(pair)[0])
    assert pair.holds(1e9)  # one agent has no shape to lose


@pytest.mark.parametrize(("length", "time"), UNITS)
def test_a_link_that_lets_go_at_r_has_no_stiffness_wherever_the_solver_stops(length, time):
    """The force vanishes as (r − x)², the stiffness as r − x: below r it is negative, beyond r it is 0."""
    potential = Potential(rescale(LAW, length=length, time=time))
    r = potential.law.alpha.r
    for gap in (1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 0.0, -1e-8):
        q = np.array([[0.0], [r * (1.0 - gap)]])
        if potential.residual(q) > 1e-9:
            continue
        found = spectrum(potential, q)
        assert (found.negative, found.zero) == (0, 1), gap
        assert falling(potential, q) is None
    assert potential.residual(np.array([[0.0], [r * (1.0 - 1e-5)]])) < 1e-9  # so some of these are below r


def test_beside_a_stiff_saddle_too():
    """Two coincident pairs that just let go of each other: four directions fall, the link between them is nothing."""
    for gap in (3e-6, 1e-7, 1e-8, -1e-7):
        x = 8.4 * (1.0 - gap)
        found = finish(Potential(LAW), np.array([[0.0, 0.0], [0.0, 0.0], [x, 0.0], [x, 0.0]]), True, "given")
        assert (found.kind, found.index, found.zero_modes) == ("saddle", 4, 1)


def test_a_contact_at_a_kink_is_degenerate_on_both_sides():
    """Without a pull two agents rest where repulsion ends: stiff inside, free outside, and which side is rounding."""
    potential = Potential(DeadZoneFlocking(DeadZoneInteraction(k1=0.0)))
    for off in (-1e-12, -1e-15, 0.0, 1e-15, 1e-12):
        q = np.array([[0.0], [3.5 * (1.0 + off)]])
        assert spectrum(potential, q)[2:] == (0, 1)


@pytest.mark.slow
@pytest.mark.parametrize(("length", "time"), UNITS)
@pytest.mark.parametrize(
    ("law", "q", "method", "expected"),
    [
        (LAW, hexagonal_patch(1, 6.9), "minimise", ("minimum", 0, 0, 3)),
        (LAW, [[-7.0, 0.0], [0.0, 0.0], [7.0, 0.0]], "minimise", ("degenerate", 0, 1, 3)),
        (LAW, [[0.0, 0.0], [7.1, 0.0], [50.0, 0.0]], "minimise", ("degenerate", 0, 2, 3)),
        (LAW, np.vstack([hexagonal_spiral(3, 7.0), [[0.0, 0.0]]]), "root", ("saddle", 1, 0, 3)),
        (LAW, np.zeros((2, 2)), "root", ("maximum", 2, 0, 2)),
        (LAW, rhombus_with_double_agent(7.0), "root", ("minimum", 0, 0, 3)),
        (LAW, 7.0 * np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0]]), "minimise", ("minimum", 0, 0, 5)),
        (Algorithm2(target=StaticTarget((3.0, 1.0))), hexagonal_patch(1, 7.0), "minimise", ("minimum", 0, 0, 3)),
        (
            Algorithm3(target=StaticTarget((0.0, -5.0)), obstacles=(Wall((0.0, 0.0), (0.0, 1.0)),)),
            [[0.3, 2.0]],
            "minimise",
            ("minimum", 0, 0, 0),
        ),
        (DeadZoneFlocking(), hexagonal_patch(1, 3.5), "minimise", ("minimum", 0, 0, 3)),
        (DeadZoneFlocking(DeadZoneInteraction(k1=0.0)), [[0.0], [8.0]], "minimise", ("degenerate", 0, 1, 1)),
    ],
)
def test_an_equilibrium_is_of_one_kind_in_every_unit(law, q, method, expected, length, time):
    found = find_equilibrium(rescale(law, length=length, time=time), length * np.asarray(q), method=method)
    assert (found.kind, found.index, found.zero_modes, found.rigid_modes) == expected
    here = find_equilibrium(law, q, method=method)
    size = np.abs(here.hessian_eigenvalues).max(initial=1e-30)
    np.testing.assert_allclose(time**2 * found.hessian_eigenvalues, here.hessian_eigenvalues, atol=1e-9 * size)


@pytest.mark.parametrize("d", [7e-6, 7e-3, 7.0, 7e2])
def test_the_printed_law_at_any_distance_finds_its_lattice(d):
    """σ₁ counts in lengths of 1: beside it a small flock's forces are tiny, a large one's saturate. It is a lattice."""
    law = Algorithm1(type(LAW.alpha)(d=d, r=1.2 * d, eps=4.9 / d**2))
    start = hexagonal_patch(1, d) + 0.03 * d * np.random.default_rng(0).standard_normal((7, 2))
    found = find_equilibrium(law, start)
    assert (found.kind, len(found.links)) == ("minimum", 12)
    assert found.strain() < 1e-6
    assert law.alpha.strength <= law.alpha.b / np.sqrt(law.alpha.eps)
    assert Potential(law).residual(start) > 1e-3  # a start is none


def test_the_way_down_is_the_same_whatever_basis_a_machine_takes():
    """Two agents at one place in space fall apart in any of three directions; signs and bases are arbitrary."""
    found = landscape(Potential(LAW), np.zeros((2, 3)))
    first = descent_direction(found)
    assert np.linalg.norm(first) == pytest.approx(1.0)
    turn = np.linalg.qr(np.random.default_rng(1).standard_normal((3, 3)))[0]
    vars(found)["vectors"] = -found.vectors @ turn  # another orthonormal basis of the same eigenspace
    np.testing.assert_allclose(descent_direction(found), first, atol=1e-12)


def test_rigid_motions_in_every_unit_and_far_from_the_origin():
    line = np.array([[0.0, 0.0, 0.0], [1.0, 1.0, 1.0], [2.5, 2.5, 2.5]])
    for length in (1e-12, 1e-6, 1.0, 1e3, 1e12):
        for q, count in ((line, 5), (np.eye(3), 6), (np.zeros((2, 2)), 2)):
            assert rigid_motions(length * q).shape[1] == count
            assert rigid_motions(length * (q + 1e5 / 3.0)).shape[1] == count


def test_a_terminal_state_tells_how_well_it_knows_its_curvature():
    q = hexagonal_patch(1, 7.0)
    exact, near, far = (terminal_state(LAW, (1.0 + off) * q, 0.0 * q) for off in (0.0, 1e-7, 3e-2))
    assert exact.curvature_error < 1e-9 < near.curvature_error < 1e-3 * near.curvature
    assert far.curvature_error == far.distance == np.inf  # no equilibrium is near
    assert exact.distance < 1e-12
    moved = 1e-7 * float(np.linalg.norm(q))
    assert moved / 7.0 < near.distance < 100.0 * moved / 7.0  # 2ρ/λ, by the least λ


def test_a_minimum_holds_what_has_not_the_energy_to_leave():
    """A bond takes ψ(r) − ψ(d) to break; what is certified is less, and not by orders of magnitude."""
    around, breaks = surroundings(LAW, np.array([[0.0], [7.0]])), 30.0 * LAW.alpha.far_potential
    held = max(energy for energy in np.geomspace(1e-9, 1.0, 60) if around.holds(energy * breaks))
    assert 1e-5 < held < 1.0
    assert not around.holds(2.0 * breaks)
    assert not surroundings(LAW, np.array([[-7.0, 0.0], [0.0, 0.0], [7.0, 0.0]])).holds(0.0)  # a hinge holds nothing


def test_a_pair_at_a_kink_of_the_force_has_no_curvature_and_no_limit():
    """|s − d|^1.5 has the curvature ¾ |s − d|^−½, infinite at d: one line, and nothing said of the limit."""
    pair = fl.pair_law("abs(s - d)**1.5", adjacency="(1 - s/r)**2", range=2.0, length=1.0)
    law = fl.Algorithm1(pair)
    with pytest.raises(SolverError, match="curvature is infinite here: expected a configuration without pairs at a"):
        surroundings(law, np.array([[0.0, 0.0], [1.0, 0.0]]))
    run = fl.simulate(law, [[0.0, 0.0], [1.1, 0.0]], [[0.0, 0.01], [0.0, 0.1]], (0.0, 1.0))
    for name in ("os-1", "lattice-limit-printed", "linearised-decay-terminal"):
        assert {c.status for c in fl.verify(name, run).claims} <= {"vacuous", "inconclusive"}
