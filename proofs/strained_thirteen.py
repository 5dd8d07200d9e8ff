"""Erratum E3: thirteen distinct agents in a strict minimum of V that is no α-lattice; Algorithm 1, enclosed.

Equilibria of Algorithm 1 come in families, one net translated and rotated. So a zero is sought of (∇V + Σ μ_k g_k,
⟨g_k, q - q̄⟩), the g_k being the rigid motions of the computed q̄: ∇V is orthogonal to those of q, which are not
orthogonal to them near q̄, and so all μ_k are 0 there.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from flint import arb, arb_mat, ctx

from flockana.certified.balls import AlphaParameters, ball, square
from flockana.certified.decimal_rounding import at_least, at_most, small
from flockana.certified.krawczyk import enclose_zero, least_eigenvalue
from flockana.equilibria.equilibrium_files import smallest_strained
from proofs.compressed_patches import LIFT, Flock, rotation
from proofs.proof import Proof, Step
from proofs.unstressed_patches import laplacian_rank, modes_decay, pair_hessian

DIGITS = 30
RADIUS = "1e-7"  # of the box in which there is one equilibrium
STATED = {"n": "13", "least": "1.3"}


def rigid_motions(q: Sequence[arb]) -> list[list[arb]]:
    """The rotation about the origin and two translations, of agents in the plane."""
    return [rotation(q), *([arb(int(k % 2 == axis)) for k in range(len(q))] for axis in (0, 1))]


def flock() -> tuple[Flock, list[float]]:
    """V of the smallest known one in units of c1α, and its computed positions."""
    known = smallest_strained()
    q = [float(x) for x in known.q.ravel()]
    return Flock(AlphaParameters.of(known.law.alpha), arb(1), arb(0), len(known.q)), q


def transversal(u: Flock, q: Sequence[float], radius: arb) -> bool:
    """Whether rigid motions of every q in the box are certainly not orthogonal to those of its centre."""
    centre = [arb(x) for x in q]
    products = [
        [sum((a * b for a, b in zip(one, other, strict=True)), arb(0)) for other in rigid_motions(centre)]
        for one in rigid_motions([x + arb(0, radius) for x in centre])
    ]
    return bool(arb_mat(products).det() != 0)


def enclose(u: Flock, q: Sequence[float], radius: arb) -> list[arb] | None:
    """Balls that hold the one equilibrium in the box that is not moved rigidly against the computed one, or None."""
    centre = [arb(x) for x in q]
    motions, size = rigid_motions(centre), len(q)

    def equations(x: Sequence[arb]) -> list[arb]:
        place, held = x[:size], x[size:]
        force = u.gradient(place)
        for mu, motion in zip(held, motions, strict=True):
            force = [f + mu * t for f, t in zip(force, motion, strict=True)]
        gaps = [a - b for a, b in zip(place, centre, strict=True)]
        return force + [sum((t * g for t, g in zip(motion, gaps, strict=True)), arb(0)) for motion in motions]

    def slope(x: Sequence[arb]) -> arb_mat:
        rows = [[*row, *(motion[k] for motion in motions)] for k, row in enumerate(u.hessian(x[:size]).tolist())]
        return arb_mat(rows + [[*motion, *[arb(0)] * len(motions)] for motion in motions])

    found = enclose_zero(equations, slope, [*centre, *[arb(0)] * len(motions)], radius)
    return None if found is None else found[:size]


def curvature(u: Flock, box: Sequence[arb]) -> arb | None:
    """A number > 0 below all eigenvalues of ∇²V but those of the rigid motions, on all of the box; None if uncertain.

    What is bounded is ∇²V plus multiples of projections on three directions, which lift three eigenvalues at most.
    """
    total = u.hessian(box)
    for motion in rigid_motions([x.mid() for x in box]):
        column = arb_mat(len(motion), 1, motion)
        total += column * column.transpose() * (LIFT / sum(map(square, motion), arb(0)))
    return least_eigenvalue(total)


def _strained() -> Iterator[Step]:
    u, q = flock()
    radius = arb(RADIUS)
    box = [arb(x) + arb(0, radius) for x in q]
    near = list(u.pairs(box))
    yield Step(
        f"within {RADIUS} of the computed places the same {len(near)} pairs are links, where φ_α is analytic, the "
        "others are out of range, and no rigid motion is orthogonal to all of the computed ones",
        u.smooth_at(box) and transversal(u, q, radius),
        found={"n": str(u.n)},
    )
    found = enclose(u, q, radius)
    yield Step(
        f"exactly one equilibrium is within {RADIUS} of them, not moved rigidly against them (Krawczyk)",
        True if found else None,
        r"K = \bar x - Y F(\bar x) + (1 - Y F'(B))(B - \bar x) \subset \operatorname{int} B",
    )
    if found is None:
        return
    reach = max(abs(x - arb(y)).upper() for x, y in zip(found, q, strict=True))
    lengths, d = u.lengths(found), ball(u.par.d)
    shortest, longest = min(one.lower() for one in lengths), max(one.upper() for one in lengths)
    off = [abs(length - d) / d for length in lengths]
    yield Step(
        "all agents are distinct, and some link is not d long: no α-lattice",
        all(bool(length > 0) for length in lengths) and any(bool(share > 0) for share in off),
        evidence=f"links from {at_least(shortest)} to {at_most(longest)}"
        f", off d by up to {at_most(100 * max(share.upper() for share in off), 4)} %; the equilibrium is within "
        f"{small(reach)} of the computed one",
    )
    yield Step(
        "the net is connected: L̂ has no kernel but translations, and every other motion is damped",
        laplacian_rank(u.n, tuple((i, j) for i, j, *_ in near)) == u.n - 1,
    )
    least = curvature(u, found)
    yield Step(
        "there ∇²V has a kernel of three dimensions, the rigid motions, and is positive definite off it",
        True if least else None,
        evidence="not certain" if least is None else f"the other eigenvalues are at least {at_least(least)} c1α",
        found={} if least is None else {"least": at_least(least, 1)},
    )


def _steps() -> Iterator[Step]:
    yield from pair_hessian()
    with ctx.workdps(DIGITS):
        yield from _strained()
    yield from modes_decay()


PROOF = Proof(
    id="strained-thirteen",
    title="Erratum E3: distinct agents in a strict minimum of V that is no lattice",
    statement=(
        f"Within {RADIUS} of the {STATED['n']} agents of the smallest known strained minimum lies exactly one "
        "equilibrium of Algorithm 1 not moved rigidly against it; its agents are distinct, its links are not all d "
        f"long, and off the rigid motions the eigenvalues of ∇²V are at least {STATED['least']} c1α. Modulo rigid "
        "motions it is locally asymptotically stable."
    ),
    hypotheses=(
        f"m = 2; {AlphaParameters.of(smallest_strained().law.alpha)}; c1α, c2α > 0. The last conclusion is cited: "
        "where all eigenvalues but those along a manifold of equilibria have negative real parts, nearby solutions "
        "converge to one of them (centre manifold theorem; Carr 1981)"
    ),
    rigour="interval",
    steps=_steps,
    size=11,
    theorems=("E3",),
    values=STATED,
)
