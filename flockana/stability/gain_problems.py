"""State matrix of a flock as a function of its γ-gains, at a configuration.

The question is that of Montanari, Barioni, Duan and Motter ("Optimal flock formation induced by agent heterogeneity"):
minimise the largest real part among the eigenvalues of [[0, I], [−diag(c1γ) − c1α∇²V, −diag(c2γ) − c2α L̂]] at a given
quasi-lattice, gains between bounds. Their simplified form drops ∇²V.

Which modes are set apart. Translation is no zero mode here: c1γ holds it, and how fast it dies is what the γ-agent is
for; it counts. Rotation about the γ-agent is neutral at every equilibrium of the law, for any gains, because the stress
in the pressed links cancels what c1γ seems to hold. At a lattice that is no equilibrium of the law, an unstressed one
above all, the printed matrix does hold it, which no flock at rest does. So rotation="counted" reads the matrix as
printed; rotation="neutral" divides the angle of the rotation about the centre out, as `blocks.Blocks.quotient` does,
so that the speed of turning is still to die out, as it is in a flock at rest; and rotation="apart" projects out angle
and speed alike: what is rated is the flock's shape and its centre, and nothing of how it turns.
"""

from dataclasses import dataclass
from math import sqrt
from typing import Any

import numpy as np

from flockana.base.value_checks import ComplexArray, FloatArray, ensure_known, ensure_points
from flockana.environment import StaticTarget
from flockana.equilibria.final_state import rigid_motions
from flockana.interactions import Gains
from flockana.interactions.alpha import AlphaInteraction
from flockana.laws import Algorithm2
from flockana.stability.second_order_blocks import reduced
from flockana.stability.zero_modes import complement

FORMS = ("full", "simplified")
ROTATIONS = ("apart", "neutral", "counted")


@dataclass(frozen=True)
class GainProblem:
    """State matrix of the gain design problem, and its eigenvalues as functions of the gains."""

    stiffness: FloatArray  # shape (N, N): c1α ∇²V, or zero in the simplified form
    damping: FloatArray  # shape (N, N): c2α L̂
    apart: FloatArray  # shape (N, k): orthonormal motions that are projected out
    agents: int  # n; each has N/n coordinates
    speeds: bool = True  # whether their velocities are projected out too, or their positions alone
    law: Algorithm2 | None = None  # law and configuration (n, m) that the matrices are of
    q: FloatArray | None = None

    @property
    def _kept(self) -> tuple[FloatArray, FloatArray]:
        """Return bases of the positions and velocities that remain when some motions are projected out."""
        kept_space = complement(self.apart)
        return kept_space, kept_space if self.speeds else np.eye(len(self.stiffness))

    def matrix(self, gains: FloatArray) -> FloatArray:
        """Return the state matrix for gains (c1γ_1 … c1γ_n, c2γ_1 … c2γ_n), without the projected motions."""
        dimension = len(self.stiffness) // self.agents
        pull, drag = np.repeat(gains, dimension).reshape(2, -1)
        return reduced(self.stiffness + np.diag(pull), self.damping + np.diag(drag), *self._kept)

    def eigenvalues(self, gains: FloatArray) -> ComplexArray:
        """Return the eigenvalues of the state matrix for given gains, largest real part first."""
        values: ComplexArray = np.linalg.eigvals(self.matrix(gains)).astype(np.complex128)
        return values[np.lexsort((values.imag, -values.real))]

    def abscissa(self, gains: FloatArray) -> float:
        """Return the largest real part of the eigenvalues for given gains: minus the slowest decay rate."""
        return float(np.linalg.eigvals(self.matrix(gains)).real.max())

    def slopes(self, gains: FloatArray) -> tuple[ComplexArray, FloatArray]:
        """Return eigenvalues and derivatives of their real parts with respect to gains, (M,) and (M, 2 n)."""
        # dλ = y* dA x/(y* x) with left and right eigenvectors y, x; meaningless where eigenvalues coalesce.
        from scipy.linalg import eig

        values, left, right = eig(self.matrix(gains), left=True, right=True)  # type: ignore[misc]
        positions, velocities = self._kept
        k = positions.shape[1]
        force = velocities @ left[k:].conj()
        scale = np.einsum("ij,ij->j", left.conj(), right)
        scale = np.where(np.abs(scale) > 1e-14, scale, 1e-14)
        moves = np.vstack([positions @ right[:k], velocities @ right[k:]]).reshape(2, self.agents, -1, values.size)
        slope = -np.einsum("aim,gaim->gam", force.reshape(self.agents, -1, values.size), moves)
        return values, (slope.reshape(2 * self.agents, -1) / scale).real.T


def gain_problem(
    q: Any, *, alpha: AlphaInteraction, gains: Gains, form: str = "full", rotation: str = "apart"
) -> GainProblem:
    """Return the gain design problem at a configuration.

    Parameters
    ----------
    gains : Gains
        c1α and c2α are used.
    form : {"full", "simplified"}
        With c1α ∇²V or without. Without it coordinates decouple into m copies of one problem of n, and nothing knows
        of rotations.
    rotation : {"apart", "neutral", "counted"}
        Whether the rotation about the centre is projected out, angle and speed; or its angle alone, as where it is
        neutral; or neither. No matter in the simplified form.

    Examples
    --------
    >>> problem = gain_problem([[0.0, 0.0], [7.0, 0.0]], alpha=AlphaInteraction(), gains=Gains(), form="simplified")
    >>> problem.damping.shape, problem.apart.shape
    ((2, 2), (2, 0))
    """
    q = ensure_points("q", getattr(q, "q", q))  # of an equilibrium
    n, m = q.shape
    for name, value, choices in (("form", form, FORMS), ("rotation", rotation, ROTATIONS)):
        ensure_known(name, value, choices)
    damping = gains.c2_alpha * alpha.laplacian(q).toarray()
    of = {"law": Algorithm2(alpha, gains, StaticTarget(q.mean(axis=0))), "q": q}
    if form == "simplified":
        return GainProblem(np.zeros((n, n)), damping[::m, ::m], np.zeros((n, 0)), n, **of)
    rigid = rigid_motions(q)
    translations = np.tile(np.eye(m), (n, 1)) / sqrt(n)
    rigid_part = rigid - translations @ (translations.T @ rigid)
    basis, singular_values, _ = np.linalg.svd(rigid_part, full_matrices=False)
    turns = basis[:, singular_values > 0.5] if rotation != "counted" else np.zeros((q.size, 0))
    return GainProblem(gains.c1_alpha * alpha.hessian(q).toarray(), damping, turns, n, rotation == "apart", **of)
