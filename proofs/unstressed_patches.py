"""Algorithm 1: the hexagonal patches of 7 and 19 agents are equilibria, and stable but for rigid motions.

All sites are q = ½d (X, √3 Y) with whole X, Y: squared distances are whole multiples of d², and the rigidity matrix
has the rank of a matrix of whole numbers, as its columns for y can be divided by √3. Nothing is rounded.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations

import sympy as sp
import z3
from flint import arb, arb_mat, ctx, fmpz_mat

from flockana.certified.balls import AlphaParameters, ball, square
from flockana.certified.decimal_rounding import at_least, plus_minus
from flockana.certified.krawczyk import least_eigenvalue
from flockana.certified.scalar_functions_in_balls import adjacency, d_alpha, phi_alpha_slope, r_alpha
from proofs.enclosures import parameter_sets
from proofs.proof import Proof, Step
from proofs.signs_of_phi import GIVEN, sigmoid
from proofs.smt import implication, impossible

DIGITS = 30
RINGS = (1, 2)
SIZES = {"n of 1 rings": "7", "n of 2 rings": "19"}
THE_SIZES = " and ".join(SIZES.values())
Site = tuple[int, int]  # X, Y
Links = tuple[tuple[int, int], ...]


def patch(rings: int) -> tuple[Site, ...]:
    """A hexagon of the triangular lattice with so many rings about its centre."""
    reach = range(-rings, rings + 1)
    return tuple((2 * i + j, j) for i in reach for j in reach if abs(i + j) <= rings)


def squared(a: Site, b: Site) -> int:
    """4‖q_b - q_a‖²/d², a whole multiple of 4."""
    return (b[0] - a[0]) ** 2 + 3 * (b[1] - a[1]) ** 2


def links_of(sites: tuple[Site, ...]) -> Links:
    """Pairs at the distance d."""
    return tuple((i, j) for i, j in combinations(range(len(sites)), 2) if squared(sites[i], sites[j]) == 4)


def rigidity_matrix(sites: tuple[Site, ...], links: Links) -> fmpz_mat:
    """Rows (…, -u, …, u, …) of the links, in units of ½d and with the columns for y divided by √3."""
    rows = []
    for i, j in links:
        row = [0] * (2 * len(sites))
        for axis in (0, 1):
            row[2 * j + axis] = sites[j][axis] - sites[i][axis]
            row[2 * i + axis] = -row[2 * j + axis]
        rows.append(row)
    return fmpz_mat(rows)


def rigid_motions(sites: tuple[Site, ...]) -> fmpz_mat:
    """Columns: two translations and the rotation, in the same units: (-√3 Y, X) becomes (-Y, X), up to a factor."""
    return fmpz_mat([row for x, y in sites for row in ([1, 0, -y], [0, 1, x])])


def laplacian_rank(size: int, links: Links) -> int:
    """Rank of the graph's Laplacian, exactly."""
    matrix = [[0] * size for _ in range(size)]
    for i, j in links:
        for a, b in ((i, j), (j, i)):
            matrix[a][a] += 1
            matrix[a][b] -= 1
    return int(fmpz_mat(matrix).rank())


def stiffness(par: AlphaParameters) -> arb:
    """k, of a link of length d: φ_α'(d_α) d²/(1 + εd²), without the gain."""
    return phi_alpha_slope(d_alpha(par), par) * square(ball(par.d)) / (1 + ball(par.eps) * square(ball(par.d)))


def off_the_edges(z: arb, par: AlphaParameters) -> bool:
    """Whether φ_α is certainly analytic at z, in range: before the taper, or within it."""
    knee, cutoff = ball(par.h) * r_alpha(par), r_alpha(par)
    return bool(z < knee or knee < z < cutoff)


def least_curvature(sites: tuple[Site, ...], links: Links) -> arb | None:
    """A lower bound of the eigenvalues of Σ uuᵀ over the links plus projections on the rigid motions."""
    size = 2 * len(sites)
    places = [(arb(x) / 2, arb(3).sqrt() * y / 2) for x, y in sites]
    rows = [[arb(0)] * size for _ in links]
    for row, (i, j) in zip(rows, links, strict=True):
        for axis in (0, 1):
            row[2 * j + axis] = places[j][axis] - places[i][axis]
            row[2 * i + axis] = -row[2 * j + axis]
    inertia = sum((square(x) + square(y) for x, y in places), arb(0)).sqrt()
    rows += [[arb(int(k % 2 == axis)) / arb(len(sites)).sqrt() for k in range(size)] for axis in (0, 1)]
    rows.append([x for place in places for x in (-place[1] / inertia, place[0] / inertia)])
    matrix = arb_mat(rows)
    return least_eigenvalue(matrix.transpose() * matrix)


def pair_hessian() -> Iterator[Step]:
    """What the Hessian of a pair's energy is, of any function of the length; at the length d, k uuᵀ."""
    x, y = sp.symbols("x y", positive=True)
    length, u = sp.sqrt(x**2 + y**2), sp.Matrix([x, y]) / sp.sqrt(x**2 + y**2)
    f = sp.Function("f")
    s = sp.Symbol("s", positive=True)
    slope, bend = (f(s).diff(s, k).subs(s, length) for k in (1, 2))
    hessian = sp.hessian(f(length), (x, y))
    residual = (hessian - bend * u * u.T - slope / length * (sp.eye(2) - u * u.T)).doit()
    yield Step(
        "the Hessian of a function f of the length ‖q_j - q_i‖ is f'' uuᵀ + (f'/length)(1 - uuᵀ), u the direction",
        residual.applyfunc(sp.simplify).is_zero_matrix is True,
        r"\nabla^2 f(\|x\|) = f''\,uu^\top + \frac{f'}{\|x\|}(1 - uu^\top)",
    )
    eps, psi = sp.Symbol("epsilon", positive=True), sp.Function("psi")
    z = sp.Symbol("z", positive=True)
    norm = (sp.sqrt(1 + eps * s**2) - 1) / eps
    force, stiff = (psi(z).diff(z, k).subs(z, norm).doit() for k in (1, 2))
    energy = psi(norm)
    root = sp.sqrt(1 + eps * s**2)
    yield Step(
        "of f = ψ_α(‖s‖_σ): f' = φ_α s/√(1 + εs²), f'' = φ_α' s²/(1 + εs²) + φ_α/√(1 + εs²)³",
        sp.simplify((energy.diff(s) - force * s / root).doit()) == 0
        and sp.simplify((energy.diff(s, 2) - stiff * s**2 / root**2 - force / root**3).doit()) == 0,
        r"k = f''(d) = \varphi_\alpha'(d_\alpha)\,\frac{d^2}{1+\epsilon d^2}, \qquad f'(d) = 0",
    )
    f_, t, w = z3.Reals("f s w")
    known = (*GIVEN, *sigmoid(f_, t, w), t == 0)
    yield implication("φ_α(d_α) = 0, as φ(0) = 0: links of length d carry no force", f_ == 0, *known)


def modes_decay() -> Iterator[Step]:
    """From a Hessian whose kernel is known to the stability of what is at rest there."""
    mu, omega, damping, curvature = z3.Reals("mu omega delta kappa")
    root = (mu**2 - omega**2 + damping * mu + curvature == 0, 2 * mu * omega + damping * omega == 0)
    yield implication(
        "a mode v with vᴴDv = δ > 0 and vᴴ∇²U v = κ > 0 decays: λ² + δλ + κ = 0 has Re λ < 0",
        mu < 0,
        *(*root, damping > 0, curvature > 0),
        latex=r"(\lambda^2 + \lambda D + \nabla^2 U)\,v = 0 \implies \lambda^2 + \delta\lambda + \kappa = 0",
    )
    yield implication(
        "with κ = 0, v in the kernel: λ = 0 or Re λ < 0",
        z3.Or(mu < 0, z3.And(mu == 0, omega == 0)),
        *(*root, damping > 0, curvature == 0),
    )
    stiff, damped = z3.Reals("vHw vDv")
    yield impossible(
        "and λ = 0 is simple: ∇²U w + D v = 0 with ∇²U v = 0 would give vᵀDv = -vᵀ∇²U w = 0, but vᵀDv > 0",
        *(stiff + damped == 0, stiff == 0, damped > 0),
        latex=r"\nabla^2 U\,v = 0,\ \nabla^2 U\,w + D v = 0 \implies v^\top D v = 0",
    )


def _patch(rings: int) -> Iterator[Step]:
    sites = patch(rings)
    n, links = len(sites), links_of(sites)
    squares = {squared(sites[i], sites[j]) for i, j in combinations(range(n), 2)}
    yield Step(
        f"n = {n}: {len(links)} links of length d exactly, all other pairs at √3 d or more",
        n == 3 * rings * (rings + 1) + 1 and min(squares) == 4 and min(squares - {4}) >= 12,
        evidence=f"squared distances over d²: {sorted(s // 4 for s in squares)}",
        found={f"n of {rings} rings": str(n)},
    )
    matrix, motions = rigidity_matrix(sites, links), rigid_motions(sites)
    rank = matrix.rank()
    yield Step(
        f"n = {n}: the rigidity matrix has rank 2n - 3 = {2 * n - 3} and takes the three rigid motions to 0: they are "
        "all of its kernel, which is that of Σ k uuᵀ, k > 0",
        rank == 2 * n - 3 and motions.rank() == 3 and not any((matrix * motions).entries()),
        r"x^\top \nabla^2 V\,x = k \sum_{(i,j)} \langle u_{ij}, x_j - x_i\rangle^2",
        f"rank {rank} of {len(links)} rows of whole numbers",
    )
    yield Step(
        f"n = {n}: the net is connected, and L̂ has no kernel but translations: the rotation is damped",
        laplacian_rank(n, links) == n - 1,
        r"v^\top \hat L v = a \sum_{(i,j)} \|v_j - v_i\|^2",
    )
    least = least_curvature(sites, links)
    yield Step(
        f"n = {n}: quantitatively, off the rigid motions the eigenvalues of ∇²V are at least as many k as this",
        True if least else None,
        evidence="not certain" if least is None else at_least(least),
    )


def stiffness_step(par: AlphaParameters) -> Step:
    """Links at their length d are stiff, none but those of the lattice are in range, and φ_α is smooth there."""
    k, a, here = stiffness(par), adjacency(d_alpha(par), par), d_alpha(par)
    smooth = off_the_edges(here, par)
    return Step(
        f"{par}: k > 0, a_ij(d) > 0; r² < 3d², and φ_α is smooth about d_α",
        bool(k > 0 and a > 0 and par.r**2 < 3 * par.d**2) and smooth,
        rf"k = ({plus_minus(k, 15)})\,c_1^\alpha, \qquad a_{{ij}} = {plus_minus(a, 15)}",
        f"k in {k.str(20)}, a_ij in {a.str(20)}",
    )


def _steps() -> Iterator[Step]:
    yield from pair_hessian()
    with ctx.workdps(DIGITS):
        for par in parameter_sets():
            if isinstance(par, AlphaParameters):
                yield stiffness_step(par)
        for rings in RINGS:
            yield from _patch(rings)
    yield from modes_decay()


PROOF = Proof(
    id="unstressed-patches",
    title="Algorithm 1: hexagonal patches are stable equilibria",
    statement=(
        f"The hexagonal patches of n = {THE_SIZES} agents at distances d are equilibria of Algorithm 1, with ∇²V "
        "= Σ k uuᵀ "
        "over the links, k > 0, whose kernel is exactly the rigid motions; modulo these they are locally "
        "asymptotically stable, in the frame of the centre. For the parameters of every scenario."
    ),
    hypotheses=(
        "m = 2; c1α, c2α > 0. The last conclusion is cited: where all eigenvalues but those along a manifold of "
        "equilibria, here the rotated patches, have negative real parts, nearby solutions converge to one of them "
        "(centre manifold theorem; Carr 1981)"
    ),
    rigour="interval",
    steps=_steps,
    size=19,
    values=SIZES,
)
