"""Velocities match in the limit: an energy that falls by what moves, forces that are bounded, and Barbalat's lemma.

One argument serves a minority of informed agents and potentials along a connected net; Algorithms 1 and 2 have it in
`any_potential_limits`. Barbalat's lemma itself is cited: a function with a finite integral over all later times whose
slope is bounded tends to 0. All that it is applied to is checked here.
"""

from __future__ import annotations

from collections.abc import Iterator

import sympy as sp
import z3

from flockana.symbolic.energy_balances import matching_identity
from proofs.any_potential_limits import bounded_push, integral
from proofs.proof import Proof, Step
from proofs.smt import implication


def _paths() -> Iterator[Step]:
    """A connected net ties all velocities together: what differs anywhere differs along a link."""
    yield from (over_links(count, count) for count in (1, 2, 3, 4, 5))
    total, along, spread, n = z3.Reals("total along spread n")
    yield implication(
        "so on a connected net of n agents each ‖v_i - v_j‖² <= (n - 1) Σ over links, and n‖v‖² = Σ_i<j <= n(n-1)²/2 Σ",
        2 * spread <= (n - 1) * (n - 1) * along,
        *(n >= 2, along >= 0, 2 * n * spread <= n * (n - 1) * total, total <= (n - 1) * along),
    )


def over_links(count: int, factor: int) -> Step:
    """Cauchy's inequality along a path of links, for a factor."""
    steps = sp.symbols(f"d_1:{count + 1}", real=True)
    squares = sp.Add(*((a - b) ** 2 for k, a in enumerate(steps) for b in steps[:k]))
    left = factor * sp.Add(*(d**2 for d in steps)) - sp.Add(*steps) ** 2
    return Step(
        f"over {count} links (Σ d_k)² = {factor} Σ d_k² - Σ_k<l (d_k - d_l)² <= {factor} Σ d_k²",
        sp.expand(left - squares) == 0,
    )


def _informed() -> Iterator[Step]:
    """An informed agent, in the frame of a steady leader: the energy falls at c2‖p_i‖² and bounds its acceleration."""
    yield bounded_push()
    fall, own, others, consensus, c2, c2_alpha = z3.Reals("fall p_i_squared others pLp c2 c2_alpha")
    yield implication(
        "informed agents: the energy falls at c2‖p_i‖² of each, whatever the others do",
        fall >= c2 * own,
        *(c2 > 0, c2_alpha >= 0, own >= 0, others >= 0, consensus >= 0),
        fall == c2 * (own + others) + c2_alpha * consensus,
    )


def _nets() -> Iterator[Step]:
    for m in (1, 2, 3):
        identity = matching_identity(m, potential=True)
        yield Step(f"potentials along links, m = {m}: dH/dt = -k₂ Σ over links ‖p_j - p_i‖²", identity.holds)
    s = sp.Symbol("s", positive=True)
    well = 1 / s**2 - 1 + sp.log(s**2)
    yield Step(
        "V/k = d²/s² - 1 + log(s²/d²) is unbounded at contact and at infinity: H(0) keeps links away from both",
        sp.limit(well, s, 0, "+") == sp.oo and sp.limit(well, s, sp.oo) == sp.oo,
        r"V(s)/k = d^2/s^2 - 1 + \log(s^2/d^2)",
    )
    slope = sp.diff(well, s)
    yield Step(
        "on every closed interval of such lengths V is smooth: forces are bounded, also those that a range cuts "
        "off; so are their rates on a fixed net",
        sp.simplify(slope - 2 * (s**2 - 1) / s**3) == 0,
        sp.latex(sp.factor(slope)),
    )
    total, one, other, force, gap = z3.Reals("sum u_i u_j force gap")
    yield implication(
        "once velocities match and Barbalat is applied to them again, accelerations of linked agents agree; their sum "
        "is 0, so each is 0, and with it each force of the potentials",
        z3.And(one == 0, other == 0, force == 0),
        *(one == other, one + other == total, total == 0, gap == 0, one == force + gap),
    )


def _kept() -> Iterator[Step]:
    s, r, most, k = z3.Reals("s r most k")
    yield implication(
        "links that are kept, s <= s* < r: the tension k s(2r - s)/(r - s)² is bounded by its value at s*",
        s * (2 * r - s) * (r - most) ** 2 <= most * (2 * r - most) * (r - s) ** 2,
        *(k > 0, s >= 0, s <= most, most < r),
        latex=r"\psi'(s) \le \psi'(s_*), \qquad \psi(s) = k s^2/(r - s)",
    )


def _steps() -> Iterator[Step]:
    for part in (integral, _informed, _paths, _nets, _kept):
        yield from part()


PROOF = Proof(
    id="matched-velocities",
    title="Velocities match in the limit: informed agents, Tanner's nets, links that are kept",
    statement=(
        "Informed agents take on a steady leader's velocity. All velocities tend to one along a fixed connected net "
        "with potentials, where all forces tend to 0 as well; along a net of proximity that stays connected, whose "
        "forces may jump; and along links that a tension keeps below their range."
    ),
    hypotheses=(
        "c1, c2 > 0 of the informed; k, k₂ > 0 along a net; c > 0 along kept links. Potentials as the energy bounds "
        "them: unbounded at contact or, of kept links, C¹ below the range. Barbalat's lemma is cited"
    ),
    rigour="smt",
    steps=_steps,
    size=17,
    theorems=("links-kept", "su-informed", "tanner-fixed", "tanner-switching"),
    cites=("Barbalat",),
)
