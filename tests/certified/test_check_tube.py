"""The checker's bound of an error's growth is never below what an error grows by."""

from __future__ import annotations

from math import sqrt

import pytest
from flint import arb, ctx

from flockana import Algorithm1, enclose
from flockana.certified.check_tube import Run
from flockana.certified.tube_certificate import tube_certificate


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
    assert box[0].contains(arb(h + 1e-6))
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
