"""Spheres in balls: switches and pieces of their law, and a tube that passes one (forces: `test_flow`)."""

import numpy as np
import pytest
from flint import arb

from flockana import Algorithm3, BetaInteraction, Gains, Sphere, StaticTarget, enclose, simulate
from flockana.certified.laws import sphere_terms
from flockana.certified.series import PairNumbers, Piece

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
