"""Delay margins: of a pair in closed form, of a sweep that is off, and to which side roots are looked at."""

from dataclasses import replace
from math import atan2, sqrt

import numpy as np
import pytest

from flockana import Algorithm1
from flockana.stability import delay_margin
from flockana.theorems import Tolerances, delay_margins, theorem

EPS = np.finfo(float).eps


def closed_form():
    """Of two at the distance 7, k and d by differences of their forces: τ* = atan2(ωd, k)/ω."""
    law, h = Algorithm1(), 1e-5

    def force(stretch, speed):
        return float(law.acceleration(0.0, [[0.0], [7.0 + stretch]], [[0.0], [speed]])[0, 0])

    k, d = (force(h, 0.0) - force(-h, 0.0)) / h, (force(0.0, h) - force(0.0, -h)) / h
    omega = sqrt(0.5 * (d * d + sqrt(d**4 + 4.0 * k * k)))
    return k, d, atan2(omega * d, k) / omega


def test_a_pair_has_the_delay_of_the_closed_form(verdict_of):
    claim, (k, d, delay) = verdict_of("delay-margin").claim("pair"), closed_form()
    assert claim.computed == {"sweep": pytest.approx(delay, rel=1e-6), "closed form": pytest.approx(delay, rel=1e-6)}
    off = abs(claim.computed["sweep"] / claim.computed["closed form"] - 1.0)
    assert claim.status == "verified"
    assert claim.error == pytest.approx(64.0 * EPS, rel=1e-6)
    assert claim.margin == pytest.approx(1e-9 - off, rel=1e-5, abs=0.0)
    assert claim.detail.startswith(f"k = {k:.5g}, d = {d:.4g}: τ* = 0.00869249")


def test_roots_a_fiftieth_to_either_side(verdict_of):
    """Stable before and unstable after; the margin is the nearer of them to the axis."""
    *claims, _ = verdict_of("delay-margin").claims
    whose = [f"algorithm-{kind}-{what}" for kind in "12" for what in ("all", "pairs", "neighbours")]
    assert [(claim.name, claim.status, claim.computed["n"]) for claim in claims] == [(x, "verified", 7) for x in whose]
    for claim in claims:
        below, above = claim.witness["Re s below"], claim.witness["Re s above"]
        assert below < 0.0 < above
        assert claim.margin == min(-below, above)
        assert 0.0 < claim.error < 1e-11
        assert f"stable up to τ* = {claim.computed['delay']:.5g}" in claim.detail


@pytest.mark.slow
@pytest.mark.parametrize("share", [0.9, 1.1])
def test_a_sweep_that_is_off_by_a_tenth_is_refuted(monkeypatch, share):
    """The pair by a tenth less the 1e-9 allowed, the hexagons by the root on the wrong side, whose error it is."""

    def swept(system):
        found = delay_margin(system)
        return replace(found, delay=share * found.delay)

    monkeypatch.setattr(delay_margins, "delay_margin", swept)
    monkeypatch.setattr(delay_margins, "root_error", lambda system, s, delay: abs(s.real) * 1e-3)
    for claim in theorem("delay-margin").examine(Tolerances())[1]:
        assert claim.status == ("inconclusive" if claim.name == "pair" else "refuted")
        if claim.name == "pair":
            assert claim.contradicts == "second-order-modes"
            assert claim.margin == pytest.approx(1e-9 - 0.1, rel=1e-9)
            assert "a sweep over frequency finds it to 0.1 of its value" in claim.detail
        else:
            wrong = claim.witness["Re s below" if share > 1.0 else "Re s above"]
            assert (wrong > 0.0) == (share > 1.0)
            assert claim.margin == -abs(wrong)
            assert claim.error == pytest.approx(abs(wrong) * 1e-3, rel=1e-9)
