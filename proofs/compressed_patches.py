"""Algorithm 2: the hexagonal patches of 7 and 19 agents that λJ compresses, enclosed, and stable but for the rotation.

Seen from the γ-agent, equilibria are the zeros of ∇U, U = c1α V + ½c1γ Σ‖q_i‖², which is U_λ and the centre's
½n c1γ‖q_c‖². They come in circles, one patch rotated. So a zero is sought of (∇U + μg, ⟨g, q - q̄⟩), with g the rotation
of the computed q̄: as ∇U is orthogonal to the rotation of q, which is not orthogonal to g near q̄, μ = 0 there.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np
import sympy as sp
from flint import arb, arb_mat, ctx

from flockana.certified.balls import AlphaParameters, ball, exact, hull, square
from flockana.certified.decimal_rounding import at_least, small
from flockana.certified.krawczyk import enclose_zero, least_eigenvalue
from flockana.certified.scalar_functions_in_balls import phi_alpha, phi_alpha_slope, sigma_of_square
from flockana.environment.targets import StaticTarget
from flockana.equilibria.solve import find_equilibrium
from flockana.lattice import hexagonal_patch
from flockana.laws.olfati_saber import Algorithm2
from proofs.proof import Proof, Step
from proofs.unstressed_patches import RINGS, SIZES, THE_SIZES, modes_decay, off_the_edges, pair_hessian

DIGITS = 30
RADIUS = "1e-6"  # of the box in which there is one equilibrium
NARROW = "1e-10"  # of the box that encloses it better
LIFT = 100  # times c1α: what rigid motions are given of curvature, more than any other motion has least
LAW = Algorithm2(target=StaticTarget((0.0, 0.0)))  # the paper's parameters, and the project's default gains


@dataclass(frozen=True)
class Flock:
    """U of n agents in the plane, with its derivatives on boxes; q is listed x₁, y₁, x₂, y₂, …"""

    par: AlphaParameters
    c1_alpha: arb
    c1_gamma: arb
    n: int

    def pairs(self, q: Sequence[arb]) -> Iterator[tuple[int, int, tuple[arb, arb], arb]]:
        """(i, j, q_j - q_i, squared distance) of all pairs that are not certainly out of range."""
        for i, j in combinations(range(self.n), 2):
            x = q[2 * j] - q[2 * i], q[2 * j + 1] - q[2 * i + 1]
            s = square(x[0]) + square(x[1])
            if not s >= ball(self.par.r) ** 2:
                yield i, j, x, s

    def gradient(self, q: Sequence[arb]) -> list[arb]:
        """c1α φ_α/√(1 + εs) (q_j - q_i) of each pair, and c1γ q_i."""
        total = [self.c1_gamma * x for x in q]
        for i, j, x, s in self.pairs(q):
            pull = self.pull(s)
            for axis in (0, 1):
                total[2 * j + axis] += pull * x[axis]
                total[2 * i + axis] -= pull * x[axis]
        return total

    def hessian(self, q: Sequence[arb]) -> arb_mat:
        """The pairs' f 1 + g xxᵀ, and c1γ; f the pull, g its derivative by s, doubled."""
        total = [[self.c1_gamma * int(i == j) for j in range(2 * self.n)] for i in range(2 * self.n)]
        for i, j, x, s in self.pairs(q):
            pull, change = self.pull(s), self._change(s)
            for a in (0, 1):
                for b in (0, 1):
                    block = change * (square(x[a]) if a == b else x[a] * x[b]) + pull * int(a == b)
                    total[2 * i + a][2 * i + b] += block
                    total[2 * j + a][2 * j + b] += block
                    total[2 * i + a][2 * j + b] -= block
                    total[2 * j + a][2 * i + b] -= block
        return arb_mat(total)

    def smooth_at(self, q: Sequence[arb]) -> bool:
        """Whether every pair is certainly in range, where φ_α is analytic, or out of range."""
        return all(off_the_edges(sigma_of_square(s, self.par.eps), self.par) for *_, s in self.pairs(q))

    def lengths(self, q: Sequence[arb]) -> list[arb]:
        """Of the links."""
        return [s.sqrt() for *_, s in self.pairs(q)]

    def pull(self, s: arb) -> arb:
        """Enclosed force of a link over its vector, by the square of its length."""
        return self.c1_alpha * phi_alpha(sigma_of_square(s, self.par.eps), self.par) / self._root(s)

    def _change(self, s: arb) -> arb:
        z, root, eps = sigma_of_square(s, self.par.eps), self._root(s), ball(self.par.eps)
        slope, action = phi_alpha_slope(z, self.par), phi_alpha(z, self.par)
        return self.c1_alpha * (slope / root - eps * action / root**2) / root

    def _root(self, s: arb) -> arb:
        return (1 + ball(self.par.eps) * s).sqrt()


def flock(n: int) -> Flock:
    """Of the law here, gains as they print."""
    gains = LAW.gains
    return Flock(AlphaParameters.of(LAW.alpha), ball(exact(gains.c1_alpha)), ball(exact(gains.c1_gamma)), n)


def rotation(q: Sequence[arb]) -> list[arb]:
    """(-y, x) of each agent."""
    return [x for i in range(0, len(q), 2) for x in (-q[i + 1], q[i])]


def computed(rings: int) -> list[float]:
    """The equilibrium that flockana finds from the patch at distances d."""
    found = find_equilibrium(LAW, hexagonal_patch(rings, LAW.alpha.d))
    return [float(x) for x in np.asarray(found.q).ravel()]


def enclose(u: Flock, q: Sequence[float], radius: arb) -> list[arb] | None:
    """Balls that hold the one equilibrium within `radius` of the computed one, in each coordinate; None if uncertain.

    The one not rotated against it; the last unknown, μ, is left out.
    """
    centre = [arb(x) for x in q]
    g = rotation(centre)

    def equations(x: Sequence[arb]) -> list[arb]:
        *place, mu = x
        force = u.gradient(place)
        held = sum((t * (a - b) for t, a, b in zip(g, place, centre, strict=True)), arb(0))
        return [f + mu * t for f, t in zip(force, g, strict=True)] + [held]

    def slope(x: Sequence[arb]) -> arb_mat:
        rows = u.hessian(x[:-1]).tolist()
        return arb_mat([[*row, t] for row, t in zip(rows, g, strict=True)] + [[*g, arb(0)]])

    found = enclose_zero(equations, slope, [*centre, arb(0)], radius)
    return None if found is None else found[:-1]


def curvature(u: Flock, box: Sequence[arb], *, translations: bool = False) -> arb | None:
    """A number > 0 below all eigenvalues of ∇²U but the rotation's, at every point of the box; None if uncertain.

    What is bounded is ∇²U plus a multiple of the projection on the rotation, as one direction lifts one eigenvalue at
    most. With `translations` lifted too, all but three are bounded.
    """
    lifted = [rotation([x.mid() for x in box])]
    if translations:
        lifted += [[arb(int(k % 2 == axis)) for k in range(len(box))] for axis in (0, 1)]
    total = u.hessian(box)
    for g in lifted:
        column = arb_mat(len(g), 1, g)
        total += column * column.transpose() * (LIFT * u.c1_alpha / sum(map(square, g), arb(0)))
    return least_eigenvalue(total)


def _reduction() -> Iterator[Step]:
    phi, slope, s, eps, x, y = sp.symbols("phi phi' s epsilon x y", positive=True)
    root = sp.sqrt(1 + eps * s)
    once, twice = phi * sp.sqrt(s) / root, slope * s / root**2 + phi / root**3  # f', f'' at the length √s
    yield Step(
        "so that a pair's Hessian is f 1 + g xxᵀ, f = φ_α/√(1 + εs), g = φ_α'/(1 + εs) - εφ_α/√(1 + εs)³, s = ‖x‖²",
        sp.simplify(once / sp.sqrt(s) - phi / root) == 0
        and sp.simplify((twice - once / sp.sqrt(s)) / s - slope / root**2 + eps * phi / root**3) == 0,
    )
    pair = sp.Matrix([x, y])
    yield Step(
        "∇U has no component along the rotation of q: each pair's force is along x, and ⟨x, Jx⟩ = 0, ⟨q, Jq⟩ = 0",
        pair.dot(sp.Matrix([-y, x])) == 0,
        r"\langle \nabla U(q) + \mu g, Jq\rangle = \mu\,\langle g, Jq\rangle, \qquad g = J\bar q",
    )


def _radius(box: Sequence[arb], q: Sequence[float]) -> arb:
    """How far the box reaches from the point."""
    return arb(max(abs(x - arb(y)).upper() for x, y in zip(box, q, strict=True)))


def _patch(rings: int) -> Iterator[Step]:
    q = computed(rings)
    n = len(q) // 2
    u, widest, narrow = flock(n), arb(RADIUS), arb(NARROW)
    box = [arb(x) + arb(0, widest) for x in q]
    links = u.lengths(box)
    yield Step(
        f"n = {n}: within {RADIUS} of the computed patch, in each coordinate, the same {len(links)} pairs are links, "
        "where φ_α is analytic, the others are out of range, and the rotation is not orthogonal to the computed one's",
        u.smooth_at(box)
        and sum((a * b for a, b in zip(rotation([arb(x) for x in q]), rotation(box), strict=True))) > 0,
        evidence=f"links {hull(*links).str(8)}",
    )
    found = enclose(u, q, widest) and enclose(u, q, narrow)
    yield Step(
        f"n = {n}: exactly one equilibrium is within {RADIUS} of the computed patch, not rotated against it (Krawczyk)",
        True if found else None,
        r"K = \bar x - Y F(\bar x) + (1 - Y F'(B))(B - \bar x) \subset \operatorname{int} B",
        "not certain" if found is None else f"it is within {small(_radius(found, q))} of it",
        {f"n of {rings} rings": str(n)},
    )
    if found is None:
        return
    lengths = u.lengths(found)
    yield Step(
        f"n = {n}: every link is shorter than d: no α-lattice (erratum E3)",
        all(bool(length < ball(u.par.d)) for length in lengths),
        evidence=f"from {min(lengths, key=float).str(12)} to {max(lengths, key=float).str(12)}",
    )
    least, structural = (curvature(u, found, translations=lifted) for lifted in (False, True))
    yield Step(
        f"n = {n}: there ∇²U has a kernel of one dimension, the rotation, and is positive definite off it",
        True if least and structural else None,
        evidence="not certain"
        if least is None or structural is None
        else f"the other eigenvalues are at least {at_least(least)}; those of the structure, off the "
        "translations, which "
        f"have c1γ = {u.c1_gamma.str(3)}, at least {at_least(structural)}",
    )


def _steps() -> Iterator[Step]:
    yield from pair_hessian()
    yield from _reduction()
    with ctx.workdps(DIGITS):
        for rings in RINGS:
            yield from _patch(rings)
    yield from modes_decay()


PROOF = Proof(
    id="compressed-patches",
    title="Algorithm 2: compressed hexagonal patches are stable equilibria",
    statement=(
        f"Within {RADIUS} of each of the patches of n = {THE_SIZES} agents that flockana computes for Algorithm 2 "
        "lies exactly "
        "one true equilibrium not rotated against it; it is compressed, all links shorter than d, and ∇²U_λ there is "
        "positive definite but for the rotation. Modulo the rotation it is locally asymptotically stable."
    ),
    hypotheses=(
        f"m = 2; positions relative to the γ-agent, which moves uniformly, dq_r/dt = p_r; "
        f"{AlphaParameters.of(LAW.alpha)}, c1α = {LAW.gains.c1_alpha:g}, c1γ = {LAW.gains.c1_gamma}, and any c2α "
        ">= 0, c2γ > 0. The last conclusion is cited: where all "
        "eigenvalues but those along a manifold of equilibria, here the rotated patches, have negative real parts, "
        "nearby solutions converge to one of them (centre manifold theorem; Carr 1981)"
    ),
    rigour="interval",
    steps=_steps,
    size=16,
    values=SIZES,
    theorems=("E3",),
)
