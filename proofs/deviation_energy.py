"""The deviation energy E(q) jumps and has corners where V(q) is smooth: why the source works with V."""

from __future__ import annotations

from collections.abc import Iterator

import sympy as sp

from flockana.symbolic.scalar_functions import taper
from flockana.symbolic.sigma_norms import sigma_norm
from proofs.proof import Proof, Step

D, X, EPS, GAP, S = sp.symbols("d x epsilon g S", positive=True)  # r = d + g
LINKS = sp.Symbol("L", integer=True, nonnegative=True)
PHI = sp.Function("phi", real=True)  # any smooth action


def deviation(squares: sp.Expr, links: sp.Expr) -> sp.Expr:
    """Return E of a net: twice the sum of squared deviations of its links over the ordered pairs, and one."""
    return 2 * squares / (2 * links + 1)


def _steps() -> Iterator[Step]:
    r = D + GAP
    inside = deviation((X - D) ** 2, sp.S.One).subs(X, r)
    yield Step(
        "two agents at distance r: E tends to ⅔(r - d)² from within, and is 0 from r on",
        sp.expand(inside - sp.Rational(2, 3) * GAP**2) == 0 and inside.is_positive is True and deviation(0, 0) == 0,
        r"E(r^-) - E(r) = \tfrac23 (r-d)^2 > 0",
        "neighbours are closer than r, strictly",
    )
    before, after = deviation(S, LINKS), deviation(S + GAP**2, LINKS + 1)
    yield Step(
        "any net of L links, S the sum of their squared deviations: one more, of length r, changes E at once",
        sp.simplify(after - before - 2 * (GAP**2 - before) / (2 * LINKS + 3)) == 0,
        r"E^+ - E = \frac{2\,[(r-d)^2 - E]}{2L + 3}",
        "not 0 unless E = (r - d)² by chance; at a lattice, where E = 0, it is positive",
    )
    slope = deviation((X - D) ** 2, sp.S.One).diff(X).subs(X, 0)
    yield Step(
        "two agents that pass through each other: E, a function of |x|, has a corner at 0",
        sp.simplify(slope + sp.Rational(4, 3) * D) == 0 and slope.is_negative is True,
        r"\frac{dE}{dx}(0^\pm) = \mp\tfrac43 d",
    )
    z = sigma_norm(X, eps=EPS)
    edge, h = sigma_norm(r, eps=EPS), 1 / (1 + sp.Symbol("t", positive=True))
    force = (taper(z / edge, h=h) * PHI(z)) * z.diff(X)  # dψ_α(z)/dx
    yield Step(
        "ψ_α of the same pair at r: its slope is 0 from within, as it is beyond, and its value an integral",
        sp.simplify(force.subs(X, r)) == 0,
        r"\frac{d}{dx}\psi_\alpha = \phi_\alpha(z)\,z'(x), \qquad \phi_\alpha(r_\alpha) = 0",
        "for any smooth φ, every h in (0, 1)",
    )
    yield Step(
        "ψ_α at coincidence: its slope is 0 from both sides, for the σ-norm is flat there",
        z.diff(X).subs(X, 0) == 0,
        r"z'(0) = 0",
    )


PROOF = Proof(
    id="deviation-energy",
    title="The deviation energy is not smooth where V is",
    statement=(
        "E(q) jumps whenever a pair passes the distance r, unless E = (r - d)² there, and has a corner where linked "
        "agents coincide. V(q) is continuously differentiable at both (twice so: `smoothness`)."
    ),
    hypotheses="0 < h < 1, 0 < d < r, ε > 0; n >= 2 agents",
    rigour="symbolic",
    steps=_steps,
    size=5,
    theorems=("deviation-energy",),
)
