"""The bearing-distance Theorem 1 as printed: exact counterexamples, and what its proof gets wrong (errata J1 to J5)."""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction
from itertools import count, pairwise, permutations

import sympy as sp
import z3

from flockana.certified.decimal_rounding import decimal
from flockana.sources.jond_2025.symbolic.spanning_trees import (
    MU,
    RHO,
    S,
    edge_matrices,
    frozen_eigenvalues,
    incidence_matrix,
    receiver_matrix,
    separation_forms,
    stacked_form,
    symmetric_part,
)
from proofs.bearing_distance import no_collision, spring
from proofs.evaluate import differs
from proofs.proof import Proof, Step
from proofs.smt import implication

EXCESS = sp.Symbol("epsilon", positive=True)  # of μ over the value from which A_cl is unstable
_HALF = sp.Rational(1, 2)
STATED = {"eigenvalue": "0.618", "children": "5"}
_OUTER, _MIDDLE = sp.Rational(41, 20), sp.Rational(27, 10)
_PATH = ((0, 1), (1, 0), (1, 2), (2, 1), (2, 3), (3, 2))
_GRAPH = ((0, 1), (2, 1), (1, 2), (2, 3))  # agent 1 has two neighbours, agent 2 is one of them and sees it


def path_of_four(mu: sp.Expr) -> tuple[sp.Matrix, sp.Matrix]:
    """(A^s, A^a) of an undirected path of four with |x| = 2.05, 2.7, 2.05 and αr = |N_i| = 1, 2, 2, 1."""
    lengths = dict.fromkeys(_PATH, _OUTER) | dict.fromkeys(_PATH[2:4], _MIDDLE)
    weights = {f"w_{j}{i}": mu * (1 - (1 if i in (0, 3) else 2) / lengths[j, i]) for j, i in _PATH}
    stiffness, damping = edge_matrices(_PATH)
    return stiffness.subs(weights), damping


def quadratic_factors(damping: sp.Matrix, stiffness: sp.Matrix) -> Iterator[sp.Expr]:
    """Every product of s² + s μ_i + γ_i that pairs the nonzero eigenvalues of the two matrices, and 0 with 0."""
    mus, gammas = ([v for v, k in m.eigenvals().items() for _ in range(k) if v != 0] for m in (damping, stiffness))
    for order in permutations(gammas):
        yield sp.prod([S**2 + S * m + g for m, g in zip(mus, order, strict=True)])


def star_rows_hold() -> bool:
    """Whether (±√k, 1, ..., 1) are eigenvectors for every k, row by row.

    With a = parent edge, S_aa = S_cc = 1, S_ac = S_ca = -1/2 for each child c, and 0 between children: the entries of
    the matrix itself, which are read off that of two children and are the same for any two.
    """
    k = sp.Symbol("k", integer=True, positive=True)
    edges = ((0, 1), (1, 2), (1, 3))
    whole = incidence_matrix(edges).T * receiver_matrix(edges)
    part = (whole + whole.T) / 2
    own, child, between, (up, other) = part[0, 0], part[1, 1], part[1, 2], (part[0, 1], part[0, 2])
    rows = [
        (own * y + up * k - (1 - y / 2) * y, up * y + child + between * (k - 1) - (1 - y / 2))
        for y in (sp.sqrt(k), -sp.sqrt(k))
    ]
    return up == other and part[2, 2] == child and all(sp.expand(row) == 0 for pair in rows for row in pair)


def routh(coefficients: list[sp.Expr]) -> list[sp.Expr]:
    """The first column of Routh's array, for a polynomial with no zero in it: its sign changes count roots Re s > 0."""
    rows = [coefficients[::2], [*coefficients[1::2], sp.S.Zero][: len(coefficients[::2])]]
    for _ in coefficients[2:]:
        (a, *above), (b, *left) = rows[-2:]
        rows.append([(b * x - a * y) / b for x, y in zip(above, left, strict=False)] + [sp.S.Zero])
    return [row[0] for row in rows]


def one_sign(entry: sp.Expr) -> int | None:
    """The sign of a rational function for every EXCESS > 0, if the signs of its coefficients tell."""
    parts = [{sp.sign(c) for c in sp.Poly(part, EXCESS).coeffs()} for part in sp.fraction(sp.together(entry))]
    return int(sp.prod([one for (one,) in parts])) if all(len(part) == 1 for part in parts) else None


def three_path(d: int) -> tuple[sp.Matrix, sp.Matrix, dict[sp.Symbol, sp.Expr]]:
    """Controls, Jacobian of the relative motion, and the state where both ends are 5/3 behind the middle agent.

    An undirected path of three with αr = |N_i| = 1, 2, 1 and μ = 1, in a = p_1 - p_2, b = p_3 - p_2 and their rates.
    """
    a, b, v, w = (sp.Matrix(sp.symbols(f"{name}_1:{d + 1}", real=True)) for name in "abvw")
    one, two = sp.S.One, sp.Integer(2)
    ends = [-spring(x, one, one) - rate for x, rate in ((a, v), (b, w))]
    middle = spring(a, one, two) + spring(b, one, two) + (v + w) / 2
    state = sp.Matrix.vstack(a, b, v, w)
    field = sp.Matrix.vstack(v, w, ends[0] - middle, ends[1] - middle)
    behind = dict.fromkeys(state, sp.S.Zero) | {a[0]: sp.Rational(-5, 3), b[0]: sp.Rational(-5, 3)}
    return sp.Matrix.hstack(ends[0], middle, ends[1]), field.jacobian(state), behind


def _signs() -> Iterator[Step]:
    forms = separation_forms(_GRAPH)
    for name, text, holds in (
        ("28", "J4: (28) as printed, with +(d_i W_i ⊗ I)q, is not the separation", False),
        ("28-corrected", "J4: with -(d_i W_i ⊗ I)q it is", True),
        ("identity", "J4: the identity before (34) as printed gives q the wrong sign", False),
        ("identity-corrected", "J4: with the other sign it holds", True),
        ("34", "J4: the two errors cancel: (34) holds", True),
    ):
        residuals = forms[name].residuals
        yield Step(
            text,
            all(r == 0 for r in residuals) if holds else any(map(differs, residuals)),
            evidence="every component, agents with one and with two neighbours",
        )
    yield Step("(35): u = -D_in W^s Dᵀp - D_in W^a Dᵀv", stacked_form(_GRAPH).holds)
    D, heads = incidence_matrix(((0, 1), (1, 2))), receiver_matrix(((0, 1), (1, 2)))
    yield Step(
        "J4: on the chain 1 → 2 → 3, D Dᵀ is the undirected Laplacian, D_in Dᵀ the directed one: they differ",
        (D * D.T).tolist() == [[1, -1, 0], [-1, 2, -1], [0, -1, 1]]
        and (heads * D.T).tolist() == [[0, 0, 0], [-1, 1, 0], [0, -1, 1]],
    )


def _edges_do_not_vanish() -> Iterator[Step]:
    x = sp.Matrix(sp.symbols("x_1:3", real=True))
    at_rest = spring(x).subs({x[0]: 3 * RHO / 5, x[1]: 4 * RHO / 5})
    yield Step(
        "J1: a follower at rest at distance ρ from a root at rest stays there: x = (3/5, 4/5)ρ for ever, not 0",
        sp.simplify(at_rest) == sp.zeros(2, 1),
        r"g(x) = \mu(1 - \rho/|x|)\,x = 0",
    )
    yield no_collision("J1: nor does x → 0 from any start with V(0) < μρ²/2, an open set: V falls (bearing-distance)")
    t, angle = sp.symbols("t theta", positive=True)
    ray = spring(t * sp.Matrix([sp.cos(angle), sp.sin(angle)]))
    yield Step(
        "J1: x = 0 is a collision, at which (35) has no meaning: |g(x)| → μρ, in the direction that x comes from",
        sp.simplify(ray.applyfunc(lambda y: sp.limit(y, t, 0)))
        == -MU * RHO * sp.Matrix([sp.cos(angle), sp.sin(angle)]),
    )


def _not_hurwitz() -> Iterator[Step]:
    yield Step(
        f"J2: two agents at half the spacing: A_cl has the eigenvalue (√5 - 1)/2 = {STATED['eigenvalue']}…",
        frozen_eigenvalues(_HALF)[0] == (sp.sqrt(5) - 1) / 2,
        r"s^2 + s + \mu(1 - \rho/|x|) = s^2 + s - 1",
        found={"eigenvalue": decimal(Fraction(int(sp.floor(1000 * frozen_eigenvalues(_HALF)[0])), 1000))},
    )
    yield Step("J2: at the spacing it has the eigenvalue 0: singular at the goal", frozen_eigenvalues(sp.S.One)[0] == 0)
    root = z3.Real("√k")
    least = next(k for k in count(1) if symmetric_part(k).result.is_negative)
    yield Step(
        f"J2: the symmetric part of DᵀD_in at root → a → {{k children}} has eigenvalues 1 - √k/2, 1 + √k/2 and 1: of "
        f"the matrix itself for k = 1 to {least + 2}, and of its rows for every k",
        all(symmetric_part(k).holds for k in range(1, least + 3)) and star_rows_hold(),
        r"\begin{pmatrix} 1 & -\tfrac12 \mathbf 1^\top \\ -\tfrac12 \mathbf 1 & I\end{pmatrix}"
        r"\begin{pmatrix} \sqrt k \\ \mathbf 1\end{pmatrix} = \left(1 - \tfrac{\sqrt k}{2}\right)"
        r"\begin{pmatrix} \sqrt k \\ \mathbf 1\end{pmatrix}",
        "1 on the k - 1 dimensions of vectors (0, z) with Σz = 0",
        {"children": str(least)},
    )
    yield implication(
        f"J2: negative if and only if k > {least - 1}: with {least} children it is not positive definite, though "
        "a spanning tree",
        (1 - root / 2 < 0) == (root**2 > least - 1),
        root > 0,
    )


def _no_pairing() -> Iterator[Step]:
    stiffness, damping = path_of_four(sp.Integer(400))
    size = stiffness.rows
    yield Step(
        "J3: path of four, every |x_e| > αr: A^a has the eigenvalues 0, 0, 0, 1/2, 3/2, 2",
        damping.eigenvals() == {0: 3, _HALF: 1, 3 * _HALF: 1, 2: 1} and bool(min(_OUTER, _MIDDLE) > 2),
    )
    pencil = sp.Poly((S**2 * sp.eye(size) + S * damping + stiffness).det(method="berkowitz"), S)
    pairings = [sp.Poly(S**6 * product, S) for product in quadratic_factors(damping, stiffness)]
    yield Step(
        "J3: at μ = 400 no pairing λ² + λμ_i + γ_i = 0 of its eigenvalues with those of A^s gives those of A_cl",
        pencil.monoms()[-1] == (6,) and all(any(map(differs, (pencil - one).all_coeffs())) for one in pairings),
        r"\det(s^2 I + s A^a + A^s) \ne \prod_i (s^2 + s\mu_i + \gamma_i)",
        f"{len(pairings)} pairings of the nonzero ones; 0 has to go with 0, as 0 is sixfold",
    )
    stiffness, _ = path_of_four(sp.S.One)
    spectrum = stiffness.eigenvals()
    yield Step(
        "J3: the eigenvalues of A^s are three zeros and μ times three positive numbers",
        sorted(spectrum.values()) == [1, 1, 1, 3] and all(v.is_positive or v == 0 for v in spectrum),
    )
    threshold = sp.Rational(300735, 407)
    stiffness, damping = path_of_four(threshold + EXCESS)
    pencil = sp.Poly((S**2 * sp.eye(size) + S * damping + stiffness).det(method="berkowitz"), S)
    (part,) = (factor for factor, _ in sp.factor_list(pencil)[1] if sp.Poly(factor, S).degree() == 4)
    column = [one_sign(entry) for entry in routh(sp.Poly(part, S).all_coeffs())]
    yield Step(
        "J3: and yet A_cl has two eigenvalues with positive real part for every μ > 300735/407 = 738.9, 1000 and 4000 "
        "among them, by Routh's array",
        None not in column and sum(one != other for one, other in pairwise(column)) == 2,
        sp.latex(sp.factor(part.as_expr().subs(EXCESS, MU - threshold))),
        f"signs of its first column: {column}",
    )


def _no_common_spacing() -> Iterator[Step]:
    here, there, length = z3.Reals("|N_i| |N_j| length")
    yield implication(
        "J5: (27) asks |p_j - p_i| → |N_i| and → |N_j|: neighbours that see each other need equally many neighbours",
        here == there,
        *(length == here, length == there),
    )
    near, own, other = z3.Reals("|p_j-p_i| R_i R_j")
    yield implication(
        "J5: with equal radii j sees i if i sees j: such a graph is never a directed tree",
        near <= other,
        *(own == other, near <= own),
    )
    own, one = z3.Reals("R_i spacing")
    yield implication(
        "J5: in a directed tree |N_i| = 1, so edges should be 1 long; no agent then sees its parent and not its child",
        z3.Not(z3.And(one <= own, one > own)),
        one == 1,
    )


def _ends_coincide() -> Iterator[Step]:
    for d in (2, 3):
        u, jacobian, behind = three_path(d)
        forward = sp.Matrix([[sp.Rational(2, 3)] * 3, *([0] * 3 for _ in range(d - 1))])
        yield Step(
            f"J5, d = {d}: path of three, ends 5/3 behind the middle coincide, and all three accelerate at 2/3",
            u.subs(behind) == forward,
            r"\tfrac53 - 1 = \tfrac23 = 2\left(2 - \tfrac53\right)",
        )
        found = sp.factor_list(jacobian.subs(behind).charpoly(S).as_expr())[1]
        rest = [(factor, k) for factor, k in found if factor != S]
        zeros = sum(k for factor, k in found if factor == S)
        size = 4 * d
        yield Step(
            f"J5, d = {d}: linearised, this state is stable but for its direction: it attracts an open set of states",
            zeros == d - 1
            and jacobian.subs(behind).rank() == size - zeros
            and all(c > 0 for factor, _ in rest for c in sp.Poly(factor, S).all_coeffs())
            and all(sp.degree(factor, S) <= 2 for factor, _ in rest),
            " ".join(rf"({sp.latex(factor)})^{{{k}}}" for factor, k in rest),
            f"0 is semisimple, {zeros} times; the other factors are linear or quadratic with positive coefficients",
        )


def _steps() -> Iterator[Step]:
    yield from _edges_do_not_vanish()
    yield from _not_hurwitz()
    yield from _no_pairing()
    yield from _signs()
    yield from _no_common_spacing()
    yield from _ends_coincide()


PROOF = Proof(
    id="bearing-distance-printed",
    title="Bearing-distance flocking: Theorem 1 as printed is false (J1 to J5)",
    statement=(
        "On a spanning tree the edges need not vanish: two agents at rest at the desired spacing stay there, and an "
        "open set of starts keeps |x| away from 0. A_cl need not be Hurwitz: two agents at half the spacing have the "
        f"eigenvalue {STATED['eigenvalue']}…. DᵀD_in is not positive definite at a node of {STATED['children']} "
        "children. Eigenvalues do not pair off on "
        "an undirected path, and A_cl is unstable there though every edge is longer than αr and A^s, A^a have "
        "nonnegative eigenvalues. With αr = |N_i| the frozen path of three runs, from an open set of states, into two "
        "coincident agents and acceleration for ever."
    ),
    hypotheses="frozen graphs, μ = σ = 1 unless said; J5 cites the theorem on normally hyperbolic manifolds",
    rigour="smt",
    theorems=("zone-1-printed", "J1", "J2", "J3", "J4", "J5"),
    steps=_steps,
    size=25,
    values=STATED,
)
