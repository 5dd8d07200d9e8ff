"""The bearing-distance Theorem 1 as corrected (spec B3, B5, B6; erratum J6): what is true of frozen trees.

Trees are numbered from the root, agent 0, so that every parent comes before its child: parent(i) < i. An edge bears the
number of its child. All rooted trees are grown from one agent by adding leaves, the last agent first to go: so what
holds of one agent, and of a tree with a leaf added if of the tree without, holds of all.
"""

from __future__ import annotations

from collections.abc import Iterator

import sympy as sp
import z3

from flockana.sources.jond_2025.symbolic.spanning_trees import MU, RHO, S, tree_characteristic
from proofs.proof import Proof, Step
from proofs.rooted_trees import Tree, trees, unit_edge
from proofs.smt import implication, real
from proofs.undirected_trees import undirected_trees

SIGMA = sp.Symbol("sigma", positive=True)


def spring(x: sp.Matrix, stiffness: sp.Expr = MU, length: sp.Expr = RHO) -> sp.Matrix:
    """g(x) = μ(1 - ρ/|x|)x."""
    return stiffness * (1 - length / sp.sqrt(x.dot(x))) * x


def stiffness(x: sp.Matrix, size: sp.Expr, weight: sp.Expr = MU, length: sp.Expr = RHO) -> sp.Matrix:
    """Dg(x) in closed form, where |x| = size."""
    return weight * ((1 - length / size) * sp.eye(len(x)) + length * x * x.T / size**3)


def own_block(curvature: sp.Matrix) -> sp.Matrix:
    """The linearised x'' = -g(x) - x' in (x, x')."""
    d = curvature.rows
    return sp.Matrix(sp.BlockMatrix([[sp.zeros(d), sp.eye(d)], [-curvature, -sp.eye(d)]]))


def parent_block(curvature: sp.Matrix) -> sp.Matrix:
    """What [g(x_π) + x_π'] adds to the child's rows."""
    d = curvature.rows
    return sp.Matrix(sp.BlockMatrix([[sp.zeros(d), sp.zeros(d)], [curvature, sp.eye(d)]]))


def linearised(edges: Tree, d: int) -> sp.Matrix:
    """The linearised edge dynamics of a whole tree at edges of length ρ_i = i, μ_i = i/2, in rational directions."""
    matrix = sp.zeros(2 * d * len(edges))
    for parent, child in edges:
        rows = slice(2 * d * (child - 1), 2 * d * child)
        matrix[rows, rows] = own_block(link_curvature(child, d))
        if parent:
            matrix[rows, slice(2 * d * (parent - 1), 2 * d * parent)] = parent_block(link_curvature(parent, d))
    return matrix


def link_curvature(agent: int, d: int) -> sp.Matrix:
    """Stiffness matrix of an agent's link to its parent, at its length."""
    length = sp.Integer(agent)
    return stiffness(length * unit_edge(agent, d), length, length / 2, length)


def _vectors(d: int, names: str) -> tuple[sp.Matrix, ...]:
    return tuple(sp.Matrix(sp.symbols(f"{name}_1:{d + 1}", real=True)) for name in names)


def _edges() -> Iterator[Step]:
    for d in (2, 3):
        p, q, v, w = _vectors(d, "pqvw")
        length = sp.sqrt((q - p).dot(q - p))
        control = (SIGMA * w / SIGMA - v) + MU * (q - p - RHO * (q - p) / length)
        yield Step(
            f"d = {d}: an agent with one neighbour, its parent, has u = g(x) + x', x the vector to the parent",
            sp.simplify(control - spring(q - p) - (w - v)) == sp.zeros(d, 1),
            r"\ddot x_i = -g_i(x_i) - \dot x_i + [g_\pi(x_\pi) + \dot x_\pi]",
        )


def _frozen() -> Iterator[Step]:
    parent, child, other = z3.Reals("parent child other")
    yield implication(
        "(DᵀD_in)_ef = [e = f] - [f = parent(e)] vanishes for f > e: DᵀD_in = I - N with N strictly triangular",
        z3.And(other != child, other != parent),
        *(parent < child, other > child),
        latex=r"D_{ve} = [v = e] - [v = \pi(e)],\quad (D_{\mathrm{in}})_{vf} = [v = f]",
    )
    for size in (1, 2, 3, 4):
        block = sp.Matrix(size, size, sp.symbols(f"m_1:{size * size + 1}"))
        row, last = sp.Matrix(1, size, sp.symbols(f"r_1:{size + 1}")), sp.Symbol("c")
        whole = sp.Matrix(sp.BlockMatrix([[block, sp.zeros(size, 1)], [row, sp.Matrix([[last]])]]))
        yield Step(
            f"a leaf adds a column of zeros but for s² + s + w, a factor of the determinant ({size} edges)",
            sp.expand(whole.det(method="berkowitz") - last * block.det(method="berkowitz")) == 0,
            r"\det\begin{pmatrix} M & 0 \\ r & c\end{pmatrix} = c \det M",
        )
    for agents in range(2, 6):
        found = [tree_characteristic(edges).holds for edges in trees(agents)]
        yield Step(
            f"det(s²I + s A^a + A^s) = Π(s² + s + w_e): all {len(found)} numbered trees of {agents} agents, by sympy",
            all(found),
            r"\det(s^2 I + s A^a + A^s) = \prod_e (s^2 + s + w_e),\quad w_e = \mu_e (1 - \rho_e/|x_e|)",
        )


def _hurwitz() -> Iterator[Step]:
    a, b, w, root, mu, rho, x = z3.Reals("a b w root μ ρ |x|")
    zero = (a**2 - b**2 + a + w == 0, 2 * a * b + b == 0)  # s = a + ib
    yield implication("s² + s + w has only roots with negative real part if w > 0", a < 0, *zero, w > 0)
    yield implication(
        "a positive one if w < 0, and 0 if w = 0",
        z3.And(z3.Implies(w < 0, a > 0), z3.Implies(w == 0, a == 0), a**2 + a + w == 0),
        *(w <= 0, root >= 0, root**2 == 1 - 4 * w, 2 * a == root - 1),
    )
    yield implication(
        "w = μ(1 - ρ/|x|) has the sign of |x| - ρ: frozen, A_cl is Hurwitz if and only if |x_e| > ρ_e on every edge",
        z3.And((w > 0) == (x > rho), (w == 0) == (x == rho)),
        *(mu > 0, rho > 0, x > 0, w * x == mu * (x - rho)),
    )


def _manifold() -> Iterator[Step]:
    mu, rho, x = z3.Reals("μ ρ |x|")
    yield implication(
        "(i) at rest g_i = 0 for a child of the root, and g_i = g_π = 0 on: |x_i| = ρ_i on every edge",
        x == rho,
        *(mu > 0, rho > 0, x > 0, mu * (x - rho) == 0),
        latex=r"M = \{|x_i| = \rho_i,\ \dot x_i = 0\} = (S^{d-1})^{n-1}",
    )
    for d in (2, 3):
        x, t = _vectors(d, "xt")
        on_m = stiffness(x, RHO)
        yield Step(
            f"(ii) d = {d}: Dg = μ((1 - ρ/|x|)I + ρxxᵀ/|x|³), on M μ times the projection onto x",
            sp.simplify(spring(x).jacobian(x) - stiffness(x, sp.sqrt(x.dot(x)))) == sp.zeros(d)
            and sp.expand(on_m - MU * x * x.T / RHO**2) == sp.zeros(d),
        )
        found = own_block(on_m).charpoly(S).as_expr()
        expected = (S**2 + S + MU * x.dot(x) / RHO**2) * (S**2 + S) ** (d - 1)
        yield Step(
            f"(ii) d = {d}: an edge on M has the roots of s² + s + μ|x|²/ρ² once and 0, -1 each d - 1 times",
            sp.expand(found - expected) == 0,
            rf"(s^2 + s + \mu)(s^2 + s)^{{{d - 1}}}",
        )
        still = sp.Matrix.vstack(t, sp.zeros(d, 1))
        normal = MU * x.dot(t) / RHO**2 * sp.Matrix.vstack(sp.zeros(d, 1), x)
        yield Step(
            f"(ii) d = {d}: a tangent of M, <x, t> = 0, is in the kernel of its edge, and no child feels it",
            sp.expand(own_block(on_m) * still + normal) == sp.zeros(2 * d, 1)
            and sp.expand(parent_block(on_m) * still - normal) == sp.zeros(2 * d, 1),
            r"\delta\dot x_\pi = 0,\ \langle x_\pi, \delta x_\pi\rangle = 0 \implies "
            r"Dg_\pi\, \delta x_\pi + \delta\dot x_\pi = 0",
            "so kernels add up from edge to edge, as characteristic polynomials multiply",
        )
        within, into = z3.Reals("A_x C_x+B_y")
        felt, own = z3.Reals("C_x B_y")
        yield implication(
            f"(ii) d = {d}, every n: of a tree with a leaf added, blocks A, 0, C, B, the kernel is that of A and "
            "that of B "
            "together, as C vanishes on tangents: its dimension grows by d - 1 with each leaf, and 0 stays semisimple",
            own == 0,
            *(within == 0, into == felt + own, into == 0, z3.Implies(within == 0, felt == 0)),
            latex=r"\begin{pmatrix} A & 0 \\ C & B \end{pmatrix}\begin{pmatrix} x \\ y \end{pmatrix} = 0 \iff "
            r"Ax = 0,\ By = 0",
        )
    for agents, d in ((2, 2), (3, 2), (4, 2), (2, 3), (3, 3)):
        yield Step(
            f"(ii) d = {d}: likewise all trees of {agents} agents; 0 is semisimple, {(agents - 1) * (d - 1)} times",
            all(spectrum_holds(edges, d) for edges in trees(agents)),
            r"\prod_i (s^2 + s + \mu_i)(s^2 + s)^{d-1},\quad \dim\ker = (n-1)(d-1) = \dim M",
            "characteristic polynomial and rank in rational numbers",
        )


def spectrum_holds(edges: Tree, d: int) -> bool:
    """Whether the characteristic polynomial of the linearised tree is the product over its edges."""
    matrix, size = linearised(edges, d), len(edges)
    expected = sp.prod([S**2 + S + sp.Rational(child, 2) for _, child in edges]) * (S**2 + S) ** (size * (d - 1))
    return bool(matrix.charpoly(S) == sp.Poly(sp.expand(expected), S) and matrix.rank() == size * (d + 1))


SQUARE, LENGTH = sp.Symbol("v_squared", nonnegative=True), sp.Symbol("length", positive=True)


def edge_energy(square: sp.Expr = SQUARE, length: sp.Expr = LENGTH) -> sp.Expr:
    """V = |x'|²/2 + μ(|x| - ρ)²/2, of the square of the speed and of the length: all steps about it are of this one."""
    return square / 2 + MU * (length - RHO) ** 2 / 2


def energy_rate(d: int, *, damping: sp.Expr = sp.S.One) -> sp.Expr:
    """dV/dt + damping·|x'|² along x'' = -g(x) - damping·x', with V = |x'|²/2 + μ(|x| - ρ)²/2."""
    x, v = _vectors(d, "xv")
    energy = edge_energy(v.dot(v), sp.sqrt(x.dot(x)))
    rate = sum(energy.diff(a) * b for a, b in zip([*x, *v], [*v, *(-spring(x) - damping * v)], strict=True))
    return sp.simplify(rate + damping * v.dot(v))


def pair_rate(d: int) -> sp.Expr:
    """What a pair adds to dH/dt of the reciprocal law, with σ|v_i - v_j|² added: 0."""
    p, q, v, w = _vectors(d, "pqvw")
    force = spring(q - p) + SIGMA * (w - v)  # on the first; minus that on the second
    potential = edge_energy(sp.S.Zero, sp.sqrt((q - p).dot(q - p)))
    stored = sum(potential.diff(a) * b for a, b in zip([*p, *q], [*v, *w], strict=True))
    return sp.simplify(stored + force.dot(v) - force.dot(w) + SIGMA * (w - v).dot(w - v))


def no_collision(text: str) -> Step:
    """Of V = kinetic + μ(|x| - ρ)²/2 that does not rise above V(0) < μρ²/2."""
    x, mu, rho, start, kinetic, gap = z3.Reals("|x| μ ρ V(0) |x'|² gap")
    names = {SQUARE: kinetic, LENGTH: x, MU: mu, RHO: rho}
    at_gap = real(edge_energy(sp.S.Zero, RHO - LENGTH), {**names, LENGTH: gap})  # V of an edge at rest, shorter by that
    collided = real(edge_energy(sp.S.Zero, sp.S.Zero), names)
    return implication(
        text,
        z3.And(x >= rho - gap, rho - gap > 0),
        *(mu > 0, rho > 0, x >= 0, kinetic >= 0, start < collided, gap >= 0, at_gap == start),
        real(edge_energy(), names) <= start,
        latex=r"|x(t)| \ge \rho - \sqrt{2V(0)/\mu} > 0",
    )


def _energies() -> Iterator[Step]:
    for d in (2, 3):
        yield Step(
            f"(iii) d = {d}: V = |x'|²/2 + μ(|x| - ρ)²/2 has V' = -|x'|² on an edge of the root",
            energy_rate(d) == 0,
            r"\dot V = -|\dot x|^2",
        )
    yield no_collision("(iii) so if V(0) < μρ²/2, then |x(t)| >= ρ - √(2V(0)/μ) > 0: no collision on that edge")
    for d in (2, 3):
        yield Step(
            f"undirected, d = {d}: an edge adds -σ|v_i - v_j|² to H'; its two forces cancel, so that v̄ is constant",
            pair_rate(d) == 0,
            r"H = \tfrac12\sum_i |v_i - \bar v|^2 + \tfrac12\sum_e \mu(|x_e| - \rho)^2,\quad "
            r"\dot H = -\sum_e \sigma |v_i - v_j|^2 \le 0",
        )
    yield no_collision("undirected: if H(0) < μρ²/2, then |x_e(t)| >= ρ - √(2H(0)/μ) > 0 on every edge")


def _steps() -> Iterator[Step]:
    yield from _edges()
    yield from _frozen()
    yield from _hurwitz()
    yield from _manifold()
    yield from _energies()
    yield from undirected_trees()


PROOF = Proof(
    id="bearing-distance",
    title="Bearing-distance flocking: Theorem 1 as corrected",
    statement=(
        "On a frozen directed rooted tree: det(s²I + s A^a + A^s) = Π(s² + s + w_e), Hurwitz if and only if "
        "|x_e| > ρ_e on every edge; the equilibria form M = {|x_e| = ρ_e, x_e' = 0}; at M the spectrum is, per edge, "
        "the roots of s² + s + μ once and 0, -1 each d - 1 times, 0 being semisimple, (n - 1)(d - 1) = dim M times; an "
        "edge of the root keeps |x| >= ρ - √(2V(0)/μ) > 0 if V(0) < μρ²/2. On a frozen undirected graph with "
        "reciprocal forces: H' = -Σ σ|v_i - v_j|² <= 0, the same bound with H on every edge, and |x_e| = ρ at rest on "
        "a tree."
    ),
    hypotheses=(
        "μ, σ, ρ > 0, x_e != 0; a root has no neighbours, u = 0; d = 2, 3. That lengths and velocities converge "
        "near M exponentially follows by the theorem on normally hyperbolic manifolds, cited"
    ),
    rigour="smt",
    theorems=("zone-1-corrected", "J2", "J3"),
    steps=_steps,
    size=40,
)
