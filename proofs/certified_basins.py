"""The algebra behind certified basins: a pair's bound along its displacement, shells, and the strict Lyapunov function.

What `flockana.certified` computes for each equilibrium is checked there, by balls; here is why that suffices.
"""

from __future__ import annotations

from collections.abc import Iterator

import sympy as sp

from proofs.proof import Proof, Step

F2, T, L, L0, B, ALPHA, BETA = sp.symbols("F'' T l l0 b alpha beta", real=True)
LAM, SUR, MU, M = sp.symbols("lambda s mu M", real=True)
EPS, THETA, KAPPA, TAU, RATE = sp.symbols("epsilon theta kappa tau alpha_F", positive=True)
V2, W2 = sp.symbols("V W", nonnegative=True)  # ‖v‖², ‖w‖²


def pair_coefficients() -> tuple[sp.Expr, sp.Expr, sp.Expr]:
    """d0, d1 and d2 of a pair's bound, as `flockana.certified.curvature_shells` has them."""
    x = L - L0
    return (
        (F2 - ALPHA) * x**2,
        2 * x * (F2 * L0 + ALPHA * L) + 2 * (T * L0**2 - BETA * L**2),
        (F2 - T) * L0**2 - (ALPHA - BETA) * L**2,
    )


def decay_coefficients() -> tuple[sp.Expr, sp.Expr]:
    """What ‖v‖² and ‖w‖² keep of −αF − dF/dt: not negative where α is at most what `rate_of` says."""
    mixed = THETA * SUR + (1 - THETA) * LAM
    speeds = (1 - EPS / (2 * KAPPA)) * MU - EPS - RATE * (sp.Rational(1, 2) + EPS / (2 * TAU))
    places = EPS * (THETA * LAM / 2 + mixed - KAPPA * M / 2) - RATE * (LAM / 2 + EPS * TAU / 2)
    return speeds, places


def _pair() -> Iterator[Step]:
    cosine = 1 - B
    sine2 = 1 - cosine**2  # of the angle by which the pair, (l cos, l sin), has turned
    e1, e2_squared = L * cosine - L0, L**2 * sine2
    inward = (L * cosine * e1 + e2_squared) / L  # component of e along the turned pair
    size2 = e1**2 + e2_squared
    form = F2 * inward**2 + T * (size2 - inward**2)
    d0, d1, d2 = pair_coefficients()
    yield Step(
        "a pair's form along its displacement, less the bound, is a square in b = 1 - cos of its turn",
        sp.simplify(form - ALPHA * e1**2 - BETA * e2_squared - (d0 + d1 * B + d2 * B**2)) == 0,
        r"F''\langle u', e\rangle^2 + T(|e|^2 - \langle u', e\rangle^2) - \alpha\langle u, e\rangle^2"
        r" - \beta(|e|^2 - \langle u, e\rangle^2) = d_0 + d_1 b + d_2 b^2",
    )
    yield Step(
        "and |e|² = (ℓ - ℓ0)² + 2ℓℓ0 b, so that |e| <= η bounds b",
        sp.expand(size2 - (L - L0) ** 2 - 2 * L * L0 * B) == 0,
    )
    a, b = sp.symbols("a b", real=True)
    yield Step(
        "|w_j - w_i|² <= 2(|w_i|² + |w_j|²): a pair is displaced by at most √2 times all coordinates",
        sp.expand(2 * (a**2 + b**2) - (a - b) ** 2 - (a + b) ** 2) == 0,
    )


def _shells() -> Iterator[Step]:
    t, start, before, sigma, end = sp.symbols("t t_0 c sigma t_1", positive=True)
    k = sp.Symbol("k", real=True)
    slope = (before + k * (t - start)) / t
    moment = (before + k * (t**2 - start**2) / 2) / t**2
    yield Step(
        "within a shell the derivatives of G'/t and of (tG' - G)/t² do not change their signs: least at its ends",
        not (t**2 * slope.diff(t)).simplify().has(t) and not sp.simplify(t**3 * moment.diff(t)).has(t),
    )
    g = sp.Function("g")
    second = g(sigma).diff(sigma, 2)
    parts = (end - sigma) * g(sigma).diff(sigma) + g(sigma)  # an antiderivative of (t - σ) g''
    yield Step(
        "U - U* = ∫(t - σ)g'' dσ along the segment, g' = 0 at rest; tg' - g = ∫σg'' dσ: bounds of g'' pass to both",
        sp.simplify(parts.diff(sigma) - (end - sigma) * second) == 0
        and sp.simplify((sigma * g(sigma).diff(sigma) - g(sigma)).diff(sigma) - sigma * second) == 0,
        r"g(t) - g(0) = \int_0^t (t-\sigma)\,g''(\sigma)\,d\sigma",
    )


def _lyapunov() -> Iterator[Step]:
    x2, rest2, aligned = sp.symbols("X R c", real=True)
    yield Step(
        "half the squared distance is ½‖x‖² + ½‖x*‖² less a maximum of linear functions of x: its Hessian is at most 1",
        sp.expand((x2 - 2 * aligned + rest2) / 2 - (x2 / 2 + rest2 / 2 - aligned)) == 0,
        r"P(x) = \tfrac12\|x\|^2 + \tfrac12\|x^*\|^2 - \max_R \langle x, R x^*\rangle,\quad \nabla P = w",
        "that a maximum of linear functions is convex, and the gradient of a smooth one that of the function that "
        "attains it, is no machine's",
    )
    w, v, root = sp.symbols("w v r", real=True)  # in the scalar product of D; κ = r²
    square = (root * w + v / root) ** 2
    yield Step(
        "⟨w, Dv⟩ >= -½κ⟨w, Dw⟩ - ⟨v, Dv⟩/2κ, a square in the product of D, and alike ⟨w, v⟩ <= ½τ‖w‖² + ‖v‖²/2τ",
        sp.expand(square - (root**2 * w**2 + v**2 / root**2 + 2 * w * v)) == 0,
    )
    drag, drift, steep, rise, cross, level = sp.symbols("a_1:7", nonnegative=True)  # what the bounds leave
    vdv = MU * V2 + drag
    wdv = -(KAPPA * M * W2 / 2 + vdv / (2 * KAPPA)) + drift
    energy = LAM * W2 / 2 + level
    slope = THETA * (energy + SUR * W2 + rise) + (1 - THETA) * (LAM * W2 + steep)
    product = (TAU * W2 + V2 / TAU) / 2 - cross
    change = -vdv + EPS * (V2 - slope - wdv)
    lyapunov = energy + V2 / 2 + EPS * product
    speeds, places = decay_coefficients()
    kept = speeds * V2 + places * W2 + (1 - EPS / (2 * KAPPA)) * drag + EPS * drift
    kept += EPS * THETA * rise + EPS * (1 - THETA) * steep + (EPS * THETA - RATE) * level + RATE * EPS * cross
    yield Step(
        "-αF - dF/dt is a sum of what the bounds leave, none of it negative under the conditions on α",
        sp.expand(-change - RATE * lyapunov - kept) == 0,
        r"-\alpha F - \dot F = c_v\|v\|^2 + c_w\|w\|^2 + (\varepsilon\theta - \alpha)a_6 + \dots \ge 0",
    )
    solved = [sp.solve(one, RATE)[0] for one in (speeds, places)]
    mixed = THETA * SUR + (1 - THETA) * LAM
    stated = (
        ((1 - EPS / (2 * KAPPA)) * MU - EPS) / (sp.Rational(1, 2) + EPS / (2 * TAU)),
        EPS * (THETA * LAM / 2 + mixed - KAPPA * M / 2) / (LAM / 2 + EPS * TAU / 2),
    )
    yield Step(
        "the conditions solved for α are those that are computed",
        all(sp.simplify(a - b) == 0 for a, b in zip(solved, stated, strict=True)),
    )
    root = sp.Symbol("r", positive=True)
    yield Step(
        "(1 - e)E <= F <= (1 + e)E, e = ε/√λ: ½λ‖w‖² + ½‖v‖² >= √λ‖w‖‖v‖",
        sp.expand((root**2 * w**2 + v**2) / 2 - root * w * v - (root * w - v) ** 2 / 2) == 0,
    )


def _steps() -> Iterator[Step]:
    yield from _pair()
    yield from _shells()
    yield from _lyapunov()


PROOF = Proof(
    id="certified-basins",
    title="Why the numbers of a certified basin make it one",
    statement=(
        "If along every displacement w orthogonal to the orbit's tangent the curvature of U is at least k_i in the "
        "i-th shell up to ρ, G'' = k_i, G'(t) >= λt > 0 and D >= μ > 0 there, then every start nearer than ρ to the "
        "orbit with an energy less than G(ρ) above it stays nearer than ρ and converges to a point of the orbit with "
        "matched velocities, at the rate of F = H - U* + ε⟨w, v⟩."
    ),
    hypotheses=(
        "Algorithm 1, or 2 with one c1γ and one c2γ, in the frame of the centre of mass; the nearest point of the "
        "orbit unique and not degenerate up to ρ. Prose: U does not change under rotations; H never rises, so a start "
        "that left would have to pass U* + G(ρ); what falls exponentially has an integrable speed, and converges"
    ),
    rigour="symbolic",
    steps=_steps,
    size=10,
)
