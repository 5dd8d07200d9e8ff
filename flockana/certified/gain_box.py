"""Stability at a configuration for every choice of gains in a box, proved at the box's corners.

At a configuration that is kept as it is, K = c1α ∇²V + diag(c1γ) and D = c2α L̂ + diag(c2γ) are symmetric and linear
in the gains, those of the γ-agent one per agent. The least eigenvalue of such a matrix is a concave function of the
gains and rises with those of the γ-agent: over a box it is least where these are least, at one end of c1α or c2α. Where
K and D are positive definite every mode decays; the proof of that is interval arithmetic. At an equilibrium the
rotations about the γ-agent are neutral and left out; as an equilibrium moves with the gains, that is proved for the
nominal gains alone. A corner refutes stability only if the equilibrium that is found from there, with its gains, is
unstable.
"""

from dataclasses import dataclass, replace
from itertools import product
from typing import Any, Literal

import numpy as np
from flint import arb, arb_mat

from flockana.base.checks import FloatArray, ensure_nonnegative, ensure_points
from flockana.base.errors import ArgumentError, format_value
from flockana.certified.krawczyk import least_eigenvalue
from flockana.equilibria.potential import Potential
from flockana.equilibria.solve import RESIDUAL, find_equilibrium
from flockana.equilibria.terminal import generators
from flockana.laws.olfati_saber import Algorithm2
from flockana.stability.bases import complement
from flockana.stability.linearise import linearise
from flockana.stability.sweeps import GAINS

MOST = 7  # agents
_ON_A_LINE = 1e-9  # relative: a rotation that moves no agent
_ROUNDING = 1e-12  # relative: error of the entries of ∇²V and L̂


@dataclass(frozen=True)
class GainBox:
    """Stability of a configuration for all gains in a box: proved, refuted by gains, or neither.

    Parameters
    ----------
    status : {"verified", "refuted", "inconclusive"}
        Every mode decays at the configuration for all gains of the box; the equilibrium near it is unstable for the
        gains `witness`; or neither is certain.
    witness : tuple of float
        c1α, c2α, c1γ, c2γ with which a mode of the equilibrium grows; empty without one.
    """

    status: Literal["verified", "refuted", "inconclusive"]
    witness: tuple[float, ...] = ()


def gain_box(law: Algorithm2, q: Any, spread: float) -> GainBox:
    """Decide whether every mode decays at a configuration if each gain is off by up to a share, agent by agent.

    What is proved holds for the linear system at that configuration, δq'' = −K δq − D δq', for all gains of the box.
    A flock whose equilibrium moves with its gains is linearised elsewhere: no proof is claimed for it but at spread 0,
    where rotations about the γ-agent are left out, and it is refuted only by an equilibrium of its own.

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
    if spread == 0.0 and law.target is not None and Potential(law).residual(q) <= RESIDUAL:
        rotations = np.array([((q - law.target.position(0.0)) @ turn.T).ravel() for turn in generators(q.shape[1])])
        basis, sizes, _ = np.linalg.svd(rotations.reshape(-1, q.size).T, full_matrices=False)
        kept = complement(basis[:, sizes > _ON_A_LINE * sizes.max(initial=0.0)])
        if all(_definite(matrix) for matrix in (kept.T @ stiff[0] @ kept, *damp)):
            return GainBox("verified")
    for a, b in product(ends, ends):
        own: Any = (
            a * gains.c1_alpha,
            b * gains.c2_alpha,
            low * np.asarray(gains.c1_gamma),
            low * np.asarray(gains.c2_gamma),
        )
        corner = replace(law, gains=replace(gains, **dict(zip(GAINS, own, strict=True))))
        rest = find_equilibrium(corner, q)
        if rest.success and any(mode.decay_rate < -mode.error for mode in linearise(corner, rest).modes):
            return GainBox("refuted", tuple(float(np.min(x)) for x in own))
    return GainBox("inconclusive")


def _definite(matrix: FloatArray) -> bool:
    """Return whether a symmetric matrix, known to rounding, is certainly positive definite."""
    slack = _ROUNDING * len(matrix) * float(np.abs(matrix).max())
    lowered = 0.5 * (matrix + matrix.T) - slack * np.eye(len(matrix))
    return least_eigenvalue(arb_mat([[arb(x) for x in row] for row in lowered.tolist()])) is not None
