"""Modes of δq'' + D δq' + K δq = 0: shape, decay rate and frequency of each; zero modes separate.

The motions that cost nothing span an invariant subspace that is known beforehand, and so does the centre of mass where
it moves by itself. Both are taken out exactly, by the left eigenvectors, before any eigenvalue is computed: a zero
comes out as 0, and a double one does not smear over ±√(rounding).
"""

from cmath import sqrt
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from flockana.base.checks import ComplexArray, FloatArray
from flockana.base.errors import SolverError
from flockana.equilibria.curvature import EPS
from flockana.equilibria.terminal import rigid_motions
from flockana.stability.mode_names import name_kernel, normalised, pure_fields, translations
from flockana.stability.rounding import eigen, root_error, slowest_first

ZERO = 1e-8  # of the largest row sum: what K does to a motion that costs nothing
_SPLIT = 1e-10  # relative: how much of the centre's motion may leak into the shape where the split is called exact
_SYMMETRIC = 1e-10  # relative
_PURE = 0.99  # cosine to a rotation or a uniform expansion from which on a mode is named for it
_ROUNDINGS = 8.0  # of eps √N times the largest row sum: rounding of sums that cancel


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
        """−Re λ, per time unit; negative if the mode grows."""
        return -self.eigenvalue.real

    @property
    def decays(self) -> bool:
        """Return whether the mode decays, beyond rounding."""
        return self.decay_rate > self.error

    @property
    def frequency(self) -> float:
        """Im λ, in radians per time unit: of the damped swing; 0 without one."""
        return abs(self.eigenvalue.imag)

    @property
    def natural_frequency(self) -> float:
        """|λ|, in radians per time unit."""
        return abs(self.eigenvalue)

    @property
    def damping_ratio(self) -> float:
        """−Re λ/|λ|: 1 of a mode that creeps back without a swing; NaN of a zero mode."""
        return self.decay_rate / abs(self.eigenvalue) if self.eigenvalue else float("nan")


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
        """Return whether centre and shape are decoupled."""
        return self.leak <= _SPLIT


def split(stiffness: Any, damping: Any, m: int) -> Split:
    """Look for the split into centre of mass and shape: K and D map translations to translations, and Kᵀ, Dᵀ do."""
    unit = translations(stiffness.shape[0] // m, m)
    own, leak, errors = [], 0.0, []
    for matrix in (stiffness, damping):
        size = float(abs(matrix).max()) or 1.0
        errors.append(_ROUNDINGS * EPS * sqrt(stiffness.shape[0]).real * float(abs(matrix).sum(axis=1).max()))
        block = unit.T @ (matrix @ unit)
        diagonal = np.diag(block)
        for image in (matrix @ unit, matrix.T @ unit):
            leak = max(leak, float(np.abs(image - unit * diagonal).max()) / size)
        own.append(diagonal)
    return Split(own[0], own[1], leak, (errors[0], errors[1]))


class Invariant(NamedTuple):
    """Invariant subspace of separated modes, right and left (2nm, r).

    `chains` counts the zero modes along which a velocity persists (Jordan blocks), `drifting` names those that are
    a zero mode of their own.
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


class SecondOrder:
    """The quadratic eigenproblem (λ² + λ D + K) v = 0 at a configuration."""

    def __init__(self, q: FloatArray, stiffness: Any, damping: Any, *, zero: float = ZERO) -> None:
        self.q, self.stiffness, self.damping, self.zero = q, stiffness, damping, zero
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
        """Return the split into centre of mass and shape, or the distance from one."""
        return split(self.stiffness, self.damping, self.q.shape[1])

    @cached_property
    def invariant(self) -> Invariant:
        """Return the separated modes from the whole kernel of K (dense)."""
        stiffness = self.stiffness.toarray()
        if self.split.exact:
            unit = translations(*self.q.shape)
            away = self.scale - self.split.stiffness  # translations are dealt with by themselves
            stiffness = stiffness + unit * away @ unit.T
        if self.symmetric:
            values, vectors = np.linalg.eigh(0.5 * (stiffness + stiffness.T))
            kernel = vectors[:, np.abs(values) <= self.zero * self.scale]
            return self._zero_subspace(kernel, kernel)
        left, sizes, right = np.linalg.svd(stiffness)
        flat = sizes <= self.zero * self.scale
        return self._zero_subspace(right[flat].T, left[:, flat])

    @cached_property
    def rigid_invariant(self) -> Invariant:
        """Return the separated modes if only rigid motions cost nothing (sparse)."""
        rigid = rigid_motions(self.q)
        if self.split.exact:
            unit = translations(*self.q.shape)
            rest, sizes, _ = np.linalg.svd(rigid - unit @ (unit.T @ rigid), full_matrices=False)
            rigid = rest[:, sizes > 0.5]
        kernels = []
        for matrix in (self.stiffness, self.stiffness.T):
            _, sizes, rows = np.linalg.svd(matrix @ rigid, full_matrices=False)
            kernels.append(rigid @ rows[sizes <= self.zero * self.scale].T)
        if kernels[0].shape != kernels[1].shape:
            raise SolverError("a rigid motion has no stiffness but is no left eigenvector of K: use the dense modes")
        return self._zero_subspace(*kernels)

    @cached_property
    def modes(self) -> tuple[Mode, ...]:
        """Return all modes off the zero modes, slowest first, one for each real eigenvalue or conjugate pair."""
        values, vectors, errors = self._others
        kept = values.imag >= 0.0
        return self.named(values[kept], vectors[:, kept], errors[kept], self.invariant.translational)

    @cached_property
    def eigenvalues(self) -> ComplexArray:
        """Return all 2nm eigenvalues, the largest real part first; zeros exact."""
        whole = np.concatenate([self.invariant.eigenvalues, self._others[0]])
        return whole[np.lexsort((whole.imag, abs(whole.imag), -whole.real))]

    @cached_property
    def _others(self) -> tuple[ComplexArray, ComplexArray, FloatArray]:
        """Return eigenvalues, displacements and rounding errors of the remaining modes."""
        # Displacements are counted in units of velocity over `pace`, so that A has one unit and no entry is large for
        # the user's choice of a time unit.
        left, size, pace = self.invariant.left.copy(), self.q.size, self.pace
        left[:size] /= pace
        apart, turn = left.shape[1], _orthogonal_factor(left)
        push = np.hstack([self.stiffness.toarray() / -pace, -self.damping.toarray()])
        whole = np.vstack([np.eye(size, 2 * size, size) * pace, push])
        # A maps what is orthogonal to `left` into itself
        values, vectors, errors = eigen(turn("R", "N", turn("L", "T", whole))[apart:, apart:])
        parts = (np.vstack([np.zeros((apart, len(values))), part]) for part in (vectors.real, vectors.imag))
        real, imag = (turn("L", "N", part)[:size] for part in parts)
        return values, real + 1j * imag, errors

    def named(self, values: Any, vectors: Any, errors: Any, others: tuple[Mode, ...]) -> tuple[Mode, ...]:
        """Return named modes from eigenvalues and displacements, with `others` among them, in order."""
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
        """Return generalised eigenvectors at 0 and the centre's own motion."""
        k = kernel.shape[1]
        names, kernel = name_kernel(kernel, self.q)
        drag = cokernel.T @ (self.damping @ kernel)  # a zero mode is semisimple iff D pushes it out of the range of K
        small = self.zero * self.damping_scale
        u, sizes, vt = np.linalg.svd(drag) if k else (drag, np.zeros(0), drag)
        flat = sizes <= small
        on, off = kernel @ vt[flat].T, cokernel @ u[:, flat]
        nothing = np.zeros_like
        right = [np.vstack([kernel, nothing(kernel)]), np.vstack([self._against(on), on])]
        b = self._against(off, transposed=True)
        left = [np.vstack([self.damping.T @ cokernel, cokernel]), np.vstack([off + self.damping.T @ b, b])]
        drifting = [name for name, column in zip(names, drag.T, strict=True) if np.abs(column).max() <= small]
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
                own = (root for root in roots if root != 0.0 and root.imag >= 0.0)
                translational += [Mode(root, shape, name, root_error(root, stiff, drag_, errors)) for root in own]
            alone = free & (slow == 0.0)
            chains += int(alone.sum())
            drifting += [name for name, one in zip(labels, alone, strict=True) if one]
            zero = [*(Mode(0j, fields[c], labels[c]) for c in np.flatnonzero(free)), *zero]
            kernel, cokernel = (np.hstack([unit[:, free], part]) for part in (kernel, cokernel))
            blank = np.zeros_like(unit)
            both = [np.vstack([unit, blank]), np.vstack([blank, unit])]
            right, left = [*right, *both], [*left, *both]
        spaces = np.hstack(right), np.hstack(left), kernel, cokernel, chains, tuple(sorted(drifting))
        return Invariant(tuple(zero), tuple(translational), np.array(values, dtype=np.complex128), *spaces)

    def _against(self, motion: FloatArray, *, transposed: bool = False) -> FloatArray:
        """Return x with K x = −D motion (Kᵀ x = −Dᵀ motion); 0 where D motion is 0."""
        matrix, damping = (self.stiffness.T, self.damping.T) if transposed else (self.stiffness, self.damping)
        push = damping @ motion
        if not push.size or np.abs(push).max() <= self.zero * self.damping_scale:
            return np.zeros_like(motion)
        return -np.linalg.lstsq(matrix.toarray(), push, rcond=self.zero)[0]


def _orthogonal_factor(basis: FloatArray) -> Callable[[str, str, FloatArray], FloatArray]:
    """Multiply by Q, or its transpose, whose first columns span the basis, from the left or right."""
    # Q is never formed: a few reflections cost a few passes over what they act on.
    from scipy.linalg.lapack import dgeqrf, dormqr

    if not basis.shape[1]:
        return lambda side, how, x: x
    factors, scales = dgeqrf(basis)[:2]

    def turn(side: str, how: str, x: FloatArray) -> FloatArray:
        return dormqr(side, how, factors, scales, x, 64 * max(x.shape))[0]

    return turn


def _roots(stiffness: float, damping: float, errors: tuple[float, float]) -> list[complex]:
    """Return both roots of λ² + damping λ + stiffness; zero first, double roots exactly double."""
    if stiffness == 0.0:
        return [0j, complex(0.0 - damping)]
    square = damping**2 - 4.0 * stiffness
    spread = sqrt(0.0 if abs(square) <= 2.0 * abs(damping) * errors[1] + 4.0 * errors[0] else square)
    far = -0.5 * (damping + spread) if damping >= 0.0 else -0.5 * (damping - spread)
    return [far, stiffness / far]
