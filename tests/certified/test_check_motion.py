"""The motion that a checker of tubes believes in is the law's: of unequal a and b, in the plane, on each piece."""

import json
from dataclasses import replace

import numpy as np
import pytest
from flint import arb, arb_series, ctx

from flockana import enclose
from flockana.base.errors import ArgumentError
from flockana.certified.balls import AlphaParameters, BetaParameters, series_length
from flockana.certified.certificate import tube_certificate
from flockana.certified.certificate_check import RejectedError, check_data
from flockana.certified.check_motion import Motion
from flockana.certified.check_motion import Sphere as Rested
from flockana.certified.check_tube import Run
from flockana.environment.obstacles import Sphere
from flockana.environment.targets import LinearTarget, StaticTarget
from flockana.interactions import AlphaInteraction, BetaInteraction, Gains
from flockana.laws.algorithm3 import Algorithm3
from flockana.laws.olfati_saber import Algorithm2
from tests.certified.conftest import more, resealed, with_leaf

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


LAW = Algorithm3(
    gains=Gains(c1_alpha=1.5, c2_alpha=2.0, c1_beta=100.0, c2_beta=20.0),
    target=StaticTarget((4.0, 2.0)),
    beta=BetaInteraction(d=1.0, r=1.25, h=0.5),
    obstacles=(Sphere((0.25, 0.5), 1.0),),
)
START = np.array([[-1.5, 1.25], [-1.5, 6.0]]), np.array([[4.0, 3.0], [0.0, -1.0]])


@pytest.fixture(scope="module")
def tube():
    return enclose(LAW, *START, (0.0, 0.0078125), order=12)


@pytest.fixture(scope="module")
def data(tube):
    return json.loads(json.dumps(tube_certificate(tube)))


def test_it_holds_and_tells_the_clearance(data, tube):
    steps = check_data(data).steps
    assert steps[3] == f"no agent comes nearer than {data['clearance']} to a sphere"
    assert tube.min_clearance().lower - 0.01 < float(data["clearance"]) <= tube.min_clearance().lower + 1e-3
    assert float(data["energy"]) == pytest.approx(LAW.energy(0.0, *START), abs=1e-5)


@pytest.mark.parametrize(
    ("clearance", "off", "piece"),
    [
        *((clearance, off, 0) for clearance, off in ((0.6, 0.0), (0.7, 0.002), (-0.2, 0.1))),
        *((clearance, off, 1) for clearance, off in ((0.71, 0.0), (0.85, 0.09), (0.99, 0.0))),
        *((clearance, off, 2) for clearance, off in ((1.01, 0.0), (1.5, 0.3))),
        *((clearance, off, None) for clearance, off in ((0.7, 0.01), (0.0, 0.8), (1.0, 0.01), (0.85, 0.2), (1.5, 0.9))),
    ],
)
def test_a_box_of_places_is_on_a_piece_only_if_all_of_it_is(data, clearance, off, piece):
    """φ_β is in its core up to ‖c‖_σ = ½ d_β, which is c = 0.703, and on its taper up to d_β, c = 1."""
    sphere = Run.of(data).spheres[0]
    for side in (1.0, -1.0):
        x = [arb(0.25 + side * (1.0 + clearance), off), arb(0.5)]
        assert sphere.piece(x) == piece


CLOSE = "the error may exceed|the least clearance"


@pytest.mark.parametrize(
    ("at", "message"),
    [
        *((("law", name), CLOSE) for name in ("beta_d", "beta_eps", "beta_h", "c1_beta", "c2_beta")),
        *((("law", name), CLOSE) for name in ("c1_alpha", "c1_gamma", "c2_gamma")),
        *((("law", "spheres", 0, *at), CLOSE) for at in (("radius",), ("centre", 0), ("centre", 1))),
        (("law", "start", 1), "the error may exceed"),
        (("law", "velocity", 0), "its γ-agent moves"),
        (("clearance",), "the least clearance"),
        (("distance",), "the least distance"),
        (("cohesion_radius",), "the largest radius"),
        (("energy",), "the energy at the start"),
    ],
)
def test_what_was_sealed_again_is_decided_by_the_mathematics(data, at, message):
    with pytest.raises(RejectedError, match=message):
        check_data(resealed(with_leaf(data, at, more)))


def test_a_sphere_left_out_or_turned_or_a_basin_among_spheres_is_rejected(data):
    bare = with_leaf(data, ("law", "spheres"), lambda spheres: [])
    for altered, message in (
        (bare, r"clearance = .*: expected null"),
        (bare | {"clearance": None}, "the error may exceed"),
        (with_leaf(data, ("law", "spheres", 0, "centre"), lambda centre: centre[:1]), "another dimension"),
        (with_leaf(data, ("law", "spheres", 0, "radius"), lambda radius: f"-{radius}"), "another dimension"),
        (data | {"basin": {"kind": "basin"}}, "a basin of Algorithm 3"),
    ):
        with pytest.raises(RejectedError, match=message):
            check_data(resealed(altered))


def test_a_moving_target_has_no_certificate():
    moving = replace(LAW, target=LinearTarget((4.0, 2.0), (1.0, 0.0)))
    with pytest.raises(ArgumentError, match="expected a γ-agent at rest"):
        tube_certificate(enclose(moving, *START, (0.0, 0.0009765625), order=8))
