"""Matrices of directed perception graphs on rooted trees (bearing-distance Theorem 1).

Edge e = (j, i): j sends, i receives; D has +1 at the receiver and -1 at the sender, D_in keeps the +1. With
x = (-D^T (x) I) p the minimal model reads u = -D_in W^s D^T p - D_in W^a D^T v, W^s = diag w_e. Everything here is
one component of space where the equations are the same in each.
"""

from collections.abc import Sequence
from math import prod

import sympy as sp

from flockana.symbolic.derivation import Derivation, Step

S = sp.Symbol("s")
LAMBDA = sp.Symbol("lambda")
MU, RHO = sp.symbols("mu rho", positive=True)
Edges = Sequence[tuple[int, int]]


def incidence_matrix(edges: Edges) -> sp.Matrix:
    """Return the incidence matrix D, with a row for each agent and a column for each edge."""
    agents = 1 + max(max(edge) for edge in edges)
    return sp.Matrix(agents, len(edges), lambda i, e: int(i == edges[e][1]) - int(i == edges[e][0]))


def receiver_matrix(edges: Edges) -> sp.Matrix:
    """Return D_in, the incidence matrix D with all entries but +1 set to 0."""
    return incidence_matrix(edges).applyfunc(lambda entry: sp.Max(entry, 0))


def _weights(name: str, edges: Edges) -> sp.Matrix:
    return sp.diag(*(sp.Symbol(f"{name}_{j}{i}") for j, i in edges))


def _column(name: str, size: int) -> sp.Matrix:
    return sp.Matrix(sp.symbols(f"{name}_0:{size}"))


def stacked_form(edges: Edges) -> Derivation:
    """Derive (35), u = -D_in W^s D^T p - D_in W^a D^T v, from sums over neighbours, and L = D D^T."""
    D, D_in, w, a = incidence_matrix(edges), receiver_matrix(edges), _weights("w", edges), _weights("a", edges)
    p, v = _column("p", D.rows), _column("v", D.rows)
    u = sp.zeros(D.rows, 1)
    for e, (j, i) in enumerate(edges):
        u[i] += w[e, e] * (p[j] - p[i]) + a[e, e] * (v[j] - v[i])
    stacked_force = -D_in * w * D.T * p - D_in * a * D.T * v
    steps = (
        Step("Each agent sums over the edges that it receives:", u),
        Step("The same, stacked: only the receivers' rows remain.", stacked_force),
        Step(r"$L = D D^T$ forgets the directions; the loop holds", D_in * D.T),
    )
    return Derivation("Stacked form (35)", steps, D_in * D.T, tuple(sp.expand(u - stacked_force)))


def separation_forms(edges: Edges) -> dict[str, Derivation]:
    """Derive the separation from its sums, compared with the paper's matrix forms, printed and corrected."""
    # With q_e = k_e x_e, k_e = rho/|x_e|, agent i separates by the sum of x_e - q_e over its edges (mu = 1).
    D, D_in = incidence_matrix(edges), receiver_matrix(edges)
    p, factors = _column("p", D.rows), sp.diag(*sp.symbols(f"k_0:{len(edges)}"))
    x = -D.T * p
    q = factors * x
    separation = sp.zeros(D.rows, 1)
    for e, (_, i) in enumerate(edges):
        separation[i] += x[e] - q[e]
    forms = {
        "28": (separation, -D_in * D.T * p + D_in * q),
        "28-corrected": (separation, -D_in * D.T * p - D_in * q),
        "identity": (D_in * q, D_in * factors * D.T * p),
        "identity-corrected": (D_in * q, -D_in * factors * D.T * p),
        "34": (separation, -D_in * (sp.eye(len(edges)) - factors) * D.T * p),
    }
    table = {}
    for name, (left, right) in forms.items():
        steps = (Step("By its sums:", left), Step("As a product of matrices:", right))
        table[name] = Derivation(f"Separation, {name}", steps, right, tuple(sp.expand(left - right)))
    return table


def edge_matrices(edges: Edges) -> tuple[sp.Matrix, sp.Matrix]:
    """Return A^s = D^T D_in W^s and A^a = D^T D_in W^a of the edge dynamics x'' = -A^a x' - A^s x."""
    # on a rooted tree every agent but the root has one edge, so W^a = I; elsewhere an agent's edges share its
    # mean
    D, D_in = incidence_matrix(edges), receiver_matrix(edges)
    shares = sp.diag(*(sp.Rational(1, sum(i == head for _, head in edges)) for _, i in edges))
    return D.T * D_in * _weights("w", edges), D.T * D_in * shares


def tree_characteristic(edges: Edges) -> Derivation:
    """Derive det(s^2 I + s A^a + A^s) = prod (s^2 + s + w_e) on a rooted tree, for weights w_e of any sign."""
    stiffness, damping = edge_matrices(edges)
    pencil = S**2 * sp.eye(len(edges)) + S * damping + stiffness
    determinant = sp.expand(pencil.det(method="berkowitz"))
    factors = prod(S**2 + S + sp.Symbol(f"w_{j}{i}") for j, i in edges)
    steps = (
        Step("The pencil of the edge dynamics, triangular in the order of the tree:", pencil),
        Step("Its determinant:", determinant),
        Step(r"One factor for each edge, with $w_e = \mu_e(1 - \rho_e/|x_e|)$:", factors),
    )
    return Derivation("Spectrum on a rooted tree", steps, factors, (sp.expand(determinant - factors),))


def frozen_eigenvalues(ratio: sp.Expr, *, mu: sp.Expr = sp.S.One) -> tuple[sp.Expr, sp.Expr]:
    """Return the eigenvalues of A_cl for an edge at |x| = ratio rho: roots of s^2 + s + mu (1 - 1/ratio)."""
    w = sp.sympify(mu) * (1 - 1 / sp.sympify(ratio))
    root = sp.sqrt(1 - 4 * w)
    return sp.expand((-1 + root) / 2), sp.expand((-1 - root) / 2)


def symmetric_part(children: int) -> Derivation:
    """Derive the spectrum of the symmetric part of D^T D_in for root -> a -> k children: 1 and 1 +- sqrt(k)/2."""
    edges = [(0, 1), *((1, 2 + k) for k in range(children))]
    edge_laplacian = incidence_matrix(edges).T * receiver_matrix(edges)
    symmetric = (edge_laplacian + edge_laplacian.T) / 2
    eigenvalue = 1 - sp.sqrt(children) / 2
    expected = (LAMBDA - 1) ** (children - 1) * ((LAMBDA - 1) ** 2 - sp.Rational(children, 4))
    left = sp.expand(symmetric.charpoly(LAMBDA).as_expr() - expected)
    steps = (
        Step(r"The symmetric part of $D^T D_{in}$:", symmetric),
        Step("Its characteristic polynomial:", expected),
        Step("Its least eigenvalue, negative from five children on:", eigenvalue),
    )
    return Derivation("The edge Laplacian of a tree is not positive definite", steps, eigenvalue, (left,))


def spacing_spectrum(m: int) -> Derivation:
    """Derive the spectrum of an edge at |x| = rho in m dimensions: s^2 + s + mu once, s^2 + s the other m - 1 times."""
    x = sp.Matrix(sp.symbols(f"x_0:{m}", real=True))
    force = MU * (1 - RHO / sp.sqrt(x.dot(x))) * x
    substitution = {x[0]: RHO, **{x[k]: 0 for k in range(1, m)}}
    stiffness = force.jacobian(x).subs(substitution).applyfunc(sp.simplify)
    expected = (S**2 + S + MU) * (S**2 + S) ** (m - 1)
    determinant = (S**2 * sp.eye(m) + S * sp.eye(m) + stiffness).det()
    steps = (
        Step("The spring of an edge:", force),
        Step(r"Its derivative at length $\rho$ along the first axis:", stiffness),
        Step("The characteristic polynomial of the edge:", expected),
    )
    left = sp.expand(determinant - expected)
    return Derivation("Spectrum at the desired spacing", steps, sp.factor(expected), (left,))
