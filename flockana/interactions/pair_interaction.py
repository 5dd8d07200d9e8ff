"""Base class of pair laws: sums over all pairs within range from scalar functions."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable
from functools import cached_property
from math import inf
from typing import TYPE_CHECKING, Any

import numpy as np

from flockana.base.errors import ArgumentError
from flockana.base.value_checks import FloatArray, ensure_finite_scalar, ensure_positive, normalise
from flockana.interactions.distance_functions import DistanceFunction, InnerValues
from flockana.jit import thawed
from flockana.kernels.cell_grid import LARGE
from flockana.kernels.neighbours import pair_blocks
from flockana.kernels.pair_kernels import PairKernels
from flockana.kernels.scalars import sigma_norm
from flockana.kernels.thread_counts import several_threads

if TYPE_CHECKING:
    from scipy.sparse import csr_array

Pairs = Iterable[tuple[Any, Any]]


def evaluate(compiled: Callable[..., Any], x: Any, *parameters: Any) -> Any:
    """Return a compiled scalar function's values at a scalar or an array."""
    values = np.asarray(x, dtype=np.float64)
    output = compiled(values.ravel(), *parameters)
    return float(output[0]) if values.ndim == 0 else output.reshape(values.shape)


def one_by_one(function: Callable[..., float], par: FloatArray) -> Callable[[FloatArray], FloatArray]:
    """Return a scalar function with fixed parameters as an interpreted function of arrays."""
    parameter_list = par.tolist()
    return lambda z: np.array([function(item, parameter_list) for item in z.tolist()])


def kernel_values(kernels: PairKernels, par: FloatArray, s2: FloatArray) -> InnerValues:
    """Return force weight, adjacency and their slopes at squared distances, from a law's compiled functions."""
    line = np.append(0.0, np.sqrt(s2))[:, None]
    ends = np.arange(1, line.size, dtype=np.int64)
    w, a, weight_slope = kernels.terms(line, np.zeros_like(ends), ends, par)
    slope = kernels.adjacency_slope
    return w, a, weight_slope, np.full_like(w, np.nan) if slope is None else slope(s2, par)


class Tabulated(ABC):
    """Base class of pair laws whose parameters and panels are computed once, together."""

    @abstractmethod
    def _tabulate(self) -> tuple[FloatArray, FloatArray]:
        """Return parameters for the kernels, and Chebyshev panels of the potential."""

    @cached_property
    def _parts(self) -> tuple[FloatArray, FloatArray]:
        parts = self._tabulate()
        for array in parts:
            array.setflags(write=False)
        return parts

    @property
    def par(self) -> FloatArray:
        """Pair law's parameters in the order in which its compiled functions read them."""
        return self._parts[0]

    @property
    def panels(self) -> FloatArray:
        """Chebyshev panels of a potential without a closed form."""
        return self._parts[1]


class PairInteraction(DistanceFunction):
    """Base class of pair laws: sums over all pairs within range from scalar functions.

    A subclass is a frozen dataclass that sets `range`, `kernels`, `par` and `panels`; pairs beyond the range have the
    constant potential `far_potential` and no force.
    """

    kernels: PairKernels

    @property
    @abstractmethod
    def far_potential(self) -> float:
        """Potential of a pair beyond the range."""

    @property
    @abstractmethod
    def length(self) -> float:
        """Desired distance of neighbours, the unit of lengths."""

    @property
    def bend_length(self) -> float:
        """Length ℓ of a bounded pull σ₁(x/ℓ) to a γ-agent; by default `length`."""
        return self.length

    @property
    def lattice(self) -> tuple[float, float] | None:
        """(d, r) if every neighbour within range is held at d, so that α-lattices are defined; else None."""
        return (self.length, self.range) if self.bond_range == self.range else None

    @property
    def bond_range(self) -> float:
        """Distance below which the force holds pairs at the desired distance; by default the range."""
        return self.range

    @property
    def surfaces(self) -> tuple[float, ...]:
        """Distances at which the pair force begins, ends or jumps; by default the range alone."""
        return (self.range,)

    @property
    def seams(self) -> tuple[float, ...]:
        """Distances at which the formula of force or adjacency may change; by default `surfaces`."""
        return self.surfaces

    @property
    def poles(self) -> tuple[float, ...]:
        """Distances at which the potential is infinite or the force has no limit."""
        edge = (self.range,) if self.far_potential == inf else ()
        return edge if self.coincidence else (0.0, *edge)

    @property
    @abstractmethod
    def strength(self) -> float:
        """Unit of forces: about the largest between two agents, or at contact where it is unbounded."""

    def energy(self, s: Any) -> Any:
        """Return the potential of a pair at Euclidean distances, constant beyond the range (see `DistanceFunction`)."""
        squared_value = np.square(np.asarray(s, dtype=np.float64))
        return evaluate(self.kernels.energies, squared_value, self.par, self.panels)

    def inner(self, s2: FloatArray) -> InnerValues:  # noqa: D102
        return kernel_values(self.kernels, self.par, s2)

    @property
    @abstractmethod
    def par(self) -> FloatArray:
        """Pair law's parameters in the order in which its compiled functions read them."""

    @property
    @abstractmethod
    def panels(self) -> FloatArray:
        """Chebyshev panels of the potential, or an empty (0, 0) array where it is in closed form."""

    def forces(
        self, q: FloatArray, p: FloatArray, *, stiffness: float, damping: float, out: FloatArray | None = None
    ) -> tuple[FloatArray, float]:
        """Return pair accelerations and their dissipation, unchecked (inner loop of the integrators).

        Parameters
        ----------
        stiffness, damping : float
            Gains c1 of the gradient term and c2 of the velocity-consensus term.
        out : ndarray, shape (n, m), optional
            Accelerations to add to, in place.

        Returns
        -------
        u : ndarray, shape (n, m)
            c1 Σ_j φ n_ij + c2 Σ_j a_ij (p_j − p_i).
        dissipation : float
            pᵀL̂p = ½ Σ over ordered pairs of a_ij ‖p_j − p_i‖².
        """
        u = np.zeros_like(q) if out is None else out
        par = self._constants
        sums = self.kernels.sums(q.shape[1], par.size)
        if len(q) < LARGE:
            return u, sums.forces(q, p, self.range, par, stiffness, damping, u, np.empty((3, *q.shape)))
        with several_threads() as several:
            force_kernel = sums.parallel_forces_in_slabs if several else sums.forces_in_slabs
            return u, force_kernel(q, p, self.range, par, stiffness, damping, u, np.empty((3, *q.shape)))

    @cached_property
    def _constants(self) -> FloatArray:
        """Return the pair law's parameters as a view that the integrators' compiled functions accept."""
        return thawed(self.par)

    def potential_energy(self, q: FloatArray) -> float:
        """Return V(q) = ½ Σ_i Σ_{j≠i} ψ: every pair once, those out of range included."""
        n, near_energy, pairs = q.shape[0], 0.0, 0
        if n < LARGE:
            for i, j in pair_blocks(q, self.range):
                near_energy += self.kernels.potential(q, i, j, self.par, self.panels)
                pairs += i.size
        else:
            with several_threads() as several:
                near_energy, pairs = self.kernels.energy_in_slabs(several=several)(q, self.range, self.par, self.panels)
        beyond = n * (n - 1) // 2 - pairs
        return float(near_energy + beyond * self.far_potential if beyond else near_energy)  # it may be infinite there

    def hessian(self, q: FloatArray, pairs: Pairs | None = None) -> csr_array:
        """Return ∇²V(q), sparse and symmetric, in the order of ``q.ravel()``.

        Parameters
        ----------
        pairs : iterable of (ndarray, ndarray), optional
            Blocks of pairs that interact, by default those within range.

        Returns
        -------
        scipy.sparse.csr_array, shape (n m, n m)
        """
        return self._assemble(q, self._stiffness_blocks, pairs)

    def laplacian(self, q: FloatArray, pairs: Pairs | None = None) -> csr_array:
        """Return L̂(q) = L ⊗ I_m with the weights a_ij, sparse, in the order of ``q.ravel()``.

        Parameters
        ----------
        pairs : iterable of (ndarray, ndarray), optional
            As in `hessian`.

        Returns
        -------
        scipy.sparse.csr_array, shape (n m, n m)
        """
        return self._assemble(q, lambda i, j, delta, terms: terms[1][:, None, None] * np.eye(delta.shape[1]), pairs)

    def jacobian(
        self, q: FloatArray, p: FloatArray, *, stiffness: float, damping: float, pairs: Pairs | None = None
    ) -> tuple[csr_array, csr_array]:
        """Return derivatives of the accelerations of `forces` in q and in p, sparse, ordered as ``q.ravel()``.

        Parameters
        ----------
        stiffness, damping : float
            Gains c1 and c2, as in `forces`.
        pairs : iterable of (ndarray, ndarray), optional
            As in `hessian`.

        Returns
        -------
        by_position, by_velocity : scipy.sparse.csr_array, shape (n m, n m)
            −c1 ∇²V + c2 Σ_j (p_j − p_i) ∂a_ij/∂q, and −c2 L̂.

        Raises
        ------
        ArgumentError
            If velocities differ within the range and the law gives no slope of its adjacency.
        """
        slope_kernel = self.kernels.adjacency_slope

        def consensus(i: Any, j: Any, delta: FloatArray, _: FloatArray) -> FloatArray:
            # gradient of a(s²) (p_j − p_i) in Δ: 2 a' (p_j − p_i) Δᵀ
            velocity_difference = p[j] - p[i]
            if slope_kernel is None:
                if velocity_difference.any():
                    raise ArgumentError(
                        f"{type(self).__name__} gives no slope of its adjacency, which the Jacobian needs where the "
                        "velocities of neighbours differ: hand lift(...) an adjacency_slope, or give equal velocities"
                    )
                return np.zeros((i.size, q.shape[1], q.shape[1]))
            slope = slope_kernel(np.einsum("kc,kc->k", delta, delta), self.par)
            return 2.0 * slope[:, None, None] * velocity_difference[:, :, None] * delta[:, None, :]

        by_position = -stiffness * self.hessian(q, pairs)
        if damping:
            by_position = by_position - damping * self._assemble(q, consensus, pairs)
        return by_position, -damping * self.laplacian(q, pairs)

    @staticmethod
    def _stiffness_blocks(_i: Any, _j: Any, delta: FloatArray, terms: FloatArray) -> FloatArray:
        # gradient of w(s²) Δ in Δ: w I + 2 w' ΔΔᵀ
        w, slope = terms[0][:, None, None], terms[2][:, None, None]
        return w * np.eye(delta.shape[1]) + 2.0 * slope * delta[:, :, None] * delta[:, None, :]

    def _assemble(self, q: FloatArray, block_of: Any, pairs: Pairs | None = None) -> csr_array:
        """Return the sparse matrix assembled from one m × m block for each pair within range."""
        from scipy.sparse import csr_array

        n, m = q.shape
        matrices = []
        for i, j in pair_blocks(q, self.range) if pairs is None else pairs:
            delta = q[j] - q[i]
            if not self.coincidence:
                _ensure_apart(i, j, delta)
            matrices.append((i.copy(), j.copy(), block_of(i, j, delta, self.kernels.terms(q, i, j, self.par))))
        if not matrices:
            return csr_array((n * m, n * m))
        i, j, blocks = (np.concatenate(item) for item in zip(*matrices, strict=True))
        return pair_matrix(i, j, blocks, n)


def pair_matrix(i: Any, j: Any, blocks: FloatArray, n: int) -> csr_array:
    """Return the sparse matrix of ±B over distinct pairs: B on the two diagonal blocks, −B on the two others."""
    from scipy.sparse import bsr_array

    m = blocks.shape[-1]
    own_blocks = np.zeros((n, m, m))
    for end in (i, j):
        np.add.at(own_blocks, end, blocks)
    linked_agents = np.flatnonzero(np.bincount(np.concatenate([i, j]), minlength=n))
    rows, columns = np.concatenate([i, j, linked_agents]), np.concatenate([j, i, linked_agents])
    order = np.lexsort((columns, rows))
    starts = np.append(0, np.cumsum(np.bincount(rows, minlength=n)))
    values = np.concatenate([-blocks, -blocks, own_blocks[linked_agents]])[order]
    return bsr_array((values, columns[order], starts), shape=(n * m, n * m)).tocsr()


def _ensure_apart(i: Any, j: Any, delta: FloatArray) -> None:
    """Raise where two agents coincide and their force has no limit, nor a derivative."""
    coincident = np.flatnonzero(np.einsum("kc,kc->k", delta, delta) == 0.0)
    if coincident.size:
        raise ArgumentError(
            f"agents {i[coincident[0]]} and {j[coincident[0]]} are {np.linalg.norm(delta[coincident[0]]):g} apart: "
            "the pair law has no derivative there; expected distinct positions"
        )


_MOST_COUNTED = 1e140  # units of ℓ²: φ squares them


def ensure_lengths(law: Any, printed: str) -> None:
    """Check d, r, eps, unit and h of a σ-norm law, and that rounding keeps its σ-norms distinct, nonzero and finite."""
    normalise(law, ensure_positive, "d", "r", "eps", "unit")
    normalise(law, ensure_finite_scalar, "h")
    d, r, eps, unit = law.d, law.r, law.eps, law.unit
    if not 0.0 < law.h < 1.0:
        raise ArgumentError(f"h = {law.h:g}: expected 0 < h < 1; at h = 1 the bump jumps (erratum E10)")
    if r <= d:
        raise ArgumentError(f"r = {r:g} and d = {d:g}: expected r > d; the paper takes {printed}")
    near_norm, far_norm, area = sigma_norm(d * d, eps), sigma_norm(r * r, eps), unit * unit
    is_measurable = 0.0 < area < inf and near_norm / area > 0.0 and far_norm / area < _MOST_COUNTED
    if not (0.0 < near_norm < far_norm < inf and eps * r * r < inf and is_measurable):
        raise ArgumentError(
            f"d = {d:g}, r = {r:g}, eps = {eps:g}, unit = {unit:g}: their σ-norms are {near_norm:g} and {far_norm:g}; "
            "expected 0 < d_sigma < r_sigma, all finite: choose another length unit (flockana.rescale)"
        )
