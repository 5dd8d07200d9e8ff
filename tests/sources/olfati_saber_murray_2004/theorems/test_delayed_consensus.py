"""Delays that a consensus bears: known nets, roots by mpmath, and what is said of margins and sums that are off."""

from dataclasses import replace
from fractions import Fraction
from math import pi

import mpmath
import numpy as np
import pytest
from flint import acb, arb

from flockana.sources.olfati_saber_murray_2004.theorems import delayed_consensus
from flockana.sources.olfati_saber_murray_2004.theorems.delayed_consensus import root_enclosure
from flockana.stability import consensus_system, delay_margin
from flockana.theorems import Tolerances, theorem

EPS = np.finfo(float).eps
TOPS = {"path of 3": 3.0, "ring of 6": 4.0, "star of 5": 5.0, "complete net of 4": 4.0}
HEXAGON = "hexagon of 7 under Algorithm 1 without its gradient"


def root(share):
    """Of s + e^(−sτ) = 0 at this share of τ = π/2."""
    tau = mpmath.mpf(share.numerator) / share.denominator * mpmath.pi / 2
    return mpmath.lambertw(-tau) / tau


@pytest.fixture(scope="module")
def top(verdict_of):
    """λ_n of the hexagon, from its margin: a wheel of six, all of whose weights are those of the distance d."""
    return pi / (2.0 * verdict_of("delayed-consensus").claim("margin").computed[HEXAGON])


def test_margins_are_those_of_known_spectra(verdict_of):
    claim = verdict_of("delayed-consensus").claim("margin")
    assert (claim.status, claim.error) == ("verified", 0.0)
    assert claim.computed == {
        **{name: pytest.approx(pi / (2.0 * largest), rel=1e-12) for name, largest in TOPS.items()},
        HEXAGON: pytest.approx(1.2517751212747839, rel=1e-9),
    }
    assert claim.margin == pytest.approx(1e-9, rel=1e-4, abs=0.0)
    assert "of 5 nets" in claim.detail


def test_the_hexagon_is_a_wheel(top):
    """Its links have one weight a: its spectrum is a times that of the wheel of six spokes, up to 7."""
    from flockana import Algorithm1

    law = Algorithm1()
    drag = law.acceleration(0.0, [[0.0], [7.0]], [[0.0], [1.0]]) - law.acceleration(0.0, [[0.0], [7.0]], [[0.0]] * 2)
    assert top == pytest.approx(7.0 * drag[0, 0] / law.gains.c2_alpha, rel=1e-9)


@pytest.mark.parametrize(("name", "sign"), [("below", -1), ("above", 1)])
def test_roots_a_hundredth_to_either_side(verdict_of, top, name, sign):
    claim, share = verdict_of("delayed-consensus").claim(name), 1 + sign * Fraction(1, 100)
    one = float(root(share).real)
    assert claim.status == "verified"
    expected = {net: pytest.approx(one * largest, rel=1e-9) for net, largest in {**TOPS, HEXAGON: top}.items()}
    assert claim.computed == expected
    assert claim.margin == pytest.approx(sign * one, rel=1e-9)
    assert 0.0 < claim.error < 1e-13
    assert claim.stated.startswith(f"at {float(share):g} times π/(2 λ_n)")
    assert ("grows" in claim.stated, "Lambert" in claim.detail) == (sign > 0, sign > 0)


@pytest.mark.parametrize(("name", "sign"), [("root-below", -1), ("root-above", 1)])
def test_roots_are_enclosed(verdict_of, name, sign):
    claim, share = verdict_of("delayed-consensus").claim(name), 1 + sign * Fraction(1, 100)
    ball, true = root_enclosure(share), root(share)
    assert (claim.status, claim.rigour, claim.proof) == ("verified", "interval", "delayed-consensus")
    for part, known in ((ball.real, true.real), (ball.imag, true.imag)):
        assert float(part.rad()) < 1e-14
        assert float(part.mid()) == pytest.approx(float(known), rel=1e-12)
    assert claim.computed == str(ball.real)
    assert claim.stated == f"Re s {'>' if sign > 0 else '<'} 0 at λτ = {share} π/2"


@pytest.mark.parametrize("swapped", ["delay", "frequency"])
@pytest.mark.parametrize("share", [0.75, 1.25])
def test_a_sweep_that_is_off_is_refuted_by_how_much(monkeypatch, swapped, share):
    def swept(system):
        found = delay_margin(system)
        return replace(found, **{swapped: share * getattr(found, swapped)})

    monkeypatch.setattr(delayed_consensus, "delay_margin", swept)
    claim = theorem("delayed-consensus").examine(Tolerances())[1][0]
    assert claim.status == "refuted"
    assert claim.margin == pytest.approx(1e-9 - 0.25, rel=1e-9)


def test_columns_sum_to_nothing(verdict_of):
    claim = verdict_of("delayed-consensus").claim("average")
    assert (claim.status, claim.error) == ("verified", 0.0)
    assert claim.margin == pytest.approx(14 * EPS - claim.computed, rel=1e-12, abs=0.0)
    assert 0.0 <= claim.computed < 4 * EPS


def test_columns_that_sum_to_something_are_told_by_the_largest_share(monkeypatch):
    """A quarter more that the first agent has from itself than from the second: a twelfth of 3, the least λ_n."""

    def uneven(matrix):
        system = consensus_system(matrix)
        late = system.late[1].copy()
        late[0, :2] += (0.25, -0.25) if len(matrix) < 7 else (0.0, 0.0)
        return replace(system, late=(system.late[0], late))

    monkeypatch.setattr(delayed_consensus, "consensus_system", uneven)
    claim = theorem("delayed-consensus").examine(Tolerances())[1][-1]
    assert (claim.status, claim.contradicts) == ("inconclusive", "delayed-consensus")
    assert claim.computed == pytest.approx(0.25 / 3.0, rel=1e-9)
    assert claim.margin == pytest.approx(-0.25 / 3.0, rel=1e-9)


@pytest.mark.parametrize(
    ("real", "wrong"),
    [(arb(-1, 0.5), [1]), (arb(0.25, 0.125), [0]), (arb(2.0), [0]), (arb(0, 0.1), []), (arb(0.5, 3.0), [])],
)
def test_a_ball_on_the_wrong_side_contradicts_the_proof_and_one_on_both_leaves_it_alone(monkeypatch, real, wrong):
    monkeypatch.setattr(delayed_consensus, "root_enclosure", lambda share: acb(real, 1))
    claims = theorem("delayed-consensus").examine(Tolerances())[1]
    assert [k for k, claim in enumerate(claims[3:5]) if claim.contradicts] == wrong
    assert [claim.status for claim in claims[3:5]] == ["inconclusive" if k in wrong else "verified" for k in (0, 1)]
