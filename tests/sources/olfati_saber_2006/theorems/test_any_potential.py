"""Theorems 1 and 3 for any pair potential: numbers by hand, the paper's law as a special case, what is left open."""

from math import sqrt

import numpy as np
import pytest

from flockana import Algorithm1, Algorithm2, Gains, StaticTarget, pair_law, verify
from flockana.sources.olfati_saber_2006.theorems import any_potential
from flockana.theorems.observed_run import Observed
from tests.theorems.made_up import hypothesis, made_up, statuses

MORSE = "k*((1 - exp(-a*(s - d)))**2 - 1)*(1 - s**2/r**2)**2"
GAINS = Gains(c1_alpha=2.0, c2_alpha=1.0, c1_gamma=0.5, c2_gamma=0.5)
ORIGIN = StaticTarget((0.0, 0.0))
Q = np.array([[0.0, 0.0], [1.0, 0.0], [0.4, 0.9]])
P = np.array([[0.3, 0.0], [-0.1, 0.2], [0.0, -0.2]])


def morse():
    numbers, units = {"k": 1.0, "a": 3.0}, {"k": (2, -2), "a": (-1, 0)}
    return pair_law(MORSE, adjacency="(1 - s/r)**2", range=2.0, length=1.0, parameters=numbers, units=units)


def parabola(top=4.0):
    """ψ = top (1 − s²/4)² − 1: top − 1 at contact, −1 at the range and beyond, and nowhere less."""
    return pair_law("k*(1 - s**2/r**2)**2 - 1", adjacency="1 - s/r", range=2.0, length=1.0, parameters={"k": top})


@pytest.mark.slow
def test_a_morse_flock_is_cohesive_and_matches_under_theorem_3():
    verdict = verify("os-3", law=Algorithm2(morse(), GAINS, ORIGIN), q0=Q, p0=P, t_span=(0.0, 1.0))
    found = statuses(verdict)
    assert {found[name] for name in ("i", "iii", "iv-instant", "iv-none")} == {"verified"}
    assert {found[name] for name in ("ii", "ii-converges", "ii-semidefinite")} == {"inconclusive"}
    assert (verdict.claim("iii").proof, verdict.claim("iii").cites) == ("any-potential-limits", ("Barbalat", "LaSalle"))
    assert verdict.claim("i").proof == verdict.claim("iv-none").proof == "any-potential"


def test_the_radius_counts_from_the_least_energy_of_all_pairs():
    """c1α V = 2 Σ ψ and L = −1: E = 2 Σ (ψ + 1) + ½·½ Σ‖x‖² + K, by hand."""
    run = made_up(Algorithm2(parabola(), GAINS, ORIGIN), [Q] * 2, [P] * 2)
    x, v = Q - Q.mean(axis=0), P - P.mean(axis=0)
    s = [np.linalg.norm(Q[j] - Q[i]) for i, j in ((0, 1), (0, 2), (1, 2))]
    energy = 2.0 * sum(4.0 * (1.0 - one * one / 4.0) ** 2 for one in s) + 0.25 * np.sum(x * x) + 0.5 * np.sum(v * v)
    claim = any_potential.cohesive(Observed.alone(run), [], name="i")
    assert claim.computed == pytest.approx(np.linalg.norm(x, axis=1).max(), rel=1e-12)
    assert float(claim.stated.split(" = ")[1]) == pytest.approx(sqrt(2.0 * energy / 0.5), rel=1e-4)
    assert hypothesis_of(run, 2.0 * 4.0 - energy)


def hypothesis_of(run, margin):
    """Whether E(0) < c* = 2·4 has that margin."""
    need = any_potential.never_meets(Observed.alone(run))
    return need.status == ("met" if margin > 0.0 else "unmet") and need.margin == pytest.approx(margin, rel=1e-9)


@pytest.mark.parametrize("n", [2, 3, 5])
def test_the_energy_that_parts_a_flock(n):
    """Of the paper's law (n − 1) c1α ψ_α(r_α); of one without attraction 0: it never holds together."""
    q = np.column_stack([np.arange(n), np.zeros(n)])
    for law, per_pair in ((Algorithm1(), 30.0 * 0.73590113426239231), (Algorithm1(parabola(), GAINS), 0.0)):
        seen = Observed.alone(made_up(law, [q] * 2))
        assert any_potential.parting_energy(seen) == pytest.approx((n - 1) * per_pair, rel=1e-11, abs=1e-11)


def test_a_flock_that_cannot_part_matches_under_theorem_1():
    law = Algorithm1(morse(), GAINS)
    least = float(law.alpha.facts.least[0])
    start = np.array([[0.0, 0.0], [0.98, 0.0], [0.49, 0.85]])
    for speed, said in ((0.1, "met"), (1.74, "assumed"), (2.5, "unmet")):
        verdict = verify("any-potential", law=law, q0=start, p0=speed * (P - P.mean(axis=0)) / 0.3, t_span=(0, 0.01))
        assert hypothesis(verdict, "Ω_c").status == said
        assert said == "unmet" or verdict.claim("cohesion").stated == "R <= ½ (n - 1) r = 2"
        assert statuses(verdict)["velocities"] == {"met": "verified", "assumed": "inconclusive"}.get(said, "vacuous")
    assert "a disconnected state has (n-1) c1α (ψ(r) - L) = " + f"{4.0 * -least:.5g}" in str(
        verify("os-1", law=law, q0=start, p0=0.0 * P, t_span=(0.0, 0.2))
    )


def test_the_paper_s_law_is_a_special_case():
    """Of ψ_α the bounds, thresholds and statuses are those of Theorem 3."""
    law = Algorithm2(target=ORIGIN)
    run = {"law": law, "q0": 7.0 * Q, "p0": P, "t_span": (0.0, 0.5)}
    ours, paper = verify("any-potential", **run), verify("os-3", **run)
    for one, other in (("cohesion", "i"), ("one-instant", "iv-instant"), ("no-collision", "iv-none")):
        assert ours.claim(one).status == paper.claim(other).status == "verified"
        assert ours.claim(one).margin == paper.claim(other).margin
    assert hypothesis(ours, "H(0) < c*").margin == hypothesis(paper, "H(0) < c*").margin
    assert statuses(ours)["critical"] == "verified"
