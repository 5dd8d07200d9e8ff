"""The right-hand side in balls and in series against the library's own formulas, which share no code with it."""

import numpy as np
import pytest
from flint import arb, arb_series, ctx

from flockana import enclose, simulate
from flockana.certified.balls import series_length
from flockana.certified.flow_in_balls import flow_of, sphere_terms
from flockana.certified.pair_laws_in_series import PairNumbers, Piece
from flockana.environment.obstacles import Sphere
from flockana.environment.targets import LinearTarget, StaticTarget
from flockana.interactions import AlphaInteraction, BetaInteraction, Gains
from flockana.kernels import alpha as kernel
from flockana.laws.algorithm3 import Algorithm3
from flockana.laws.olfati_saber import Algorithm1, Algorithm2

LAWS = [AlphaInteraction(), AlphaInteraction(d=3.0, r=4.5, eps=0.2, h=0.4, a=2.0, b=7.0, unit=1.5)]
LENGTHS = {Piece.CORE: 0.4, Piece.TAPER: 0.8, Piece.OUT: 1.1}  # of r


def numbers_of(s2, par):
    """Stress, adjacency and their slopes of the kernels."""
    slopes = kernel.pair_alpha_slope(s2, par), kernel.pair_alpha_adjacency_slope(s2, par)
    return (*kernel.pair_alpha(s2, par), *slopes)


@pytest.mark.parametrize("alpha", LAWS)
@pytest.mark.parametrize("piece", [Piece.CORE, Piece.TAPER])
def test_stress_adjacency_and_their_slopes_are_those_of_the_kernels(alpha, piece):
    law, share = PairNumbers.of_alpha(alpha), 0.1 if piece is Piece.CORE else 0.8
    s2 = (share * alpha.r) ** 2
    assert law.piece(arb(s2)) is piece
    expected = numbers_of(s2, alpha.par)
    with series_length(1):
        series = arb_series([arb(s2)])
        found = [float(x[0]) for x in (*law.pair(series, piece), *law.slopes(series, piece))]
    np.testing.assert_allclose(found, expected, rtol=1e-12, atol=1e-14)
    hull = (*law.pair(arb(s2)), *law.slopes(arb(s2)))
    np.testing.assert_allclose([float(x) for x in hull], expected, rtol=1e-12, atol=1e-14)


@pytest.mark.parametrize("alpha", LAWS)
def test_a_ball_across_a_switch_holds_the_values_on_both_sides(alpha):
    law = PairNumbers.of_alpha(alpha)
    assert law.switches[1] == pytest.approx(alpha.r, rel=1e-12)
    for z in (law.knee, law.cutoff):
        length2 = float(((1 + law.eps * z) ** 2 - 1) / law.eps)
        wide = arb(length2, 0.3)
        assert law.piece(wide) is Piece.SWITCH
        for s2 in (length2 - 0.25, length2, length2 + 0.25):
            point = numbers_of(s2, alpha.par)
            hull = (*law.pair(wide), *law.slopes(wide))
            assert all((x + arb(0, 1e-12)).contains(arb(y)) for x, y in zip(hull, point, strict=True))


def test_out_of_range_is_a_piece_of_its_own_and_exactly_r_lies_on_the_switch():
    law = PairNumbers.of_alpha(AlphaInteraction(d=7.0, r=8.5))
    assert law.piece(arb(8.6) ** 2) is Piece.OUT
    assert law.piece(arb(8.5) ** 2) is Piece.SWITCH


GAINS = Gains(c1_alpha=12.0, c2_alpha=3.5, c1_gamma=1.25, c2_gamma=0.75, c1_beta=40.0, c2_beta=5.0)
BETAS = [BetaInteraction(), BetaInteraction(d=2.0, r=3.0, eps=0.2, h=0.5, unit=1.5)]


def laws(m):
    q, p = tuple(np.arange(1.0, m + 1.0)), (0.5,) * m
    spheres = {"obstacles": (Sphere((0.5,) * m, 0.5), Sphere((3.0,) * m, 2.0)), "target": StaticTarget(q, p)}
    return [
        *(Algorithm3(gains=GAINS, beta=beta, **spheres) for beta in BETAS),
        Algorithm1(gains=GAINS),
        Algorithm2(gains=GAINS, target=LinearTarget(q, p)),
        Algorithm2(gains=GAINS, target=StaticTarget(q, p)),
        Algorithm3(gains=GAINS, target=StaticTarget(q, p)),
    ]


@pytest.mark.parametrize("law", [law for m in (1, 2, 3) for law in laws(m)], ids=lambda law: type(law).__name__)
def test_acceleration_and_jacobian_are_those_of_the_law(law):
    m = 2 if law.target is None else law.target.dimension
    rng = np.random.default_rng(3)
    q, p, t = rng.uniform(-6.0, 6.0, (4, m)), rng.normal(size=(4, m)), 0.75
    with ctx.workprec(100):
        flow = flow_of(law, 4, m)
        state = [arb(x) for x in (*q.ravel(), *p.ravel())]
        u = flow.input(arb(t), state, flow.pieces(state))
        slope = flow.jacobian(arb(t), state, flow.pieces(state))
    np.testing.assert_allclose([float(x) for x in u], law.acceleration(t, q, p).ravel(), rtol=1e-11, atol=1e-11)
    found = np.array([[float(x) for x in row] for row in slope.tolist()])
    expected = law.jacobian(t, q, p)
    np.testing.assert_allclose(found, getattr(expected, "toarray", lambda: expected)(), rtol=1e-10, atol=1e-10)


@pytest.mark.parametrize("law", laws(2), ids=lambda law: type(law).__name__)
def test_taylor_coefficients_are_those_of_the_flow_and_of_its_derivative(law):
    """The second coefficient is x''/2, and the coefficients of the variation are those of differences of paths."""
    q, p = np.array([[0.0, 0.0], [6.5, 1.0], [2.0, 5.0]]), np.array([[1.0, 0.0], [0.0, -1.0], [0.5, 0.5]])
    with ctx.workprec(200):
        flow, t = flow_of(law, 3, 2), arb(0.25)
        state = [arb(x) for x in (*q.ravel(), *p.ravel())]
        pieces = flow.pieces(state)
        path = flow.taylor(t, state, 6, pieces)
        second = flow.acceleration(t, state, pieces)
        assert all(abs(2 * a[2] - b) < arb("1e-40") for a, b in zip(path, second, strict=True))
        variation = flow.variation(t, path, 5, pieces)
        step = arb(2) ** -60
        for column in (0, 3, 8):
            moved = [x + (step if k == column else 0) for k, x in enumerate(state)]
            ahead = flow.taylor(t, moved, 5, pieces)
            for row in range(12):
                for k in range(6):
                    quotient = (ahead[row][k] - path[row][k]) / step
                    assert abs(variation[k][row, column] - quotient) < arb("1e-9")


LAW = Algorithm3(
    gains=Gains(c1_beta=100.0, c2_beta=20.0),
    target=StaticTarget((4.0, 2.0)),
    beta=BetaInteraction(d=1.0, r=1.25, h=0.5),
    obstacles=(Sphere((0.0, 0.0), 1.0),),
)
START = np.array([[-1.5, 1.0]]), np.array([[5.0, 4.0]])


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


def test_a_tube_that_hits_the_centre_breaks_and_says_so():
    tube = enclose(LAW, *START, (0.0, 1.0), radius=(1.0, 0.0), steps=5, widest=10.0)
    assert tube.status == "broken"
    assert tube.min_clearance().lower < 0.0
