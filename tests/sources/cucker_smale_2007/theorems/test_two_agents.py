"""Two agents of the Cucker-Smale law on a line, against closed forms: with β = 1, ∫λψ is λ times an arc tangent."""

from math import atan, inf, pi, tan

import numpy as np
import pytest

import flockana as fl
from flockana import CuckerSmale, RationalWeight
from flockana.theorems.observed_run import Observed

PSI = {True: 3.0, False: 6.0}  # λψ(0) for K = 3: the sum of one term, divided by n = 2, counts both ends


def pair(start, speed, *, mean=False, decay=1.0, way=1.0, far=0.0, until=0.1):
    """The verdict, and the run: one agent at rest, the other at `start` along the relative velocity."""
    law = CuckerSmale(RationalWeight(strength=3.0, decay=decay), mean=mean)
    run = fl.simulate(law, [[far], [far + way * start]], [[0.0], [way * speed]], (0.0, until))
    return fl.verify("cucker-smale-pair", run), run


@pytest.mark.parametrize("way", [1.0, -1.0])
@pytest.mark.parametrize("mean", [True, False])
@pytest.mark.parametrize("start", [0.5, -2.0])
def test_on_which_side_of_the_integral_the_speed_is(start, mean, way):
    integral_to_infinity, told = PSI[mean] * (pi / 2.0 - atan(start)), {}
    for share, said, not_so, room in ((0.4, "bounded", "parts", 0.6), (1.5, "parts", "bounded", 0.5)):
        verdict, run = pair(start, share * integral_to_infinity, mean=mean, way=way)
        claim = told[said] = verdict.claim(said)
        assert verdict.claim(not_so).status == "vacuous"
        assert (claim.status, claim.proof) == ("verified", "cucker-smale")
        assert claim.needs[-1].margin == pytest.approx(room * integral_to_infinity, rel=1e-10)
        assert claim.needs[-1].error == pytest.approx(1e-11 * integral_to_infinity, rel=1e-3)
    end, parts = tan(atan(start) + 0.4 * integral_to_infinity / PSI[mean]), told["parts"]
    assert f"x along w tends to {end:.6g}, " in told["bounded"].detail
    assert parts.computed == pytest.approx(way * float(run.p[-1, 1, 0] - run.p[-1, 0, 0]), rel=1e-7)
    assert f"at the end and never below {0.5 * integral_to_infinity:.6g}" in parts.detail


def test_at_the_integral_itself_it_is_open_and_a_weight_that_falls_slowly_matches_all():
    verdict, _ = pair(0.5, 6.0 * (pi / 2.0 - atan(0.5)) * (1.0 + 1e-12))
    assert {verdict.claim(name).status for name in ("bounded", "parts")} <= {"inconclusive", "vacuous"}
    bounded = pair(0.5, 1e3, decay=0.5)[0].claim("bounded")
    assert (bounded.status, bounded.needs[-1].status, bounded.needs[-1].margin) == ("verified", "met", inf)


def test_far_from_the_origin_the_start_itself_is_rounded():
    verdict, run = pair(0.5, 1.0, far=1e9)
    error = 2.0 * (2 + 4) * np.finfo(float).eps * float(np.abs(run.q).max())  # of x(0): ∫λψ falls by 6/(1 + x²) of it
    assert verdict.claim("bounded").needs[-1].error == pytest.approx(error * 6.0 / 1.25, rel=1e-3)


def test_the_invariant_is_that_of_the_whole_run():
    verdict, run = pair(-1.0, 3.0, until=2.0)
    run = Observed.of(run).run
    x, w = (z[:, 1, 0] - z[:, 0, 0] for z in (run.q, run.p))
    off = np.abs((w + 6.0 * (np.arctan(x) - np.arctan(x[0]))) / w[0] - 1.0)
    claim = verdict.claim("invariant")
    assert claim.computed == pytest.approx(off.max(), abs=1e-14)
    assert claim.margin == pytest.approx(fl.Tolerances().energy, abs=off.max())
    assert claim.witness["time"] == run.t[off.argmax()]
    assert 0.0 < claim.error < inf


@pytest.mark.parametrize(
    ("q", "p"), [([[0.0], [1.0], [2.0]], [[0.0], [1.0], [2.0]]), ([[0.0, 0.0]] * 2, [[1.0, 0.0]] * 2)]
)
def test_it_is_about_two_agents_on_a_line(q, p):
    run = fl.simulate(CuckerSmale(), q, p, (0.0, 0.1))
    verdict = fl.verify("cucker-smale-pair", run)
    assert verdict.status == "vacuous"
    assert any(f"n = {len(q)}, m = {len(q[0])}" in need.detail for need in verdict.hypotheses)
