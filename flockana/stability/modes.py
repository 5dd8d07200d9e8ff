"""Modes of δq'' + D δq' + K δq = 0: shape, decay rate and frequency of each; zero modes separate.

The motions that cost nothing span an invariant subspace that is known beforehand, and so does the centre of mass where
it moves by itself. Both are taken out exactly, by the left eigenvectors, before any eigenvalue is computed: a zero
comes out as 0, and a double one does not smear over ±√(rounding).
"""

from __future__ import annotations

from cmath import sqrt
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from flockana.base.errors import SolverError
from flockana.base.value_checks import ComplexArray, FloatArray
from flockana.equilibria.curvature import EPS
from flockana.equilibria.final_state import rigid_motions
from flockana.stability.eigenvalue_errors import eigen_of_one, root_error, slowest_first
from flockana.stability.mode_names import name_kernel, normalised, pure_fields, translations
from flockana.stability.strong_components import IndexArray, StrongComponents, strong_components
from flockana.stability.zero_modes import ZERO, Kernel, Quotient, Split, agent_scales, joined_kernel, kernel_of, split

_HUGE = 1e100  # answer of followers that is too long to be squared
_SYMMETRIC = 1e-10  # relative
_PURE = 0.99  # cosine to a rotation or a uniform expansion from which on a mode is named for it


@dataclass(frozen=True)
class Mode:
    """Mode of a flock near equilibrium: Re(shape · exp(eigenvalue t)).

    Parameters
    ----------
    eigenvalue : complex
        λ, per time unit; of a conjugate pair the one with Im λ >= 0.
    shape : ndarray, shape (n, m)
        Displacements of the agents, of unit length together; complex where agents pass their extremes at different
        times, and then turned so that the real part is as large as can be.
    name : str
        "translation x", "rotation", "breathing" where the shape is that, else a number: 1 is the slowest.
    error : float
        How far rounding may have moved the eigenvalue.

    Examples
    --------
    >>> swing = Mode(-0.3 + 0.4j, np.ones((1, 1)), "1")
    >>> swing.decay_rate, swing.frequency, swing.natural_frequency, swing.damping_ratio, swing.decays
    (0.3, 0.4, 0.5, 0.6, True)
    """

    eigenvalue: complex
    shape: npt.NDArray[Any] = field(repr=False)
    name: str
    error: float = field(default=0.0, repr=False)

    @property
    def decay_rate(self) -> float:
        """Decay rate −Re λ, per time unit; negative for a growing mode."""
        return -self.eigenvalue.real

    @property
    def decays(self) -> bool:
        """Return whether the mode decays, beyond rounding."""
        return self.decay_rate > self.error

    @property
    def frequency(self) -> float:
        """Frequency Im λ, in radians per time unit; 0 without oscillation."""
        return abs(self.eigenvalue.imag)

    @property
    def natural_frequency(self) -> float:
        """Natural frequency |λ|, in radians per time unit."""
        return abs(self.eigenvalue)

    @property
    def damping_ratio(self) -> float:
        """Damping ratio −Re λ/|λ|: 1 without oscillation; NaN for a zero mode."""
        return self.decay_rate / abs(self.eigenvalue) if self.eigenvalue else float("nan")


class Invariant(NamedTuple):
    """Invariant subspace, right and left (2nm, r), of the zero modes and of a separate centre of mass.

    `chains` counts the zero modes along which a velocity persists (Jordan blocks), `drifting` names those that are
    a zero mode of their own, `neutral` (2nm, k + chains) spans all that does not decay nor grow but as a drift.
    """

    zero: tuple[Mode, ...]
    translational: tuple[Mode, ...]
    eigenvalues: ComplexArray
    right: FloatArray
    left: FloatArray
    kernel: FloatArray
    cokernel: FloatArray
    chains: int
    drifting: tuple[str, ...]
    neutral: FloatArray


class SecondOrder:
    """The quadratic eigenproblem (λ² + λ D + K) v = 0 at a configuration."""

    def __init__(
        self, q: FloatArray, stiffness: Any, damping: Any, *, zero: float = ZERO, scales: FloatArray | None = None
    ) -> None:
        self.q, self.stiffness, self.damping, self.zero = q, stiffness, damping, zero
        self.scales = agent_scales(stiffness, q.shape[1]) if scales is None else scales
        self.scale = float(abs(stiffness).sum(axis=1).max()) or 1.0
        self.damping_scale = float(abs(damping).sum(axis=1).max()) or 1.0
        fastest = max(sqrt(self.scale).real if abs(stiffness).max() else 0.0, float(abs(damping).sum(axis=1).max()))
        self.pace = float(2.0 ** np.round(np.log2(fastest))) if fastest else 1.0

    @cached_property
    def symmetric(self) -> bool:
        """Return whether K and D are symmetric up to rounding."""
        return all(abs(part - part.T).max() <= _SYMMETRIC * abs(part).max() for part in (self.stiffness, self.damping))

    @cached_property
    def split(self) -> Split:
        """Return the decoupling of centre of mass and shape, with its coupling error."""
        return split(self.stiffness, self.damping, self.q.shape[1])

    @cached_property
    def net(self) -> StrongComponents | None:
        """Strongly connected components; None if there is one, K and D are symmetric or the centre decouples."""
        if self.symmetric or self.split.exact:
            return None
        net = strong_components(self.stiffness, self.damping)
        return net if len(net) > 1 else None

    @cached_property
    def parts(self) -> tuple[SecondOrder, ...]:
        """Quadratic eigenproblems of the strongly connected components; empty for one component."""
        return tuple(self._part(rows) for rows in self.net.indices) if self.net else ()

    def _part(self, rows: IndexArray) -> SecondOrder:
        """Return the quadratic eigenproblem of a component, of whole agents or of single coordinates."""
        m = self.q.shape[1]
        agents = np.unique(rows // m)
        q = self.q[agents] if agents.size * m == rows.size else np.zeros((rows.size, 1))
        blocks = (matrix.tocsr()[rows][:, rows] for matrix in (self.stiffness, self.damping))
        return SecondOrder(q, *blocks, zero=self.zero, scales=self.scales[rows])

    @cached_property
    def kernel(self) -> Kernel:
        """Kernels of K, without the split motion of the centre (dense)."""
        if self.net:
            parts = [
                kernel_of(part.stiffness.toarray(), part.scales, self.zero, symmetric=part.symmetric)
                for part in self.parts
            ]
            return joined_kernel(self.stiffness.tocsr(), self.net, parts, self.zero)
        stiffness = self.stiffness.toarray()
        if self.split.exact:
            unit = translations(*self.q.shape)
            beyond = max(1.0, 2.0 * self.zero) * self.scale  # than what counts as zero, for they are dealt with alone
            away = beyond - self.split.stiffness
            stiffness = stiffness + unit * away @ unit.T
        return kernel_of(stiffness, self.scales, self.zero, symmetric=self.symmetric)

    @cached_property
    def invariant(self) -> Invariant:
        """Return the invariant subspace of the modes treated apart, from the whole kernel of K (dense)."""
        zero_subspace = self._zero_subspace(self.kernel.right, self.kernel.left)
        if not self.net:
            return zero_subspace
        zeros = 2 * self.q.size - sum(int(np.count_nonzero(component.eigenvalues)) for component in self.parts)
        values = np.zeros(zeros, dtype=np.complex128)
        return zero_subspace._replace(eigenvalues=values, chains=zeros - len(zero_subspace.zero))

    @cached_property
    def rigid_invariant(self) -> Invariant:
        """Return zero modes and the others apart, of a sparse flock all of whose zero modes are rigid motions."""
        rigid = rigid_motions(self.q)
        if self.split.exact:
            unit = translations(*self.q.shape)
            remaining_directions, sizes, _ = np.linalg.svd(rigid - unit @ (unit.T @ rigid), full_matrices=False)
            rigid = remaining_directions[:, sizes > 0.5]
        kernels = []
        for matrix in (self.stiffness, self.stiffness.T):
            image, terms = matrix @ rigid, float((abs(matrix) @ np.abs(rigid)).max(initial=0.0))
            _, sizes, rows = np.linalg.svd(image, full_matrices=False)
            kernels.append(rigid @ rows[sizes <= self.zero * terms].T)
        if kernels[0].shape != kernels[1].shape:
            raise SolverError("a rigid motion has no stiffness but is no left eigenvector of K: use the dense modes")
        return self._zero_subspace(*kernels)

    @cached_property
    def modes(self) -> tuple[Mode, ...]:
        """Return all modes off the zero modes, slowest first, one for each real eigenvalue or conjugate pair."""
        values, vectors, errors = self._others
        is_upper = values.imag >= 0.0
        return self.named(values[is_upper], vectors[:, is_upper], errors[is_upper], self.invariant.translational)

    @property
    def stable(self) -> bool:
        """Return whether every mode off the zero modes decays beyond rounding; True without such modes."""
        return all(mode.decays for mode in self.modes)

    @cached_property
    def eigenvalues(self) -> ComplexArray:
        """Return all 2nm eigenvalues, the largest real part first; those of zero modes are exactly 0."""
        rest = [part.eigenvalues[part.eigenvalues != 0.0] for part in self.parts] if self.net else [self._others[0]]
        whole = np.concatenate([self.invariant.eigenvalues, *rest])
        return whole[np.lexsort((whole.imag, abs(whole.imag), -whole.real))]

    def local_modes(self) -> list[tuple[float, int, Mode]]:
        """Return the modes of the components by rising decay rate: (rate, component number, mode)."""
        ranked_modes = [(mode.decay_rate, k, mode) for k, part in enumerate(self.parts) for mode in part.modes]
        return sorted(ranked_modes, key=lambda one: one[:2])

    def spread(self, k: int, mode: Mode) -> ComplexArray:
        """Return a mode of component k extended to all coordinates, with the response of components that hear it."""
        from scipy.sparse import csc_array, eye_array
        from scipy.sparse.linalg import splu

        assert self.net is not None
        shape: Any = np.zeros(self.q.size, np.complex128)
        rows, down = self.net.indices[k], self.net.downstream(k)
        shape[rows] = mode.shape.ravel()
        # where a follower has the same pole it answers without bound: a shift by the error shows its own mode alone
        s: Any = mode.eigenvalue + max(mode.error, EPS * self.pace)
        if s.imag == 0.0:
            s, shape = s.real, shape.real
        if down.size:
            heard = self.stiffness.tocsr()[down] + s * self.damping.tocsr()[down]
            try:
                solution = splu(csc_array(heard[:, down] + eye_array(down.size) * (s * s))).solve(-(heard @ shape))
            except RuntimeError:  # singular to the last bit
                solution = np.full(down.size, np.inf)
            if np.abs(solution).max() < _HUGE:
                shape[down] = solution
            else:
                self._follow_one_by_one(shape, s, k)
        return shape

    def _follow_one_by_one(self, shape: Any, s: complex, first: int) -> None:
        """Solve in turn for the response to a mode of each component after number `first`, into `shape`."""
        assert self.net is not None
        for rows in self.net.indices[first + 1 :]:
            coupling_block = self.stiffness.tocsr()[rows] + s * self.damping.tocsr()[rows]
            push = coupling_block @ shape
            if push.any():
                own_matrix = coupling_block[:, rows].toarray() + s * s * np.eye(rows.size)
                own_matrix += EPS * np.abs(own_matrix).max() * np.eye(rows.size)
                shape[rows] = -np.linalg.solve(own_matrix, push)
                shape /= np.abs(shape).max()

    @cached_property
    def _others(self) -> tuple[ComplexArray, ComplexArray, FloatArray]:
        """Return eigenvalues, displacements and rounding errors of the modes outside the invariant subspace."""
        if self.net:
            local = self.local_modes()
            shapes = [self.spread(k, mode) for _, k, mode in local]
            values, errors = (np.array([getattr(mode, x) for *_, mode in local]) for x in ("eigenvalue", "error"))
            shapes = [shape / np.abs(shape).max() for shape in shapes]
            return values.astype(np.complex128), np.array(shapes, np.complex128).reshape(len(local), -1).T, errors
        # Displacements are counted in units of velocity over `pace`, so that A has one unit and no entry is large for
        # the user's choice of a time unit.
        left, size, pace = self.invariant.left.copy(), self.q.size, self.pace
        left[:size] /= pace
        apart, turn = left.shape[1], _orthogonal_factor(left)
        push = np.hstack([self.stiffness.toarray() / -pace, -self.damping.toarray()])
        full_matrix = np.vstack([np.eye(size, 2 * size, size) * pace, push])
        # A maps what is orthogonal to `left` into itself
        values, vectors, errors = eigen_of_one(turn("R", "N", turn("L", "T", full_matrix))[apart:, apart:])
        parts = (np.vstack([np.zeros((apart, len(values))), part]) for part in (vectors.real, vectors.imag))
        real, imaginary_part = (turn("L", "N", part)[:size] for part in parts)
        return values, real + 1j * imaginary_part, errors

    @cached_property
    def fastest_rate(self) -> float:
        """Largest modulus of the eigenvalues, which scales positions relative to velocities; 1 if all are 0."""
        return float(np.abs(self.eigenvalues).max(initial=0.0)) or 1.0

    @cached_property
    def quotient(self) -> Quotient:
        """Return the linear dynamics off the zero modes, of states modulo neutral motions (dense)."""
        return self.quotient_at(self.pace)

    def quotient_at(self, pace: float) -> Quotient:
        """Return the linear dynamics off the zero modes, with positions scaled by a given rate."""
        size, right = self.q.size, self.invariant.neutral.copy()
        if right.shape[1] != np.count_nonzero(self.eigenvalues == 0.0):
            raise SolverError("zero modes come in chains longer than two here: their quotient is not known")
        right[:size] *= pace
        basis = np.linalg.qr(right, mode="complete")[0][:, right.shape[1] :]
        force = np.hstack([self.stiffness.toarray() / -pace, -self.damping.toarray()]) @ basis
        return Quotient(basis[:size].T @ (pace * basis[size:]) + basis[size:].T @ force, basis, force, pace)

    def named(self, values: Any, vectors: Any, errors: Any, others: tuple[Mode, ...]) -> tuple[Mode, ...]:
        """Return named modes from eigenvalues and displacements, merged in order with `others`."""
        fields = pure_fields(self.q)
        modes = list(others)
        for value, vector, error in zip(values.tolist(), vectors.T, np.asarray(errors).tolist(), strict=True):
            shape = normalised(vector, real=complex(value).imag == 0.0)
            near = [name for name, field in fields if abs(np.vdot(field, shape)) >= _PURE]
            modes.append(Mode(complex(value), shape.reshape(self.q.shape), near[0] if near else "", error))
        order = slowest_first(np.array([mode.eigenvalue for mode in modes]), np.array([mode.error for mode in modes]))
        modes = [modes[k] for k in order]
        return tuple(mode if mode.name else replace(mode, name=str(k)) for k, mode in enumerate(modes, start=1))

    def _zero_subspace(self, kernel: FloatArray, cokernel: FloatArray) -> Invariant:
        """Return the subspace of generalised eigenvectors at 0 and the motion of the centre of mass."""
        k = kernel.shape[1]
        names, kernel = name_kernel(kernel, self.q)
        drag = cokernel.T @ (self.damping @ kernel)  # a zero mode is semisimple iff D pushes it out of the range of K
        terms = np.abs(cokernel).T @ (abs(self.damping) @ np.abs(kernel))  # of which that is the sum
        rows, columns = (
            np.where(x > 0.0, x, 1.0) for x in (terms.max(axis=1, initial=0.0), terms.max(axis=0, initial=0.0))
        )
        rows, columns = np.sqrt(rows)[:, None], np.sqrt(columns)
        u, sizes, vt = np.linalg.svd(drag / rows / columns) if k else (drag, np.zeros(0), drag)
        flat = sizes <= self.zero
        on, off = (
            x / np.linalg.norm(x, axis=0) for x in (kernel @ (vt[flat] / columns).T, cokernel @ (u[:, flat] / rows))
        )
        zero_like = np.zeros_like
        right = [np.vstack([kernel, zero_like(kernel)]), np.vstack([self._against(on), on])]
        b = self._against(off, transposed=True)
        neutral = list(right)
        left = [np.vstack([self.damping.T @ cokernel, cokernel]), np.vstack([off + self.damping.T @ b, b])]
        is_undamped = np.abs(drag).max(axis=0, initial=0.0) <= self.zero * columns**2
        drifting = [name for name, slow in zip(names, is_undamped.tolist(), strict=True) if slow]
        zero = [Mode(0j, vector.reshape(self.q.shape), name) for name, vector in zip(names, kernel.T, strict=True)]
        chains = int(flat.sum())
        values: list[complex] = [0j] * (k + chains)
        translational: list[Mode] = []
        if self.split.exact:
            unit = translations(*self.q.shape)
            errors = self.split.errors
            free = np.abs(self.split.stiffness) <= errors[0]
            slow = np.where(free & (np.abs(self.split.damping) <= errors[1]), 0.0, self.split.damping)
            fields = [column.reshape(self.q.shape) for column in unit.T]
            labels = [f"translation {axis}" for axis in "xyz"[: len(fields)]]
            for stiff, drag_, name, shape in zip(
                np.where(free, 0.0, self.split.stiffness).tolist(), slow.tolist(), labels, fields, strict=True
            ):
                roots = _roots(stiff, drag_, errors)
                values += roots
                squares = (root for root in roots if root != 0.0 and root.imag >= 0.0)
                translational += [Mode(root, shape, name, root_error(root, stiff, drag_, errors)) for root in squares]
            alone = free & (slow == 0.0)
            chains += int(alone.sum())
            drifting += [name for name, item in zip(labels, alone, strict=True) if item]
            zero = [*(Mode(0j, fields[c], labels[c]) for c in np.flatnonzero(free)), *zero]
            kernel, cokernel = (np.hstack([unit[:, free], basis]) for basis in (kernel, cokernel))
            blank = np.zeros_like(unit)
            both = [np.vstack([unit, blank]), np.vstack([blank, unit])]
            right, left = [*right, *both], [*left, *both]
            neutral += [both[0][:, free], both[1][:, alone]]
        known = tuple(zero), tuple(translational), np.array(values, dtype=np.complex128)
        spaces = np.hstack(right), np.hstack(left), kernel, cokernel
        return Invariant(*known, *spaces, chains, tuple(sorted(drifting)), np.hstack(neutral))

    def _against(self, motion: FloatArray, *, transposed: bool = False) -> FloatArray:
        """Return the displacement x whose stiffness force balances the damping of a motion: K x = −D motion."""
        matrix, damping = (self.stiffness.T, self.damping.T) if transposed else (self.stiffness, self.damping)
        push = damping @ motion
        if not push.size or np.abs(push).max() <= self.zero * float((abs(damping) @ np.abs(motion)).max()):
            return np.zeros_like(motion)
        return -np.linalg.lstsq(matrix.toarray(), push, rcond=self.zero)[0]


def _orthogonal_factor(basis: FloatArray) -> Callable[[str, str, FloatArray], FloatArray]:
    """Return a function that multiplies by the orthogonal Q or Qᵀ of a basis' QR factorisation."""
    # Q is never formed: a few reflections cost a few passes over what they act on.
    from scipy.linalg.lapack import dgeqrf, dormqr

    if not basis.shape[1]:
        return lambda side, how, x: x
    factors, scales = dgeqrf(basis)[:2]

    def turn(side: str, how: str, x: FloatArray) -> FloatArray:
        return dormqr(side, how, factors, scales, x, 64 * max(x.shape))[0]

    return turn


def _roots(stiffness: float, damping: float, errors: tuple[float, float]) -> list[complex]:
    """Return both roots of λ² + damping λ + stiffness = 0, zero first, double where errors allow it."""
    if stiffness == 0.0:
        return [0j, complex(0.0 - damping)]
    radicand = damping**2 - 4.0 * stiffness
    spread = sqrt(0.0 if abs(radicand) <= 2.0 * abs(damping) * errors[1] + 4.0 * errors[0] else radicand)
    far_root = -0.5 * (damping + spread) if damping >= 0.0 else -0.5 * (damping - spread)
    return [far_root, stiffness / far_root]
