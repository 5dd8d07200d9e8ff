"""The motion that a checker of tubes believes in is the law's: of unequal a and b, in the plane, on each piece."""

import numpy as np
import pytest
from flint import arb, arb_series, ctx

from flockana import Algorithm2, Algorithm3, AlphaInteraction, BetaInteraction, Gains, Sphere
from flockana.certified.balls import AlphaParameters, BetaParameters, series_length
from flockana.certified.check_motion import Motion
from flockana.certified.check_sphere import Sphere as Rested
from flockana.environment.targets import LinearTarget, StaticTarget

ALPHA = AlphaInteraction(a=1.0, b=3.0)
GAINS = Gains(c1_alpha=4.0, c2_alpha=0.75, c1_gamma=1.5, c2_gamma=0.5, c1_beta=20.0, c2_beta=6.0)
LED = Algorithm2(alpha=ALPHA, gains=GAINS, target=LinearTarget((1.0, 2.0), (3.0, -0.5)))
AMONG = Algorithm3(
    alpha=ALPHA,
    gains=GAINS,
    target=StaticTarget((4.0, 2.0)),
    beta=BetaInteraction(d=1.0, r=1.25, h=0.5),
    obstacles=(Sphere((-2.5, 3.0), 1.7), Sphere((2.0, -1.5), 0.5)),
)
Q = np.array([[-3.0, 0.5], [3.5, 0.25], [0.75, 5.25], [2.75, -1.25], [12.0, 1.0]])
P = np.array([[1.0, -0.5], [0.25, 2.0], [-1.5, 0.75], [0.5, 0.5], [0.0, -1.0]])
T = 0.75


@pytest.fixture(autouse=True)
def precise():
    with ctx.workprec(128):
        yield


def balls(x, off=0.0):
    return [arb(float(y), off) for y in np.ravel(x)]


def motion_of(law):
    """A law as its certificate says it."""
    gains, target = law.gains, law.target
    gain = {name: arb(getattr(gains, name)) for name in ("c1_alpha", "c2_alpha", "c1_gamma", "c2_gamma")}
    place, speed = target.position(0.0), target.rate(0.0)
    bounded = type(law) is Algorithm3
    spheres = tuple(
        Rested(BetaParameters.of(law.beta), tuple(balls(one.centre)), *map(arb, (one.radius, 20.0, 6.0)))
        for one in (law.obstacles if bounded else ())
    )
    return Motion(AlphaParameters.of(law.alpha), gain, balls(place), balls(speed), balls(speed), 5, 2, bounded, spheres)


@pytest.mark.parametrize("law", [LED, AMONG], ids=["led", "among spheres"])
def test_force_and_slope_are_those_of_the_law(law):
    motion, state = motion_of(law), balls([Q, P])
    pieces = motion.pieces(state[:10])
    assert {0, 1, 2} <= set(pieces)
    expected = law.acceleration(T, Q, P).ravel()
    for known in (pieces, [None] * len(pieces)):
        with series_length(1):
            u = motion.force(arb(T), [arb_series([x]) for x in state], known)
        np.testing.assert_allclose([float(x[0]) for x in u], expected, atol=1e-11)
    found = np.array([[float(x) for x in row] for row in motion.slope(state).tolist()])
    np.testing.assert_allclose(found, law.jacobian(T, Q, P), atol=1e-10)


def test_a_path_is_shifted_by_the_binomial_theorem_and_differentiated():
    """1 + 2t + 3t² + 4t³ about ½: 3.25, 8, 9, 4, and its derivative's 8, 18, 12; as exact in a place and a speed."""
    motion, cubic = motion_of(LED), [[arb(1), arb(2), arb(3), arb(4)]]
    found = [[float(x) for x in row] for row in motion.shifted(cubic, arb(0.5))]
    assert found == [[3.25, 8.0, 9.0, 4.0], [8.0, 18.0, 12.0]]
    assert [float(x) for x in motion.at(cubic, arb(0.5))] == [3.25, 8.0]


@pytest.mark.parametrize("law", [LED, AMONG], ids=["led", "among spheres"])
def test_the_force_along_a_path_rises_as_the_law_s_does(law):
    """The second coefficient along (q + sp, p) at the time T + s, the γ-agent moving too."""
    motion, state, step = motion_of(law), balls([Q, P]), 1e-5
    path = [arb_series([x, v]) for x, v in zip(state[:10], state[10:], strict=True)]
    path += [arb_series([v]) for v in state[10:]]
    with series_length(2):
        u = motion.force(arb(T), path, motion.pieces(state[:10]))
    ends = [law.acceleration(T + s, Q + s * P, P).ravel() for s in (-step, step)]
    np.testing.assert_allclose([float(x[1]) for x in u], (ends[1] - ends[0]) / (2.0 * step), atol=1e-6)


@pytest.mark.parametrize(
    ("length", "off", "piece"),
    [
        *((length, off, 0) for length, off in ((1.9, 0.1), (2.9, 0.0))),
        *((length, off, 1) for length, off in ((3.0, 0.0), (5.5, 1.5))),
        *((length, off, 2) for length, off in ((8.5, 0.0), (12.0, 2.0))),
        *((x, off, None) for x, off in ((2.95, 0.1), (1.0, 4.0), (8.4, 0.01), (6.0, 4.0), (12.0, 6.0))),
    ],
)
def test_a_box_of_pairs_is_on_a_piece_only_if_all_of_it_is(length, off, piece):
    """‖2.95‖_σ is a fifth of ‖8.4‖_σ."""
    q = [arb(0)] * 2 + [arb(length, off), arb(0)] + [arb(k) for k in (99, 0, 0, 99, -99, 0)]
    assert motion_of(LED).pieces(q)[0] == piece


def test_distances_and_radii_are_those_of_the_flock():
    motion, state = motion_of(LED), balls([Q, P])
    i, j = np.triu_indices(5, 1)
    assert [float(x) for x in motion.lengths(state)] == pytest.approx(np.linalg.norm(Q[j] - Q[i], axis=1), abs=1e-14)
    assert [float(x) for x in motion.radii(state)] == pytest.approx(
        np.linalg.norm(Q - Q.mean(axis=0), axis=1), abs=1e-14
    )


def test_the_pull_of_a_box_is_that_of_each_place():
    """c1γ ∂σ₁(x − q_r)/∂x against differences of the law's own pull."""
    motion, step = motion_of(AMONG), 1e-6
    alone = Algorithm3(gains=Gains(c1_gamma=1.5, c2_gamma=0.0), target=AMONG.target)
    for x in ([5.0, 1.0], [4.0, 2.0], [-3.0, 7.0]):
        found = np.array([[float(y) for y in row] for row in motion.pull(balls(x))])
        for c in (0, 1):
            ends = [
                alone.acceleration(0.0, np.array([x]) + s * np.eye(2)[c], np.zeros((1, 2)))[0] for s in (-step, step)
            ]
            np.testing.assert_allclose(found[:, c], (ends[0] - ends[1]) / (2.0 * step), atol=1e-8)


@pytest.mark.parametrize("law", [LED, AMONG], ids=["led", "among spheres"])
def test_the_energy_of_a_box_holds_that_of_each_state(law):
    motion, off = motion_of(law), 2.0**-10
    with ctx.workprec(128):
        wide = motion.energy([arb(x.mid(), off) for x in balls([Q, P])])
        for sign in (-1.0, 0.0, 1.0):
            q, p = Q + sign * off * np.array([1.0, -1.0]), P - sign * off
            exact = law.structural_energy(q, p) if law is LED else law.energy(0.0, q, p)
            assert float(wide.lower()) < exact < float(wide.upper())
            at = motion.energy(balls([q, p]))
            assert float(at) == pytest.approx(exact, rel=1e-12)
            assert wide.contains(at)


def test_a_length_that_bounds_is_an_upper_end():
    found = motion_of(LED).length([arb(3, 0.5), arb(4, 0.5)])
    assert found >= arb(32.5).sqrt()
