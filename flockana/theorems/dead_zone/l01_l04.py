"""Errata L1 to L4 of the dead-zone paper: the force as printed and as meant, and cohesion."""

from __future__ import annotations

from math import sqrt
from typing import Any

import numpy as np

from flockana.base.binomial import clopper_pearson
from flockana.base.checks import FloatArray
from flockana.dynamics.simulate import simulate
from flockana.interactions.dead_zone import DeadZoneInteraction
from flockana.laws.dead_zone import DeadZoneFlocking
from flockana.measures.metrics import connectivity, min_distance
from flockana.theorems.dead_zone.case import PROOF
from flockana.theorems.dead_zone.erratum import Found, advance, erratum, margin_claim, two_that_part
from flockana.theorems.dead_zone.parting import parts
from flockana.theorems.theorem import Claim, Tolerances

SEEDS = 10  # of each box in L4
_SAME = 1e-9  # relative: two forces that differ by less are the same
_INTERVAL = 1e-9  # to which the ends of an exact interval are computed
_ROUNDING = 1e-12  # relative, of a force of three agents: some hundred roundings


def _l1(tolerances: Tolerances) -> Found:
    """Three agents in two frames: the product of two vectors by components depends on the axes."""
    pair = DeadZoneInteraction(k1=0.0)
    q = np.array([[0.0, 0.0], [2.0, 0.5], [-1.0, 2.5]])
    turn = np.array([[0.6, -0.8], [0.8, 0.6]])

    def printed(x: FloatArray) -> FloatArray:
        """u_i = Σ_j φ_zi ∘ n_ij with φ_zi = Σ_j f_ij n_ij, the only product of (7) and (9) that gives a vector."""
        delta = x[None] - x[:, None]
        rho = np.linalg.norm(delta, axis=2)
        n = delta / np.sqrt(1.0 + pair.eta * rho**2)[:, :, None]
        f = np.where(rho > 0.0, pair.action(np.where(rho > 0.0, rho, 8.0)), 0.0)
        u: FloatArray = np.einsum("ij,ijc->ic", f, n) * n.sum(axis=1)
        return u

    law = DeadZoneFlocking(pair)

    def resolved(x: FloatArray) -> FloatArray:
        return law.acceleration(0.0, x, np.zeros_like(x))

    def twist(u: Any) -> float:
        return float(np.abs(u(q @ turn.T) - u(q) @ turn.T).max() / np.abs(u(q)).max())

    off, kept = twist(printed), twist(resolved)
    return [], [
        margin_claim(
            "printed",
            _SAME - off,
            f"read by components, turning the axes changes the force by {off:.3g} of itself",
            error=_ROUNDING,
        ),
        margin_claim(
            "corrected",
            _SAME - kept,
            f"with f once and n once the force turns with the axes, to {kept:.2g}",
            error=_ROUNDING,
        ),
    ]


def _l2(tolerances: Tolerances) -> Found:
    """The index pattern of (8) turns repulsion into attraction, and the fall into each other ends in finite time."""
    from scipy.integrate import quad

    pair, start = DeadZoneInteraction(k1=0.0), 3.0
    toward = float(pair.force(start)) / pair.contact_force
    level = float(pair.psi(start))
    # two agents at rest under −F: ½ρ'² = 2(ψ(ρ) − ψ(3)), and with ρ = 3(1 − x²) the integrand is smooth at the start
    fall = quad(lambda x: 3.0 * x / sqrt(pair.psi(start * (1.0 - x * x)) - level), 0.0, 1.0, limit=200)[0]
    return [], [
        margin_claim(
            "printed",
            toward,
            f"with n = q_i - q_j two agents at rest {start:g} apart, nearer than d1, are drawn together and meet after "
            f"{fall:.4g}",
            error=_ROUNDING,
            computed=fall,
            stated="repulsion below r_b - δ",
            proof=PROOF,
        ),
        margin_claim(
            "corrected",
            -toward,
            f"with n = q_j - q_i their force is {toward:.4g} of that of a contact: it repels",
            error=_ROUNDING,
        ),
    ]


def _l3(tolerances: Tolerances) -> Found:
    """φ_z grows as 1/ρ², its potential as −ln ρ: by algebra."""
    import sympy as sp

    from flockana.symbolic.dead_zone import K_R, RHO, derive_potential, repulsion

    growth = sp.limit(RHO**2 * repulsion(), RHO, 0, "+")
    found = derive_potential()
    unbounded = bool(growth == 2 * K_R)
    return [], [
        Claim(
            "printed",
            "refuted" if unbounded else "verified",
            "symbolic",
            computed=str(growth),
            stated="φ_z is a bounded, positive definite potential",
            witness="limit of ρ² |f| at 0",
            proof=PROOF,
            detail="φ_z is a force, and ρ²|φ_z| tends to 2 k_r at 0: it is unbounded",
        ),
        Claim(
            "corrected",
            "verified" if found.holds else "refuted",
            "symbolic",
            computed=[str(residual) for residual in found.residuals],
            stated="dψ/dρ = F, and ψ/(-2k_r ln ρ) -> 1",
            proof=PROOF,
            detail="the potential in closed form, for η > 0 and η = 0, grows only logarithmically at 0, as n ~ ρ",
        ),
    ]


def connected_share(box: float, *, seeds: int, n: int = 50, t_end: float = 60.0) -> int:
    """How many of the first seeds give one component in the end, from q(0) uniform in [0, box]².

    Parameters
    ----------
    box : float
        Side of the box; velocities are uniform in [−1, 1]².
    seeds : int
        How many.
    n : int
        Agents.
    t_end : float
        When it is counted.
    """
    law, count = DeadZoneFlocking(), 0
    for seed in range(seeds):
        generator = np.random.default_rng(seed)
        q, p = generator.uniform(0.0, box, (n, 2)), generator.uniform(-1.0, 1.0, (n, 2))
        count += connectivity(advance(law, q, p, 0.01, t_end)[0], law.interaction.r) == 1.0
    return count


def _l4(tolerances: Tolerances) -> Found:
    """Connectivity is not implied: a pair, and flocks from wide starts."""
    law, q, p = two_that_part()
    run = simulate(law, q, p, (0.0, 10.0))
    end = parts(run.q[-1], run.p[-1], law)
    near, far = (connected_share(box, seeds=SEEDS) for box in (40.0, 150.0))
    least, most = float(clopper_pearson(near, SEEDS)[0]), float(clopper_pearson(far, SEEDS)[1])
    radius = 0.5 * min_distance(run.q[-1])
    return [], [
        margin_claim(
            "printed",
            -end.separation.margin,
            f"two agents {q[1, 0]:g} apart that leave each other at {2.0 * p[1, 0]:g} part for ever: at t = 10 "
            f"they are {radius:.4g} from their centre, where {end.separation.text}",
            error=end.separation.error,
            computed=radius,
            stated="no agent farther than r from the leader",
            proof=PROOF,
        ),
        margin_claim(
            "wide-starts",
            least - most,
            f"of {SEEDS} starts in a box of 40 m {near} end connected, of {SEEDS} in one of 150 m {far}: shares of at "
            f"least {least:.2f} and at most {most:.2f} (95 %)",
            error=_INTERVAL,
            computed=[near, far],
            stated="the share of connected flocks falls with the box",
        ),
    ]


THEOREM = (
    erratum(
        1,
        "Direction and sum occur once",
        "(7) already sums over neighbours and carries the direction; (9) multiplies by n_ij and sums again. A product "
        "of two vectors is undefined; by components it depends on the axes. The scalar force once and n once is meant.",
        "(7) and (9)",
        _l1,
        whole="refuted",
        printed="refuted",
        corrected="verified",
    ),
    erratum(
        2,
        "n points from i to j",
        "Three conventions for n are given; with q_i - q_j repulsion and attraction change places and agents fall into "
        "each other. q_j - q_i is meant throughout.",
        "(6)-(8)",
        _l2,
        whole="refuted",
        printed="refuted",
        corrected="verified",
    ),
    erratum(
        3,
        "φ_z is a force, unbounded as 1/r²",
        "φ_z is called a bounded potential. It is a force, unbounded as 1/r²; its potential is unbounded too, but only "
        "logarithmically, because n ~ ρ.",
        "section III",
        _l3,
        whole="refuted",
        printed="refuted",
        corrected="verified",
    ),
    erratum(
        4,
        "Cohesion is not implied",
        "No leader appears in (9), and nothing keeps the net connected: two agents 14 m apart that leave each other at "
        "12 m/s separate, and from wide starts the share of connected flocks falls towards 0.",
        "Theorem 1, first claim",
        _l4,
        whole="refuted",
        printed="refuted",
        wide_starts="verified",
    ),
)
