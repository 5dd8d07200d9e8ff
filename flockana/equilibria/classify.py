"""What kind of critical point a configuration is, from the spectrum of its Hessian off the rigid motions."""

from __future__ import annotations

from typing import Literal, NamedTuple

import numpy as np

from flockana.checks import FloatArray
from flockana.equilibria.potential import Potential
from flockana.errors import ArgumentError

EquilibriumKind = Literal["minimum", "saddle", "maximum", "degenerate"]

ZERO = 1e-7  # of the largest eigenvalue; at a residual force of 1e-9 a flat direction shows far less
MAX_SIZE = 6000  # n m: its whole spectrum takes a minute


class Spectrum(NamedTuple):
    """Eigenvalues off the rigid motions, rising, the number of rigid motions, of negative and of zero eigenvalues."""

    eigenvalues: FloatArray
    rigid: int
    negative: int
    zero: int


def ensure_small(n: int, m: int) -> None:
    """Raise if the whole Hessian spectrum of n agents would take more than a minute.

    Parameters
    ----------
    n, m : int
        Number of agents, dimension.

    Raises
    ------
    ArgumentError
        If n m > 6000.

    Examples
    --------
    >>> ensure_small(1000, 3)
    """
    if n * m > MAX_SIZE:
        raise ArgumentError(
            f"n = {n} agents in m = {m} dimensions: expected n m <= {MAX_SIZE}, or the spectrum takes minutes"
        )


def spectrum(potential: Potential, q: FloatArray, *, zero: float = ZERO) -> Spectrum:
    """Eigenvalues of the Hessian on the complement of the rigid motions that leave the potential unchanged.

    What is zero there is a soft mode: a hinge that bends, a component that drifts.

    Parameters
    ----------
    potential : Potential
        Whose Hessian.
    q : ndarray, shape (n, m)
        Positions, an equilibrium.
    zero : float
        Eigenvalues this small, relative to the largest in modulus (at least force_scale/d), count as zero.

    Examples
    --------
    >>> from flockana.laws.olfati_saber import Algorithm1
    >>> chain = np.array([[-7.0, 0.0], [0.0, 0.0], [7.0, 0.0]])
    >>> _, rigid, index, soft = spectrum(Potential(Algorithm1()), chain)  # it bends at the middle agent
    >>> rigid, index, soft
    (3, 0, 1)
    """
    rigid = potential.symmetries(q)
    hessian = potential.stiffness(q).toarray()
    off = hessian - rigid @ (rigid.T @ hessian)
    off -= (off @ rigid) @ rigid.T
    above = 1.0 + 2.0 * float(np.abs(hessian).sum(axis=1).max())  # beyond every eigenvalue: where rigid motions are put
    values = np.linalg.eigvalsh(0.5 * (off + off.T) + above * (rigid @ rigid.T))[: q.size - rigid.shape[1]]
    # with all agents out of range the largest eigenvalue is rounding itself: a pair's stiffness is the measure then
    small = zero * max(float(np.abs(values).max(initial=0.0)), potential.force_scale / potential.pair.length)
    return Spectrum(values, rigid.shape[1], int(np.sum(values < -small)), int(np.sum(np.abs(values) <= small)))


def falling(potential: Potential, q: FloatArray) -> FloatArray | None:
    """The direction (n, m), of unit length, in which the potential falls most steeply to second order, if it does.

    Parameters
    ----------
    potential : Potential
        Whose Hessian.
    q : ndarray, shape (n, m)
        A critical point.

    Examples
    --------
    >>> from flockana.laws.olfati_saber import Algorithm1
    >>> falling(Potential(Algorithm1()), np.array([[0.0], [7.0]])) is None
    True
    """
    values, vectors = np.linalg.eigh(potential.stiffness(q).toarray())
    scale = max(float(np.abs(values).max()), potential.force_scale / potential.pair.length)
    return None if values[0] >= -ZERO * scale else np.ascontiguousarray(vectors[:, 0].reshape(q.shape))


def kind_of(found: Spectrum) -> EquilibriumKind:
    """Name a spectrum: a negative direction decides before a zero one, which proves nothing.

    Parameters
    ----------
    found : Spectrum
        Off the rigid motions.

    Examples
    --------
    >>> kind_of(Spectrum(np.array([-1.0, 0.0, 2.0]), 3, 1, 1)), kind_of(Spectrum(np.array([0.0, 2.0]), 3, 0, 1))
    ('saddle', 'degenerate')
    """
    if found.negative:
        return "maximum" if found.negative == found.eigenvalues.size else "saddle"
    return "degenerate" if found.zero else "minimum"
