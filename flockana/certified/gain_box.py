"""Stability of a flock for every choice of gains in a box, proved at the box's corners.

At a given configuration K = c1α ∇²V + diag(c1γ) and D = c2α L̂ + diag(c2γ) are symmetric and linear in the gains, those
of the γ-agent one per agent. The least eigenvalue of such a matrix is a concave function of the gains and rises with
those of the γ-agent: over a box it is least where these are least, at one end of c1α or c2α. Where K and D are positive
definite every mode decays; the proof of that is interval arithmetic.
"""

from dataclasses import dataclass
from itertools import product
from typing import Any, Literal

import numpy as np
from flint import arb, arb_mat

from flockana.base.checks import FloatArray, ensure_nonnegative, ensure_points
from flockana.base.errors import ArgumentError, format_value
from flockana.certified.krawczyk import least_eigenvalue
from flockana.laws.olfati_saber import Algorithm2
from flockana.stability.rounding import eigen

MOST = 7  # agents
_ROUNDING = 1e-12  # relative: error of the entries of ∇²V and L̂


@dataclass(frozen=True)
class GainBox:
    """Outcome of `gain_box`.

    Parameters
    ----------
    status : {"verified", "refuted", "inconclusive"}
        Stable in all of the box; unstable at `witness`; or neither is certain.
    witness : tuple of float
        c1α, c2α, c1γ, c2γ at which a mode grows; empty without one.
    """

    status: Literal["verified", "refuted", "inconclusive"]
    witness: tuple[float, ...] = ()


def gain_box(law: Algorithm2, q: Any, spread: float) -> GainBox:
    """Decide whether a flock stays stable if each gain is off by up to a share, those of the γ-agent agent by agent.

    Parameters
    ----------
    law : Algorithm2
        The law with its nominal gains.
    q : array_like, shape (n, m)
        Configuration of at most 7 agents; it is kept as it is, an α-lattice for instance.
    spread : float
        Share by which each gain may be smaller or larger, 0 <= spread < 1.

    Examples
    --------
    >>> from flockana.environment.targets import StaticTarget
    >>> triangle = [[0.0, 0.0], [7.0, 0.0], [3.5, 6.0621778264910706]]
    >>> gain_box(Algorithm2(target=StaticTarget((0.0, 0.0))), triangle, 0.5).status
    'verified'
    """
    q = ensure_points("q", getattr(q, "q", q))  # of an equilibrium
    spread = ensure_nonnegative("spread", spread)
    if type(law) is not Algorithm2:
        raise ArgumentError(f"law = {format_value(law)}: expected Algorithm2(...)")
    law.check_dimension(q.shape[1])
    law.check_agents(len(q))
    if len(q) > MOST:
        raise ArgumentError(f"q has {len(q)} agents: expected at most {MOST}; robustness_margins takes more")
    if spread >= 1.0:
        raise ArgumentError(f"spread = {spread:g}: expected a share below 1")
    gains, low = law.gains, 1.0 - spread
    hessian, damping = law.alpha.hessian(q).toarray(), law.alpha.laplacian(q).toarray()
    pull, drag = (np.diag(low * np.broadcast_to(x, q.shape).ravel()) for x in (gains.pull, gains.drag))
    ends = (low, 1.0 + spread)
    stiff = [end * gains.c1_alpha * hessian + pull for end in ends]
    damp = [end * gains.c2_alpha * damping + drag for end in ends]
    if all(_definite(matrix) for matrix in (*stiff, *damp)):
        return GainBox("verified")
    for (a, k), (b, d) in product(zip(ends, stiff, strict=True), zip(ends, damp, strict=True)):
        values, _, errors = eigen(np.block([[np.zeros_like(k), np.eye(len(k))], [-k, -d]]))
        if np.any(values.real > errors):
            own = (a * gains.c1_alpha, b * gains.c2_alpha, low * np.min(gains.c1_gamma), low * np.min(gains.c2_gamma))
            return GainBox("refuted", tuple(map(float, own)))
    return GainBox("inconclusive")


def _definite(matrix: FloatArray) -> bool:
    """Return whether a symmetric matrix, known to rounding, is certainly positive definite."""
    slack = _ROUNDING * len(matrix) * float(np.abs(matrix).max())
    lowered = 0.5 * (matrix + matrix.T) - slack * np.eye(len(matrix))
    return least_eigenvalue(arb_mat([[arb(x) for x in row] for row in lowered.tolist()])) is not None
