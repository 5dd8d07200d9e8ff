"""Linear flock x'' = −K x − D x' + w about a state, and its quotient by rigid motions."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from flockana.base.argument_kinds import check_kinds
from flockana.base.errors import ArgumentError
from flockana.base.short_repr import ShortRepr
from flockana.base.value_checks import FloatArray, ensure_points
from flockana.equilibria.final_state import rigid_motions
from flockana.laws import Navigation, PairTerm
from flockana.stability.zero_modes import NEUTRAL, complement

MOST = 2000  # rows of a dense matrix of the second order; its state space has twice as many


@dataclass(frozen=True)
class Blocks(ShortRepr):
    """x'' = −K x − D x' + w in the order of ``q.ravel()``, w a disturbing force on each agent.

    Parameters
    ----------
    stiffness, damping : ndarray, shape (n m, n m)
        K and D, symmetric.
    rigid : ndarray, shape (n m, r)
        Orthonormal basis of all rigid motions.
    neutral : ndarray, shape (n m, k)
        Those with K ρ = 0: nothing brings the flock back.
    drifting : ndarray, shape (n m, f)
        Those with D ρ = 0 as well: nothing even slows it down.

    Examples
    --------
    Algorithm 1 lets a bond drift (2 translations) and leaves its orientation neutral:

    >>> from flockana import Algorithm1, stability
    >>> pair = stability.law_blocks(Algorithm1(), [[0.0, 0.0], [7.0, 0.0]])
    >>> pair.rigid.shape[1], pair.neutral.shape[1], pair.drifting.shape[1]
    (3, 3, 2)
    """

    stiffness: FloatArray
    damping: FloatArray
    rigid: FloatArray
    neutral: FloatArray
    drifting: FloatArray

    def matrix(self) -> FloatArray:
        """State matrix A of (x, x')' = A (x, x'), shape (2 n m, 2 n m)."""
        identity = np.eye(len(self.stiffness))
        return reduced(self.stiffness, self.damping, identity, identity)

    def quotient(self) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
        """State and input matrices without free rigid motions, and bases of positions and velocities.

        The state is (Nᵀx, Vᵀx'). (ρ, 0) with K ρ = 0 is invariant, and what drifts is so with its velocity: dividing
        them out is exact. What remains knows every shape, but neither the orientation nor, under Algorithm 1, the
        centre of mass. Disturbances turn the flock by a random walk; that is no fault of its shape.
        """
        positions, velocities = complement(self.neutral), complement(self.drifting)
        a = reduced(self.stiffness, self.damping, positions, velocities)
        b = np.vstack([np.zeros((positions.shape[1], len(self.stiffness))), velocities.T])
        return a, b, positions, velocities


def reduced(stiffness: FloatArray, damping: FloatArray, positions: FloatArray, velocities: FloatArray) -> FloatArray:
    """Return the state matrix of x'' = −K x − D x' in given bases of positions and velocities."""
    top = np.hstack([np.zeros((positions.shape[1],) * 2), positions.T @ velocities])
    return np.vstack([top, -velocities.T @ np.hstack([stiffness @ positions, damping @ velocities])])


@check_kinds
def blocks(stiffness: FloatArray, damping: FloatArray, q: FloatArray, *, zero: float = NEUTRAL) -> Blocks:
    """Classify a flock's rigid motions by their restoring forces.

    Parameters
    ----------
    stiffness, damping : ndarray, shape (n m, n m)
        K and D, such as those of a `Linearisation`, dense.
    q : ndarray, shape (n, m)
    zero : float
        What counts as no force, relative to those that cancel in it.

    Examples
    --------
    >>> blocks(np.zeros((2, 2)), np.eye(2), np.array([[0.0, 0.0]])).drifting.shape
    (2, 0)
    """
    rigid = rigid_motions(ensure_points("q", q))
    neutral_basis = _kernel(stiffness, rigid, zero)
    return Blocks(stiffness, damping, rigid, neutral_basis, _kernel(damping, neutral_basis, zero))


def is_pairs_and_pull(law: Any) -> bool:
    """Return whether a law has pair terms and at most a linear pull to a γ-agent, as Algorithms 1 and 2."""
    terms = getattr(law, "terms", ())
    return bool(terms) and all(isinstance(x, PairTerm) or (isinstance(x, Navigation) and not x.unit) for x in terms)


def ensure_pairs_and_pull(law: Any) -> None:
    """Raise unless a law has only pair terms and at most a linear pull to a γ-agent."""
    if not is_pairs_and_pull(law):
        raise ArgumentError(
            f"expected Algorithm1 or Algorithm2, pairs and at most a linear pull: got {type(law).__name__}"
        )


def _kernel(matrix: FloatArray, basis: FloatArray, zero: float) -> FloatArray:
    """Return an orthonormal basis of the kernel of a matrix within the span of `basis`."""
    if basis.shape[1] == 0:
        return basis
    _, singular_values, rows = np.linalg.svd(matrix @ basis, full_matrices=False)
    return basis @ rows[singular_values <= zero * float((np.abs(matrix) @ np.abs(basis)).max())].T
