"""Erratum E3: five agents, two of them in one place, in a strict minimum of V that is no α-lattice; Algorithm 1.

Two triangles of side d on a common side, and a second agent on one of its ends: in units of ½d and ½√3 d all places are
whole numbers, so that no length is rounded. V is smooth at coincidence, where its pair has the Hessian φ_α(0)·1.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations

import sympy as sp
from flint import arb, arb_mat, ctx

from flockana.certified.balls import AlphaParameters, ball, square
from flockana.certified.decimal_rounding import at_least
from flockana.certified.krawczyk import least_eigenvalue
from flockana.certified.scalar_functions_in_balls import phi_alpha, sigma_of_square
from flockana.laws.olfati_saber import Algorithm1
from flockana.symbolic.sigma_norms import sigma_norm
from proofs.compressed_patches import LIFT, Flock, rotation
from proofs.proof import Proof, Step
from proofs.unstressed_patches import laplacian_rank, modes_decay, off_the_edges, pair_hessian, squared

DIGITS = 30
SITES = ((0, 0), (2, 0), (1, 1), (1, -1), (0, 0))
LAW = Algorithm1()  # the paper's parameters
STATED = {"n": "5"}


def places(par: AlphaParameters, sites: tuple[tuple[int, int], ...] = SITES) -> list[arb]:
    """Positions of the sites, enclosed."""
    half = ball(par.d) / 2
    return [x for site in sites for x in (half * site[0], half * arb(3).sqrt() * site[1])]


def least_curvature(par: AlphaParameters, q: list[arb]) -> arb | None:
    """A number > 0 below all eigenvalues of ∇²V but those of the rigid motions, in units of c1α; None if uncertain."""
    u = Flock(par, arb(1), arb(0), len(q) // 2)
    motions = [rotation(q), *([arb(int(k % 2 == axis)) for k in range(len(q))] for axis in (0, 1))]
    total = u.hessian(q)
    for motion in motions:
        column = arb_mat(len(q), 1, motion)
        total += column * column.transpose() * (LIFT / sum(map(square, motion), arb(0)))
    return least_eigenvalue(total)


def _coincidence() -> Iterator[Step]:
    x, y, eps = sp.symbols("x y epsilon", positive=True)
    z, psi = sp.Symbol("z"), sp.Function("psi")
    energy = psi(z).series(z, 0, 3).removeO().doit()
    origin = {x: 0, y: 0}
    placed = energy.subs(z, sigma_norm(sp.Matrix([x, y]), eps=eps))
    slope = psi(z).diff(z).subs(z, 0)
    yield Step(
        "a coincident pair: no force, and the Hessian ψ_α'(0)·1 = φ_α(0)·1, as the σ-norm is ½‖x‖² there",
        all(sp.simplify(placed.diff(v).subs(origin)) == 0 for v in (x, y))
        and sp.simplify(sp.hessian(placed, (x, y)).subs(origin) - slope * sp.eye(2)) == sp.zeros(2),
        r"\nabla^2\psi_\alpha(\|x\|_\sigma)\big|_{x = 0} = \phi_\alpha(0)\,1",
    )


def _steps() -> Iterator[Step]:
    yield from pair_hessian()
    yield from _coincidence()
    squares = [squared(a, b) for a, b in combinations(SITES, 2)]
    yield Step(
        "one pair is coincident, its agents have three common neighbours, at distance d, all links are d long, and the "
        "last pair √3 d apart: no pair pulls, and as one pair is neither d apart nor out of range, it is no α-lattice",
        sorted(squares) == [0, *[4] * 8, 12],
        evidence=f"squared distances over ¼d²: {sorted(squares)}",
        found={"n": str(len(SITES))},
    )
    near = tuple((i, j) for i, j in combinations(range(len(SITES)), 2) if squared(SITES[i], SITES[j]) <= 4)
    yield Step(
        "the net is connected: L̂ has no kernel but translations, and every other motion is damped",
        laplacian_rank(len(SITES), near) == len(SITES) - 1,
    )
    with ctx.workdps(DIGITS):
        par = AlphaParameters.of(LAW.alpha)
        lengths = [sigma_of_square(square(ball(par.d)) * s / 4, par.eps) for s in (0, 4)]
        yield Step(
            "none but these are in range, r² < 3d², and φ_α is analytic at 0 and at d_α",
            bool(par.r**2 < 3 * par.d**2) and all(off_the_edges(z, par) for z in lengths),
        )
        yield Step("the coincident pair repels: φ_α(0) < 0", bool(phi_alpha(arb(0), par) < 0))
        least = least_curvature(par, places(par))
        yield Step(
            "and yet ∇²V is positive definite off the rigid motions: the common neighbours hold the two together",
            True if least else None,
            evidence="not certain" if least is None else f"the eigenvalues are at least {at_least(least)} c1α",
        )
    yield from modes_decay()


PROOF = Proof(
    id="double-agent",
    title="Erratum E3: a strict minimum of V with a coincident pair",
    statement=(
        f"{STATED['n']} agents at the corners of a rhombus of two triangles of side d, two of them at one end of the "
        "common side, are an equilibrium of Algorithm 1 and a strict local minimum of V modulo rigid motions, and no "
        "α-lattice. Modulo these motions it is locally asymptotically stable."
    ),
    hypotheses=(
        f"m = 2; {AlphaParameters.of(LAW.alpha)}; c1α, c2α > 0. The last conclusion is cited: where all "
        "eigenvalues but "
        "those along a manifold of equilibria have negative real parts, nearby solutions converge to one of them "
        "(centre manifold theorem; Carr 1981)"
    ),
    rigour="interval",
    steps=_steps,
    size=12,
    theorems=("E3",),
    values=STATED,
)
