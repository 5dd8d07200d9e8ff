"""Certificates of runs past a sphere: the checker's own formulas, and that what was altered is rejected."""

import json
from dataclasses import replace

import numpy as np
import pytest
from flint import arb

from flockana import Algorithm3, BetaInteraction, Gains, LinearTarget, Sphere, StaticTarget, enclose
from flockana.base.errors import ArgumentError
from flockana.certified.check import RejectedError, check_data
from flockana.certified.check_tube import Run
from flockana.certified.tube_certificate import tube_certificate
from tests.certified.conftest import more, resealed, with_leaf

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


@pytest.mark.parametrize(
    ("at", "message"),
    [
        *(
            (("law", name), "the error may exceed|the least clearance")
            for name in ("beta_d", "beta_eps", "beta_h", "c1_beta", "c2_beta", "c1_alpha", "c1_gamma", "c2_gamma")
        ),
        (("law", "spheres", 0, "radius"), "the error may exceed|the least clearance"),
        (("law", "spheres", 0, "centre", 0), "the error may exceed|the least clearance"),
        (("law", "spheres", 0, "centre", 1), "the error may exceed|the least clearance"),
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


def test_a_sphere_left_out_or_turned_is_rejected(data):
    bare = with_leaf(data, ("law", "spheres"), lambda spheres: [])
    with pytest.raises(RejectedError, match=r"clearance = .*: expected null"):
        check_data(resealed(bare))
    with pytest.raises(RejectedError, match="the error may exceed"):
        check_data(resealed(bare | {"clearance": None}))
    with pytest.raises(RejectedError, match="another dimension"):
        check_data(resealed(with_leaf(data, ("law", "spheres", 0, "centre"), lambda centre: centre[:1])))
    with pytest.raises(RejectedError, match="another dimension"):
        check_data(resealed(with_leaf(data, ("law", "spheres", 0, "radius"), lambda radius: f"-{radius}")))


def test_no_basin_among_spheres_is_believed(data):
    """Basins are those of Algorithms 1 and 2."""
    with pytest.raises(RejectedError, match="a basin of Algorithm 3"):
        check_data(resealed(with_leaf(data, ("basin",), lambda none: {"kind": "basin"})))


def test_a_moving_target_has_no_certificate():
    moving = replace(LAW, target=LinearTarget((4.0, 2.0), (1.0, 0.0)))
    with pytest.raises(ArgumentError, match="expected a γ-agent at rest"):
        tube_certificate(enclose(moving, *START, (0.0, 0.0009765625), order=8))
