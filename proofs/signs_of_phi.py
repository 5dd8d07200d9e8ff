"""The signs of φ_α, ψ_α, φ_β, ψ_β, and how large they and the control u can be, for all parameters.

What is not algebraic is replaced by less than is known of it, so that what is proved holds for the true functions too:

- a root √(1 + x²) is a variable w with w > 0, w² = 1 + x², which is the same thing;
- the bump is a variable ρ with 0 < ρ <= 1 before its cut-off and ρ = 0 from there on, which sympy derives first;
- the potential ψ is known by the mean value theorem, ψ(y) - ψ(x) = (y - x) φ(ξ) with x < ξ < y, as ψ' = φ.

What z3 then refutes has no real solution, for whatever values of the parameters.
"""

from __future__ import annotations

from collections.abc import Iterator

import sympy as sp
import z3

from flockana.symbolic.generic_pair import PSI
from flockana.symbolic.parameter_symbols import GAINS
from flockana.symbolic.potentials import derive_psi_alpha, derive_psi_beta
from flockana.symbolic.scalar_functions import taper
from flockana.symbolic.sums_over_pairs import P as MOMENTUM
from flockana.symbolic.sums_over_pairs import V as VELOCITY
from flockana.symbolic.sums_over_pairs import X as PLACE
from flockana.symbolic.sums_over_pairs import Z as DISTANCE
from flockana.symbolic.sums_over_pairs import hamiltonian, structural_hamiltonian, write_out
from proofs.proof import Proof, Step
from proofs.smt import Lemma, implication, lemma, real

A, B, C, EPS, D, R = z3.Reals("a b c epsilon d r")
GIVEN = (A > 0, A <= B, C >= 0, 4 * A * B * C**2 == (B - A) ** 2)


def root(w: z3.ArithRef, square: z3.ArithRef) -> tuple[z3.BoolRef, ...]:
    """w = √(square)."""
    return w > 0, w**2 == square


def sigmoid(f: z3.ArithRef, s: z3.ArithRef, w: z3.ArithRef) -> tuple[z3.BoolRef, ...]:
    """f = φ(s) = ½[(a+b) σ₁(s+c) + (a-b)], with w = √(1 + (s+c)²)."""
    return *root(w, 1 + (s + C) ** 2), 2 * f * w == (A + B) * (s + C) + (A - B) * w


def _bump() -> Iterator[Step]:
    z, h, t = sp.Symbol("z", positive=True), sp.Symbol("h", positive=True), sp.Symbol("t", positive=True)
    falling = taper(z, h=h)
    angle = sp.pi * (z - h) / (2 * (1 - h))
    yield Step(
        "the taper of ρ_h is a square, cos²(θ/2), at most 1; it is 1 at z = h and 0 at z = 1",
        sp.simplify(falling - sp.cos(angle) ** 2) == 0
        and sp.simplify(sp.cos(angle) ** 2 + sp.sin(angle) ** 2) == 1
        and [sp.simplify(falling.subs(z, end)) for end in (h, 1)] == [1, 0],
        r"\rho_h(z) = \tfrac12\Bigl(1 + \cos\frac{\pi(z-h)}{1-h}\Bigr) = \cos^2\frac{\pi(z-h)}{2(1-h)}",
    )
    inside = sp.Interval.open(0, 1)
    zeros = [sp.solveset(f, t, inside) for f in (sp.cos(sp.pi * t / 2), sp.sin(sp.pi * t))]
    slope = -sp.pi / (2 * (1 - h)) * sp.sin(sp.pi * (z - h) / (1 - h))
    yield Step(
        "between them it neither vanishes nor has slope 0, and it falls halfway: it is in (0, 1), and decreasing",
        zeros == [sp.S.EmptySet] * 2
        and sp.simplify(falling.diff(z) - slope) == 0
        and sp.simplify(slope.subs(z, (1 + h) / 2).subs(h, 1 / (1 + t))).is_negative is True,
        r"\rho_h'(z) = -\frac{\pi}{2(1-h)} \sin\frac{\pi(z-h)}{1-h} < 0, \qquad h < z < 1",
    )


def _lengths() -> Iterator[Step]:
    u, v = z3.Reals("u v")
    yield implication(
        "the σ-norm is increasing: 0 < d_α < r_α",
        z3.And((u - 1) / EPS > 0, (u - 1) / EPS < (v - 1) / EPS),
        *(EPS > 0, D > 0, R > D, *root(u, 1 + EPS * D**2), *root(v, 1 + EPS * R**2)),
        latex=r"0 < d_\alpha = (\sqrt{1+\epsilon d^2} - 1)/\epsilon < (\sqrt{1+\epsilon r^2} - 1)/\epsilon = r_\alpha",
    )
    yield gradients_grow().step


def gradients_grow() -> Lemma:
    """Of x < y, with their roots u and v."""
    u, v, x, y = z3.Reals("u v x y")
    return lemma(
        "so is ‖n_ij‖ = x/√(1 + εx²), and it stays below 1/√ε",
        z3.And(x / u < y / v, EPS * (y / v) ** 2 < 1),
        *(EPS > 0, x >= 0, *root(u, 1 + EPS * x**2), *root(v, 1 + EPS * y**2)),
        when=y > x,
        latex=r"\|n_{ij}\| = \frac{x}{\sqrt{1+\epsilon x^2}} < \frac{y}{\sqrt{1+\epsilon y^2}} < \frac1{\sqrt\epsilon}",
    )


def phi_lemmas() -> tuple[Lemma, ...]:
    """What is used of f = φ(s): its value at 0, its signs, its bounds."""
    s, f, w = z3.Reals("s f w")
    known = (*GIVEN, *sigmoid(f, s, w))
    definition = r"\varphi(s) = \tfrac12\Bigl[(a+b)\frac{s+c}{\sqrt{1+(s+c)^2}} + (a-b)\Bigr]"
    return (
        lemma("φ(0) = 0 with the given c", f == 0, *known, when=s == 0, latex=definition),
        lemma("φ(s) < 0 for s < 0", f < 0, *known, when=s < 0),
        lemma("φ(s) > 0 for s > 0", f > 0, *known, when=s > 0),
        lemma("-b < φ < a", z3.And(f > -B, f < A), *known, latex=r"-b < \varphi(s) < a"),
    )


def _phi() -> Iterator[Step]:
    s, t, f, g, w, v = z3.Reals("s t f g w v")
    zero, *others = phi_lemmas()
    yield zero.step
    yield implication(
        "φ is increasing",
        f < g,
        *(*GIVEN, *sigmoid(f, s, w), *sigmoid(g, t, v), s < t),
        latex=r"s < t \implies \varphi(s) < \varphi(t)",
    )
    for one in others:
        yield one.step


Z, D_ALPHA, R_ALPHA = z3.Reals("z d_alpha r_alpha")
SCALES = (D_ALPHA > 0, R_ALPHA > D_ALPHA)


def action(g: z3.ArithRef, z: z3.ArithRef, lemmas: tuple[Lemma, ...]) -> tuple[z3.BoolRef, ...]:
    """g = φ_α(z) = ρ φ(z - d_α), with all that has been shown of ρ and φ and no more."""
    shown = z3.Reals("s f")
    rho, f = z3.Reals(f"rho_{g} phi_{g}")
    bump = z3.If(z < R_ALPHA, z3.And(rho > 0, rho <= 1), rho == 0)
    signs = (one.then(dict(zip(shown, (z - D_ALPHA, f), strict=True))) for one in lemmas)
    return *SCALES, A > 0, A <= B, z >= 0, bump, *signs, g == rho * f


def _phi_alpha() -> Iterator[Step]:
    g, rho, f, least, most, x = z3.Reals("g rho f least most x")
    known = action(g, Z, phi_lemmas())
    yield implication("φ_α < 0 below d_α", g < 0, *known, Z < D_ALPHA, latex=r"\phi_\alpha(z) < 0, \quad z < d_\alpha")
    yield implication("φ_α(d_α) = 0", g == 0, *known, Z == D_ALPHA)
    between = (Z > D_ALPHA, Z < R_ALPHA)
    latex = r"\phi_\alpha(z) > 0, \quad d_\alpha < z < r_\alpha"
    yield implication("φ_α > 0 on (d_α, r_α)", g > 0, *known, *between, latex=latex)
    yield implication(
        "φ_α = 0 from r_α on", g == 0, *known, Z >= R_ALPHA, latex=r"\phi_\alpha(z) = 0, \ z \ge r_\alpha"
    )
    in_range = z3.Implies(rho > 0, f <= most)  # z < r_α where ρ > 0
    monotone = (rho >= 0, rho <= 1, least <= f, in_range, least < 0, most > 0)
    yield implication(
        "φ_α is least at 0, where ρ_h = 1, and at most φ(r_α - d_α): φ(-d_α) = φ_α(0) <= φ_α <= φ(r_α - d_α)",
        z3.And(least <= rho * f, rho * f <= most),
        *monotone,
        latex=r"-b < \varphi(-d_\alpha) = \phi_\alpha(0) \le \phi_\alpha(z) \le \varphi(r_\alpha - d_\alpha) < a",
    )
    size, w, u, v = z3.Reals("size w u v")
    grow, y = gradients_grow(), z3.Real("y")
    at_d, at_r = B * D / u, A * R / v
    shown = (*root(u, 1 + EPS * D**2), *root(v, 1 + EPS * R**2), EPS > 0, D > 0, R > D)
    near = (x >= 0, x < D, g > -B, g < 0)  # x < d if and only if z < d_α, as the σ-norm is increasing
    far = (x >= D, x < R, g >= 0, g < A)
    for name, place, bound in (("d", near, at_d), ("r", far, at_r)):
        yield implication(
            f"the force of a pair {'below d' if name == 'd' else 'between d and r'} is smaller than "
            f"{'b d/√(1 + εd²)' if name == 'd' else 'a r/√(1 + εr²)'}",
            size < bound,
            *(*shown, A > 0, A <= B, *place, *root(w, 1 + EPS * x**2)),
            *(grow.then({u: w, y: D if name == "d" else R, v: u if name == "d" else v}), x / w >= 0),
            size == z3.If(g < 0, -g, g) * x / w,
        )


def potential_signs() -> Iterator[Step]:
    """ψ_α >= 0 and what goes with it: other proofs rest on this."""
    yield Step(
        "ψ_α is continuously differentiable, ψ_α' = φ_α, ψ_α(d_α) = 0: all pieces, both places of d_α",
        derive_psi_alpha().holds,
        r"\psi_\alpha(z) = \int_{d_\alpha}^z \phi_\alpha(s)\,ds",
        "sympy differentiates every piece and compares the pieces where they meet",
    )
    x, y, xi, g, psi_x, psi_y, psi_r = z3.Reals("x y xi g psi_x psi_y psi_r")
    known = (*action(g, xi, phi_lemmas()), x >= 0, x < xi, xi < y, psi_y - psi_x == (y - x) * g)
    yield implication("ψ_α is decreasing on [0, d_α]", psi_x > psi_y, *known, y <= D_ALPHA)
    yield implication("ψ_α is increasing on [d_α, r_α]", psi_x < psi_y, *known, x >= D_ALPHA, y <= R_ALPHA)
    yield implication("ψ_α is nondecreasing from d_α on", psi_x <= psi_y, *known, x >= D_ALPHA)
    yield implication("ψ_α is constant from r_α on", psi_x == psi_y, *known, x >= R_ALPHA)
    yield implication("ψ_α > 0 below d_α", psi_x > 0, *known, y == D_ALPHA, psi_y == 0)
    yield implication("ψ_α > 0 on (d_α, r_α]", psi_y > 0, *known, x == D_ALPHA, psi_x == 0, y <= R_ALPHA)
    yield implication(
        "ψ_α = ψ_α(r_α) > 0 beyond",
        psi_y > 0,
        *known,
        *(x == R_ALPHA, psi_x == psi_r, psi_r > 0),
        latex=r"\psi_\alpha(z) \ge 0, \qquad \psi_\alpha(z) = 0 \iff z = d_\alpha",
    )
    yield potential_lemma().step


PAIR = z3.Real("psi")


def potential_lemma() -> Lemma:
    """ψ_α >= 0 at every z, what energies rest on: by the mean value theorem between z and d_α."""
    g, xi = z3.Reals("g xi")
    between = z3.Or(Z == D_ALPHA, z3.And(xi > Z, xi < D_ALPHA), z3.And(xi > D_ALPHA, xi < Z))
    return lemma(
        "ψ_α(z) >= 0 for every z >= 0",
        PAIR >= 0,
        *(*action(g, xi, phi_lemmas()), Z >= 0, between, (Z - D_ALPHA) * g == PAIR),
        latex=r"\psi_\alpha(z) = (z - d_\alpha)\,\phi_\alpha(\xi)",
    )


def _control() -> Iterator[Step]:
    x, y, k, s = z3.Reals("X Y k S")
    for m in (1, 2, 3):
        p, q = (sp.Matrix(sp.symbols(f"{name}_1:{m + 1}", real=True)) for name in "pq")
        minors = sum((p[i] * q[j] - p[j] * q[i]) ** 2 for i in range(m) for j in range(i))
        yield Step(
            f"m = {m}: ⟨p, q⟩² <= ‖p‖²‖q‖² (Lagrange) and ‖q - p‖² <= 2‖p‖² + 2‖q‖²",
            sp.expand(p.dot(p) * q.dot(q) - p.dot(q) ** 2 - minors) == 0
            and sp.expand(2 * p.dot(p) + 2 * q.dot(q) - (q - p).dot(q - p) - (p + q).dot(p + q)) == 0,
        )
    sizes = (x >= 0, y >= 0, k**2 <= x**2 * y**2, s >= 0, s**2 == x**2 + 2 * k + y**2)
    yield implication(
        "sizes of forces add up at most: ‖f + g‖ <= ‖f‖ + ‖g‖, and so on by induction", s <= x + y, *sizes
    )
    n, bound, c1, c2, energy, gap, u, p_i, p_j = z3.Reals("N_i F c1 c2 H gap u p_i p_j")
    product, total = z3.Reals("product sum")
    apart = lemma(
        "‖q - p‖² <= 2‖p‖² + 2‖q‖², as ‖p + q‖² >= 0",
        gap**2 <= 2 * p_i + 2 * p_j,
        *(gap**2 == p_i + p_j - 2 * product, total**2 == p_i + p_j + 2 * product),
    )
    yield apart.step
    gain, rest, positive = z3.Real("c1_alpha"), z3.Real("rest"), potential_lemma()
    shown = {GAINS.c1_alpha: gain, PSI(DISTANCE[1, 2]): PAIR}
    written = real(write_out(hamiltonian(1), 2), {MOMENTUM[1, 1] ** 2: p_i, MOMENTUM[2, 1] ** 2: p_j, **shown})
    two = (energy == written + rest, gain >= 0, positive.then(), rest >= 0)  # the rest: other agents, other pairs
    gains = (n >= 0, bound >= 0, c1 >= 0, c2 >= 0, energy >= 0)
    yield implication(
        "Algorithm 1: ‖u_i‖ <= |N_i| (c1α F + 2 c2α √H(0)), as ½‖p_i‖² + ½‖p_j‖² <= H(t) <= H(0)",
        u <= n * (c1 * bound + 2 * c2 * s),
        *(*gains, gap >= 0, apart.then(), p_i >= 0, p_j >= 0, *two),
        *(s >= 0, s**2 == energy, u <= n * (c1 * bound + c2 * gap)),
        latex=r"\|u_i\| \le |N_i|\,\bigl(c_1^\alpha F + 2 c_2^\alpha \sqrt{H(0)}\bigr), \quad F = \max\Bigl("
        r"\frac{b\,d}{\sqrt{1+\epsilon d^2}}, \frac{a\,r}{\sqrt{1+\epsilon r^2}}\Bigr) < \frac{b}{\sqrt\epsilon}",
    )
    g1, g2, own = z3.Reals("c1_gamma c2_gamma own")
    structural = write_out(structural_hamiltonian(1, lambda_=GAINS.c1_gamma), 2)
    frame = {PLACE[1, 1] ** 2: x**2, PLACE[2, 1] ** 2: 0, VELOCITY[1, 1] ** 2: y**2, VELOCITY[2, 1] ** 2: 0}
    moving = energy == real(structural, {**frame, **shown, GAINS.c1_gamma: g1}) + rest
    yield implication(
        "Algorithm 2, in the moving frame: its own term adds at most √(2 H_λ(0) (c1γ + c2γ²))",
        own**2 <= 2 * energy * (g1 + g2**2),
        *(g1 > 0, g2 >= 0, energy >= 0, x >= 0, y >= 0, moving, gain >= 0, positive.then(), rest >= 0),
        *(own >= 0, own <= g1 * x + g2 * y),
        latex=r"\|c_1^\gamma x_i + c_2^\gamma v_i\| \le \sqrt{2 H_\lambda(0)\,(c_1^\gamma + (c_2^\gamma)^2)}",
    )


def _beta() -> Iterator[Step]:
    z, d, v, w, rho, g = z3.Reals("z d_beta v w rho g")
    bump = z3.If(z < d, z3.And(rho > 0, rho <= 1), rho == 0)
    known = (d > 0, z >= 0, *root(w, 1 + (z - d) ** 2), bump, g * w == rho * ((z - d) - w))
    definition = r"\phi_\beta(z) = \rho_h(z/d_\beta)\,(\sigma_1(z - d_\beta) - 1)"
    yield implication("φ_β < 0 below d_β", g < 0, *known, z < d, latex=definition)
    yield implication("φ_β = 0 from d_β on", g == 0, *known, z >= d)
    yield implication(
        "φ_β is least at 0: -2 < -1 - σ₁(d_β) = φ_β(0) <= φ_β",
        z3.And(-1 - d / v > -2, -1 - d / v <= g),
        *known,
        *root(v, 1 + d**2),
        latex=r"-2 < \phi_\beta(0) = -1 - \sigma_1(d_\beta) \le \phi_\beta(z) \le 0",
    )
    yield Step("ψ_β' = φ_β and ψ_β(d_β) = 0", derive_psi_beta().holds, r"\psi_\beta(z) = \int_{d_\beta}^z \phi_\beta")
    x, y, psi_x, psi_y = z3.Reals("x y psi_x psi_y")
    mean = (x >= 0, x < z, z < y, psi_y - psi_x == (y - x) * g)
    yield implication("ψ_β is decreasing on [0, d_β]", psi_x > psi_y, *known, *mean, y <= d)
    yield implication("ψ_β > 0 below d_β", psi_x > 0, *known, *mean, y == d, psi_y == 0)
    yield implication("ψ_β = 0 from d_β on", psi_y == 0, *known, *mean, x == d, psi_x == 0)


def _steps() -> Iterator[Step]:
    for part in (_bump, _lengths, _phi, _phi_alpha, potential_signs, _control, _beta):
        yield from part()


PROOF = Proof(
    id="signs-of-phi",
    title="Signs and bounds of the pair functions",
    statement=(
        "φ(0) = 0; φ_α < 0 below d_α, > 0 on (d_α, r_α), 0 beyond, -b < φ_α(0) <= φ_α < a; ψ_α >= 0, zero at d_α only, "
        "decreasing before, increasing up to r_α, constant beyond. φ_β < 0 and ψ_β > 0 below d_β, 0 beyond, -2 < φ_β. "
        "A pair's force is below b d/√(1+εd²) or a r/√(1+εr²), and with the energy this bounds u."
    ),
    hypotheses="0 < a <= b, 0 < h < 1, 0 < d < r, ε > 0",
    rigour="smt",
    steps=_steps,
    size=39,
)
