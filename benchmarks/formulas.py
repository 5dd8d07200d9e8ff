"""A pair law from a formula against the hand-written one, both Olfati-Saber's: right-hand sides of Algorithm 2."""

from __future__ import annotations

import numpy as np

from benchmarks.flocks import gas
from benchmarks.rows import Asked, Found, Row
from benchmarks.timing import interleaved, ratio
from flockana.environment.targets import StaticTarget
from flockana.interactions import AlphaInteraction, FormulaInteraction
from flockana.laws.olfati_saber import Algorithm2

STUDY = "A law from its formula"
_SLOWER = 1.2
_BUMP = "Piecewise((1, z < h*r_z), ((1 + cos(pi*(z/r_z - h)/(1 - h)))/2, True))"
_SIGMOID = "((a + b)*((z - d_z)/l**2 + c)/sqrt(1 + ((z - d_z)/l**2 + c)**2) + (a - b))/2"


def written(alpha: AlphaInteraction) -> FormulaInteraction:
    """The same pair law by its formula: the force, for its potential has no closed form."""
    return FormulaInteraction(
        force_formula=f"{_BUMP}*{_SIGMOID}",
        adjacency=_BUMP,
        r=alpha.r,
        d=alpha.d,
        parameters=(*((name, getattr(alpha, name)) for name in ("eps", "h", "a", "b", "c")), ("l", alpha.unit)),
    )


def study(*, quick: bool) -> Found:
    """n = 150 and 10⁴, of the gas; both agree to 1e-13 of the law's strength, or nothing is timed."""
    alpha, target = AlphaInteraction(), StaticTarget((0.0, 0.0))
    laws = {"hand": Algorithm2(alpha, target=target), "formula": Algorithm2(written(alpha), target=target)}
    rows = []
    for n in (150, 10_000):
        q, p = gas(n)
        hand, formula = (law.flow(0.0, q, p)[0] for law in laws.values())
        np.testing.assert_allclose(formula, hand, rtol=0.0, atol=1e-13 * (alpha.strength + np.abs(hand).max()))
        calls = {name: lambda law=law, q=q, p=p: law.flow(0.0, q, p) for name, law in laws.items()}
        found = interleaved(calls, rounds=5 if quick else 15)
        value, base = (1e6 * float(np.median(found[name])) for name in ("formula", "hand"))
        against, share = f"the law written by hand: {base:.4g} µs", ratio(found["formula"], found["hand"])
        asked = Asked("<=", _SLOWER)
        rows.append(Row(STUDY, "times the hand-written law's", n, value, "µs", against, share, asked))
    return Found(rows)
