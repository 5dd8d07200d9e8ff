"""Zero modes of δq'' + D δq' + K δq = 0: kernels of K relative to agent stiffness, by component.

How stiff a motion is, is told by what K does to it relative to the stiffness of the agents that move, not of the
stiffest agent of all: an agent held by 1e-5 beside links of 1e3 is held. A net that is not strongly connected is looked
at by components: the kernel of each is continued to those that hear it, where these can follow.
"""

from cmath import sqrt
from typing import Any, NamedTuple

import numpy as np

from flockana.base.errors import SolverError
from flockana.base.value_checks import FloatArray
from flockana.equilibria.curvature import EPS
from flockana.measures.centre_frame import moving_frame
from flockana.stability.mode_names import translations
from flockana.stability.strong_components import StrongComponents

NEUTRAL = 1e-9  # of the stiffness of its agents: a rigid motion that meets no more than that is neutral
ZERO = 1e-8  # of the agents' own row sums: what K does to a motion that costs nothing
_ROUNDING, _LEFT = 64.0, 16.0  # of eps √N, and of the force left at an equilibrium: what may appear as stiffness
_BELOW, _ABOVE = 10.0, 1000.0  # times the threshold: where a motion may or may not be a zero mode
_ONE_PLACE = 1e-6  # relative to the largest coordinate, whose rounding is a large share of so small a flock
_SPLIT = 1e-10  # relative: how much of the centre's motion may leak into the shape where the split is called exact
_ROUNDINGS = 8.0  # of eps √N times the largest row sum: rounding of sums that cancel


class Split(NamedTuple):
    """Decoupling of the centre of mass: its own dynamics by axis, and the coupling's size.

    `errors` are those of stiffness and damping, which remain when the agents' pair terms have cancelled.
    """

    stiffness: FloatArray
    damping: FloatArray
    leak: float
    errors: tuple[float, float]

    @property
    def exact(self) -> bool:
        """Return whether centre of mass and shape are decoupled within a tolerance."""
        return self.leak <= _SPLIT


def split(stiffness: Any, damping: Any, m: int) -> Split:
    """Return the split into centre of mass and shape, if K, D and their transposes map translations to translations."""
    unit = translations(stiffness.shape[0] // m, m)
    own_groups, coupling_leak, errors = [], 0.0, []
    for matrix in (stiffness, damping):
        magnitude = float(abs(matrix).max()) or 1.0
        errors.append(_ROUNDINGS * EPS * sqrt(stiffness.shape[0]).real * float(abs(matrix).sum(axis=1).max()))
        block = unit.T @ (matrix @ unit)
        diagonal_entries = np.diag(block)
        for image in (matrix @ unit, matrix.T @ unit):
            coupling_leak = max(coupling_leak, float(np.abs(image - unit * diagonal_entries).max()) / magnitude)
        own_groups.append(diagonal_entries)
    return Split(own_groups[0], own_groups[1], coupling_leak, (errors[0], errors[1]))


def agent_scales(stiffness: Any, m: int) -> FloatArray:
    """Return the largest row sum of K among the coordinates of each agent, by coordinate."""
    rows = np.asarray(abs(stiffness).sum(axis=1)).reshape(-1, m).max(axis=1)
    return np.repeat(np.where(rows > 0.0, rows, rows.max(initial=0.0) or 1.0), m)


def extent(q: FloatArray) -> float:
    """Return the size of a flock; for coincident agents, their distance from the origin."""
    magnitude, largest_entry = float(np.linalg.norm(moving_frame(q), axis=1).max()), float(np.abs(q).max())
    return magnitude if magnitude > _ONE_PLACE * largest_entry else largest_entry or 1.0


def zero_threshold(stiffness: Any, force: FloatArray, length: float) -> float:
    """Return the relative stiffness that rounding and a residual force (n, m) may produce."""
    scales = agent_scales(stiffness, force.shape[1])
    left = _LEFT * float((np.abs(force).ravel() / scales).sum()) / length  # a force f turns into f/length, as a stress
    return min(ZERO, max(_ROUNDING * EPS * sqrt(force.size).real, left))


class Kernel(NamedTuple):
    """Right and left kernel of K, with all rising relative singular values."""

    right: FloatArray
    left: FloatArray
    sizes: FloatArray

    def doubtful(self, zero: float) -> FloatArray:
        """Return the singular values too close to the threshold for a decision."""
        return self.sizes[(self.sizes > zero / _BELOW) & (self.sizes < zero * _ABOVE)]


def kernel_of(stiffness: FloatArray, scales: FloatArray, zero: float, *, symmetric: bool) -> Kernel:
    """Return the kernels of a dense K: motions with relative stiffness at most `zero`."""
    if symmetric:
        inverse_root = 1.0 / np.sqrt(scales)
        values, vectors = np.linalg.eigh(inverse_root[:, None] * (0.5 * (stiffness + stiffness.T)) * inverse_root)
        is_null = np.abs(values) <= zero
        right = _orthonormal(inverse_root[:, None] * vectors[:, is_null])
        return Kernel(right, right, np.sort(np.abs(values)))
    left, singular_values, rows = np.linalg.svd(stiffness / scales[:, None])
    is_null = singular_values <= zero
    return Kernel(rows[is_null].T, _orthonormal(left[:, is_null] / scales[:, None]), singular_values[::-1])


def joined_kernel(stiffness: Any, net: StrongComponents, parts: list[Kernel], zero: float) -> Kernel:
    """Return the kernels of a sparse K from those of its strongly connected components."""
    group_order, reverse_order = range(len(net)), range(len(net) - 1, -1, -1)
    right = _continued(stiffness, net, [(part.right, part.left) for part in parts], group_order, zero)
    left = _continued(stiffness.T.tocsr(), net, [(part.left, part.right) for part in parts], reverse_order, zero)
    if right.shape != left.shape:
        raise SolverError(
            f"K has {right.shape[1]} zero modes by its rows and {left.shape[1]} by its columns: its rank is in doubt "
            f"at {zero:.2g}; give `zero`, what counts as a zero mode"
        )
    return Kernel(right, left, np.sort(np.concatenate([part.sizes for part in parts])))


def _continued(stiffness: Any, net: StrongComponents, kernels: Any, order: Any, zero: float) -> FloatArray:
    """Return a basis of a stiffness kernel, built component by component of the net."""
    basis = np.zeros((stiffness.shape[0], 0))
    for k in order:
        rows, (free, left_kernel) = net.indices[k], kernels[k]
        block = stiffness[rows]
        if basis.shape[1] and block.nnz:
            push, all_terms = block @ basis, abs(block) @ np.abs(basis)
            push[np.abs(push) <= zero * all_terms] = 0.0  # terms that cancel: what is left would be a motion elsewhere
            if free.shape[1] and push.any():  # a part that can move freely cannot take up a force along that motion
                projected_push = left_kernel.T @ push
                terms = float((np.abs(left_kernel).T @ all_terms).max())
                _, singular_values, turn = np.linalg.svd(projected_push)
                rank = int(np.sum(singular_values > zero * terms))
                basis, push = basis @ turn[rank:].T, push @ turn[rank:].T
            if push.any():
                own_rows = block[:, rows].toarray()
                scale = np.abs(own_rows).sum(axis=1, keepdims=True)
                scale[scale == 0.0] = 1.0
                basis[rows] = -np.linalg.lstsq(own_rows / scale, push / scale, rcond=zero)[0]
                basis = basis / np.linalg.norm(basis, axis=0)
        new_columns = np.zeros((len(basis), free.shape[1]))
        new_columns[rows] = free
        basis = np.hstack([basis, new_columns])
    return _orthonormal(basis)


def _orthonormal(basis: FloatArray) -> FloatArray:
    return np.linalg.qr(basis)[0] if basis.shape[1] else basis


class Quotient(NamedTuple):
    """Dynamics x' = A x + `basis`[N:]ᵀ w off the zero modes, with x = basisᵀ (pace δq, δp).

    `force` gives δq'' = force x, which zero modes do not change.
    """

    A: FloatArray
    basis: FloatArray
    force: FloatArray
    pace: float


def complement(basis: Any) -> Any:
    """Return an orthonormal basis of the orthogonal complement of the columns of a matrix."""
    if basis.shape[1] == 0:
        return np.eye(basis.shape[0])
    return np.linalg.svd(basis, full_matrices=True)[0][:, basis.shape[1] :]
