"""Links kept for ever: the tension k s²/(r − s) rises to its pole, and no energy that falls lets a link come there."""

from __future__ import annotations

from collections.abc import Iterator

import sympy as sp
import z3

from proofs.proof import Proof, Step
from proofs.smt import implication


def _power() -> Iterator[Step]:
    """What a link adds to dH/dt, in one, two and three dimensions."""
    w, c = sp.Symbol("w", real=True), sp.Symbol("c", nonnegative=True)
    for m in (1, 2, 3):
        x, v_i, v_j = (sp.Matrix(sp.symbols(f"{name}1:{m + 1}", real=True)) for name in ("x", "v", "w"))
        slip = v_j - v_i
        tension = w * x.dot(slip)  # dψ/dt, x = q_j − q_i and w = ψ'(s)/s
        work = v_i.dot(w * x + c * slip) - v_j.dot(w * x + c * slip)
        yield Step(
            f"m = {m}: tension and work of a link are −c‖p_j − p_i‖² together, so H never rises",
            sp.expand(tension + work + c * slip.dot(slip)) == 0,
            r"\dot\psi_{ij} + p_i \cdot f_{ij} + p_j \cdot f_{ji} = -c\|p_j - p_i\|^2",
            "expanded: 0",
        )


def _level() -> Iterator[Step]:
    """The length at which a link alone has all the energy."""
    s, r, k, H = sp.symbols("s r k H", positive=True)
    slope = sp.diff(k * s**2 / (r - s), s)
    yield Step(
        "ψ' in closed form",
        sp.simplify(slope - k * s * (2 * r - s) / (r - s) ** 2) == 0,
        r"\psi'(s) = \frac{k s (2r - s)}{(r - s)^2}",
        "simplified: 0",
    )
    longest = 2 * H * r / (H + sp.sqrt(H**2 + 4 * k * H * r))
    yield Step(
        "ψ(s*) = H at s* = 2Hr/(H + √(H² + 4kHr))",
        sp.simplify(k * longest**2 - H * (r - longest)) == 0,
        r"k s_*^2 = H (r - s_*)",
        "simplified: 0",
    )


def _order() -> Iterator[Step]:
    """Everything that is left is of real numbers."""
    s, r, k, H, most = z3.Reals("s r k H most")
    inside = (s > 0, s < r, k > 0)
    yield implication("ψ rises on (0, r)", k * s * (2 * r - s) > 0, *inside)
    root = (most > 0, H > 0, k * most * most == H * (r - most))
    yield implication("s* < r", most < r, r > 0, k > 0, *root)
    yield implication(
        "a link shorter than r with ψ(s) <= H is no longer than s*; being continuous it cannot pass s* to come to r",
        s <= most,
        *inside,
        *root,
        k * s * s <= H * (r - s),
    )


def _steps() -> Iterator[Step]:
    yield from _power()
    yield from _level()
    yield from _order()


PROOF = Proof(
    id="links-kept",
    title="A tension without bound at the range keeps every link",
    statement="no link is ever longer than s* < r, where ψ(s*) = H(0); so links that join all agents do so for ever.",
    hypotheses="u_i = −Σ_j ∇_i ψ + c Σ_j (p_j − p_i) over links shorter than r at the start, ψ = k s²/(r − s), c >= 0",
    rigour="smt",
    steps=_steps,
    size=8,
    theorems=("links-kept",),
    time_limit=120.0,
)
