"""The checker's bound of an error's growth is never below what an error grows by."""

from math import sqrt

import pytest
from flint import arb, arb_mat, ctx

from flockana import Algorithm1, enclose
from flockana.certified.balls import AlphaParameters
from flockana.certified.certificate import tube_certificate
from flockana.certified.check_tube import Run


@pytest.fixture(autouse=True)
def precise():
    with ctx.workprec(128):
        yield


def pair_on_a_line(weight=10.0, c1_gamma=0.0, c2_gamma=0.0, velocity=0.0, declared=0.0):
    """Two agents that only a γ-agent acts on, which is at 0 at first."""
    names = ("c1_alpha", "c2_alpha", "c1_gamma", "c2_gamma")
    gain = {name: arb(x) for name, x in zip(names, (0.0, 0.0, c1_gamma, c2_gamma), strict=True)}
    return Run(AlphaParameters(), gain, [arb(0)], [arb(velocity)], [arb(declared)], 2, 1, False, (), arb(weight))


def row(*coefficients):
    """Of a coordinate in time."""
    return [arb(c) for c in coefficients]


@pytest.mark.parametrize("h", [2.0**-7, 2.0**-4])
def test_an_error_of_the_velocity_becomes_one_of_the_place(h):
    """Two agents out of range move uniformly: an error e of p alone has the norm e √(1 + w²h²) after a time h."""
    tube = enclose(Algorithm1(), [[0.0], [20.0]], [[1.0], [2.0]], (0.0, h))
    with ctx.workprec(128):
        run = Run.of(tube_certificate(tube, weight=10.0))
        path = [[arb(x), arb(v), arb(0), arb(0)] for x, v in ((0.0, 1.0), (20.0, 2.0))]
        grown, box = run.grown(arb(0), arb(h), path, arb(1e-6), arb(1e-5))
    assert grown >= 1e-6 * sqrt(1.0 + (10.0 * h) ** 2) * (1.0 - 1e-12)
    assert grown < 1e-6 * 2.0 ** (10.0 * h)
    assert box[0].contains(arb(h + 0.99e-6))  # a tenth of the bound 1e-5, as lengths count ten times
    assert not box[0].contains(arb(h + 1.01e-6))
    assert box[2].contains(arb(1.0 + 0.99e-5))


def test_a_defect_adds_to_the_error_by_the_time_that_it_lasts():
    """A path with the acceleration 1 where none acts: the velocity is off by h, the place by ½h²."""
    h = 2.0**-7
    tube = enclose(Algorithm1(), [[0.0], [20.0]], [[1.0], [2.0]], (0.0, h))
    with ctx.workprec(128):
        run = Run.of(tube_certificate(tube, weight=10.0))
        path = [[arb(x), arb(v), arb(a), arb(0)] for x, v, a in ((0.0, 1.0, 0.5), (20.0, 2.0, 0.0))]
        grown, _ = run.grown(arb(0), arb(h), path, arb(0), arb(0.125))
    assert h <= grown < 1.2 * h


def test_where_a_path_jumps_the_error_grows_by_the_jump():
    run, path = pair_on_a_line(weight=10.0), [row(1, 2, 0, 0), row(20, 3, 0, 0)]
    assert run.jumped([arb(x) for x in (1, 20, 2, 3)], path, arb(1) / 8) == arb(1) / 8
    off = run.jumped([arb(x) for x in (1, 20.375, 2, -2)], path, arb(1) / 8)  # √(3.75² + 5²) = 6.25
    assert abs(off - 6.375) < 1e-30


@pytest.mark.parametrize("h", [0.5, 2.0])
def test_a_defect_where_nothing_acts_is_the_acceleration_of_the_path(h):
    """y'' = 2a + 6bt, the largest at the end."""
    path = [row(0, 1, 0.25, 0.5), row(20, 1, 0, 0)]
    exact = arb(0.5 + 3.0 * h)
    assert exact <= pair_on_a_line().defect(arb(0), arb(h), path) <= exact * (1 + arb(2) ** -100)


def test_a_defect_holds_what_the_force_has_beyond_the_order_of_the_path():
    """y = bt³ under u = −c1 y − c2 y': y'' − u = 6bt + c1 bt³ + 3 c2 bt², the largest at the end."""
    run, h, b = pair_on_a_line(c1_gamma=2.0, c2_gamma=0.5), 1.0, 0.5
    path = [row(0, 0, 0, b), row(20, 0, 0, 0)]
    other = 2.0 * 20.0  # the second agent is pulled by that all the time
    exact = sqrt((6 * b * h + 2.0 * b * h**3 + 1.5 * b * h**2) ** 2 + other**2)
    assert exact <= run.defect(arb(0), arb(h), path) < 1.2 * exact


@pytest.mark.parametrize("t", [0.0, 3.0])
def test_a_defect_across_a_change_of_piece_is_that_at_the_begin_and_what_its_slope_adds(t):
    """Two agents about their range: y'' − u = 6bt + c1 (y − Vt) + c2 (y' − V), for both agents alike."""
    h, b, x, speed, c1, c2 = 0.25, 0.5, 4.0, 1.0, 2.0, 0.5
    run = pair_on_a_line(c1_gamma=c1, c2_gamma=c2, velocity=-speed, declared=-speed)
    path = [row(x - speed * t, 0, 0, b), row(x + 8.4 - 0.01 - speed * t, 0.25, 0, b)]
    box = run.at(path, arb(0).union(arb(h)))
    assert run.pieces(box[:2]) == [None]

    def off(position, drift):
        return 6 * b * h + c1 * (position + (drift + speed) * h + b * h**3) + c2 * (drift + 3 * b * h**2 + speed)

    exact = sqrt(off(x, 0.0) ** 2 + off(x + 8.39, 0.25) ** 2)
    assert exact <= run.defect(arb(t), arb(h), path) < 1.2 * exact


@pytest.mark.parametrize(("stiffness", "drag"), [(25.0, 1.0), (400.0, 0.0), (100.0, 3.0)])
def test_an_oscillator_s_error_grows_by_its_logarithmic_norm(stiffness, drag):
    """(wq, p) with q'' = −kq − cq': the symmetric part is [[0, (w − k/w)/2], [., −c]]."""
    slope = arb_mat([[0, 0, 1, 0], [0, 0, 0, 1], [-stiffness, 0, -drag, 0], [0, -stiffness, 0, -drag]])
    off = (10.0 - stiffness / 10.0) / 2.0
    exact = -drag / 2.0 + sqrt(drag**2 / 4.0 + off**2)
    found = pair_on_a_line(weight=10.0).logarithmic_norm(slope)
    assert exact < found < exact + 0.02 * (1.0 + exact)


def test_a_logarithmic_norm_bounds_every_matrix_in_the_balls():
    wide = arb_mat(4, 4, [arb(0, 1.5) if i == j else arb(0) for i in range(4) for j in range(4)])
    assert pair_on_a_line().logarithmic_norm(wide) >= 1.5
    mixed = arb_mat(4, 4, [arb(0, 1) for _ in range(16)])  # all of 1: the eigenvalue 4
    assert pair_on_a_line(weight=1.0).logarithmic_norm(mixed) >= 4
