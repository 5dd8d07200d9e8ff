"""Spheres in balls and in series against the library's own formulas, and a tube that passes one."""

import numpy as np
import pytest
from flint import arb, ctx

from flockana import Algorithm3, BetaInteraction, Gains, Sphere, StaticTarget, enclose, simulate
from flockana.certified import lohner
from flockana.certified.laws import flow_of, sphere_terms
from flockana.certified.series import PairNumbers, Piece

GAINS = Gains(c1_alpha=12.0, c2_alpha=3.5, c1_gamma=1.25, c2_gamma=0.75, c1_beta=40.0, c2_beta=5.0)
BETAS = [BetaInteraction(), BetaInteraction(d=2.0, r=3.0, eps=0.2, h=0.5, unit=1.5)]
LAW = Algorithm3(
    gains=Gains(c1_beta=100.0, c2_beta=20.0),
    target=StaticTarget((4.0, 2.0)),
    beta=BetaInteraction(d=1.0, r=1.25, h=0.5),
    obstacles=(Sphere((0.0, 0.0), 1.0),),
)
START = np.array([[-1.5, 1.0]]), np.array([[5.0, 4.0]])


def among(m, beta):
    spheres = (Sphere((0.5,) * m, 0.5), Sphere((3.0,) * m, 2.0))
    return Algorithm3(gains=GAINS, target=StaticTarget((1.0,) * m), beta=beta, obstacles=spheres)


def states(m):
    """Agents in the core, on the taper and out of range of spheres, and their velocities."""
    rng = np.random.default_rng(3)
    return rng.uniform(-4.0, 4.0, (5, m)), rng.normal(size=(5, m))


@pytest.mark.parametrize("beta", BETAS)
@pytest.mark.parametrize("m", [1, 2, 3])
def test_acceleration_and_jacobian_are_those_of_the_law(m, beta):
    law, (q, p) = among(m, beta), states(m)
    with ctx.workprec(100):
        flow = flow_of(law, 5, m)
        state = [arb(x) for x in (*q.ravel(), *p.ravel())]
        pieces = flow.pieces(state)
        u, slope = flow.input(arb(0), state, pieces), flow.jacobian(arb(0), state, pieces)
    assert Piece.CORE in pieces[-10:]
    np.testing.assert_allclose([float(x) for x in u], law.acceleration(0.0, q, p).ravel(), rtol=1e-11, atol=1e-11)
    found = np.array([[float(x) for x in row] for row in slope.tolist()])
    expected = law.jacobian(0.0, q, p)
    np.testing.assert_allclose(found, getattr(expected, "toarray", lambda: expected)(), rtol=1e-10, atol=1e-10)


def test_switches_are_where_the_taper_begins_and_where_the_force_ends():
    """An agent 2.5 from the surface of a sphere off the origin, going away at 0.6·2 + 0.8·1; with ε = 0, z is ½ s²."""
    beta = BetaInteraction(d=2.0, r=3.0, eps=1e-12, h=0.5)
    law = Algorithm3(target=StaticTarget((0.0, 0.0)), beta=beta, obstacles=(Sphere((4.0, -1.0), 2.5),))
    (term,) = sphere_terms(law)
    found = term.switches(np.array([4.0 + 3.0, -1.0 + 4.0]), np.array([2.0, 1.0]))
    np.testing.assert_allclose(found, [(2.5 - np.sqrt(0.5) * 2.0, 2.0), (2.5 - 2.0, 2.0)], rtol=1e-3)
    assert term.switches(np.array([4.0, -1.0]), np.array([3.0, 4.0]))[0] == pytest.approx(
        (-2.5 - np.sqrt(2.0), 5.0), rel=1e-3
    )


@pytest.mark.parametrize("beta", BETAS)
def test_taylor_coefficients_are_those_of_the_flow_and_of_its_derivative(beta):
    """Of series on each piece: the force's against its hull, the slopes' against differences of paths."""
    law, (q, p) = among(2, beta), states(2)
    with ctx.workprec(200):
        flow, t = flow_of(law, 5, 2), arb(0)
        state = [arb(x) for x in (*q.ravel(), *p.ravel())]
        pieces = flow.pieces(state)
        path = flow.taylor(t, state, 6, pieces)
        second = flow.acceleration(t, state, pieces)
        assert all(abs(2 * a[2] - b) < arb("1e-40") for a, b in zip(path, second, strict=True))
        variation, step = flow.variation(t, path, 5, pieces), arb(2) ** -60
        for column in (2, 13):
            ahead = flow.taylor(t, [x + (step if k == column else 0) for k, x in enumerate(state)], 5, pieces)
            for row in range(20):
                for k in range(6):
                    quotient = (ahead[row][k] - path[row][k]) / step
                    assert abs(variation[k][row, column] - quotient) < arb("1e-8")


@pytest.mark.parametrize(("clearance", "piece"), [(0.25, Piece.CORE), (0.9, Piece.TAPER), (1.5, Piece.OUT)])
def test_the_pieces_are_those_of_the_clearance_on_either_side_of_the_surface(clearance, piece):
    numbers = PairNumbers.of_beta(LAW.beta)
    assert numbers.piece(arb(clearance) ** 2) is piece
    assert numbers.piece(arb(1.0)) is Piece.SWITCH
    assert numbers.piece(arb(0, 0.25) * arb(0, 0.25)) is Piece.CORE  # the surface is no switch


def test_the_centre_of_a_sphere_has_no_force():
    (term,) = sphere_terms(LAW)
    force = term.force(arb(0), [arb(0, 0.1), arb(0, 0.1)], [arb(1), arb(0)], Piece.CORE)
    assert not any(x.is_finite() for x in force)


@pytest.fixture(scope="module")
def passing():
    """It is on the taper, comes nearer, and leaves the range."""
    return enclose(LAW, *START, (0.0, 0.4375), order=12)


def test_a_run_past_a_sphere_is_inside_and_so_are_its_clearances(passing):
    run = simulate(LAW, *START, (0.0, 0.4375), rtol=1e-12, t_eval=passing.t)
    assert passing.status == "complete"
    assert np.all(np.abs(run.q - passing.q) <= passing.radii[:, 0] + 1e-10)
    assert np.all(np.abs(run.p - passing.p) <= passing.radii[:, 1] + 1e-9)
    assert passing.radii.max() < 1e-9
    clearance = np.linalg.norm(run.q[:, 0], axis=1) - 1.0
    for k in range(len(passing.taken)):
        ((ball,),) = passing.clearances_during(k)
        assert all((ball + arb(0, 1e-9)).contains(arb(float(x))) for x in clearance[k : k + 2])
    least = passing.min_clearance()
    assert least.lower <= run.clearance().reached + 1e-9
    assert least.lower > run.clearance().reached - 0.03
    assert (least.agent, least.obstacle, least.time < 0.1) == (0, 0, True)
    assert clearance[0] < 1.0 < clearance[-1]  # d' is crossed on the way


def test_a_box_of_starts_past_a_sphere_is_followed_as_a_whole():
    wide = 2.0**-12
    tube = enclose(LAW, *START, (0.0, 0.03125), radius=(wide, 0.0), order=10)
    for a, b in ((-1, 1), (1, -1), (1, 1)):
        q0 = START[0] + wide * np.array([[a, b]])
        run = simulate(LAW, q0, START[1], (0.0, 0.03125), rtol=1e-12, t_eval=tube.t)
        assert np.all(np.abs(run.q - tube.q) <= tube.radii[:, 0] + 1e-10)
    assert tube.radii[-1].max() < 100.0 * wide


def test_a_long_step_across_the_range_holds_what_short_ones_do():
    start, h = (np.array([[-1.9990234375, 0.0]]), np.array([[-2.0, 1.0]])), 2.0**-9
    fine = enclose(LAW, *start, (0.0, h)).boxes[-1]
    with ctx.workprec(100):
        flow = flow_of(LAW, 1, 2)
        box = lohner.StateSet.box([arb(x) for x in (*start[0][0], *start[1][0])], [arb(0)] * 4)
        one = lohner.crossing_step(flow, arb(0), arb(h), box)
    assert Piece.SWITCH in flow.pieces(one.during)
    assert all(x.contains(y) for x, y in zip(one.after.hull, fine, strict=True))
    assert max(float(x.rad()) for x in one.after.hull) < 1e-3


def test_a_tube_that_hits_the_centre_breaks_and_says_so():
    tube = enclose(LAW, *START, (0.0, 1.0), radius=(1.0, 0.0), steps=5, widest=10.0)
    assert tube.status == "broken"
    assert tube.min_clearance().lower < 0.0
