"""Controllability of a flock through its informed agents: Popov-Belevitch-Hautus test, Gramians.

Lengths are counted in one unit throughout and times in that of the fastest motion, so that no result depends on the
user's units: x' = v, v' = −K x − D v + B u with forces u on the informed agents.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from math import inf
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from flockana.base.argument_kinds import check_kinds
from flockana.base.errors import ArgumentError, format_value
from flockana.base.value_checks import ComplexArray, FloatArray, ensure_fits, ensure_positive
from flockana.equilibria.curvature import EPS
from flockana.stability.eigenvalue_errors import eigenvalues
from flockana.stability.zero_modes import complement

if TYPE_CHECKING:
    from pandas import DataFrame

    from flockana.stability.linear_flock import LinearFlock

_ROUNDINGS = 64.0  # of eps N ‖A‖: singular values that count as 0
_SEARCHES = 4  # poles from which the distance to a flock that is not controllable is sought


class PoleReach(NamedTuple):
    """Controllability of one pole by forces on the informed agents: multiplicity, dimensions, strength.

    Attributes
    ----------
    pole : complex
        Per time unit.
    multiplicity : int
        How often the pole is an eigenvalue.
    independent : int
        Dimension of its left eigenspace: so many independent inputs it takes.
    reached : int
        Rank of the inputs on that space.
    strength : float
        Least gain from the inputs to a unit vector of that space; 0 where one is not reached.
    """

    pole: complex
    multiplicity: int
    independent: int
    reached: int
    strength: float

    @property
    def controllable(self) -> bool:
        """Return whether every eigenvector of the pole is reached."""
        return self.reached == self.independent


@dataclass(frozen=True, eq=False)
class Controllability:
    """Controllability of a linearised flock through forces on its informed agents.

    Parameters
    ----------
    informed : tuple of int
        Agents on which forces act.
    poles : tuple of PoleReach
        By distinct pole, the slowest first.
    horizon : float or None
        Time of the Gramian; None for ever, modulo the motions that nothing brings back.
    model : ScaledModel
        The flock in units of its fastest motion.
    """

    informed: tuple[int, ...]
    poles: tuple[PoleReach, ...]
    horizon: float | None
    model: ScaledModel = field(repr=False)

    @property
    def controllable(self) -> bool:
        """Return whether every motion of the flock can be steered."""
        return all(pole.controllable for pole in self.poles)

    @property
    def lost(self) -> tuple[PoleReach, ...]:
        """Poles that the informed agents do not fully reach."""
        return tuple(pole for pole in self.poles if not pole.controllable)

    @property
    def table(self) -> DataFrame:
        """Table of poles with reached dimensions and strengths, in pandas."""
        import pandas as pd

        return pd.DataFrame(self.poles, columns=list(PoleReach._fields))

    @cached_property
    def _nearest(self) -> tuple[float, complex]:
        weakest_first = sorted(self.poles, key=lambda one: one.strength)
        return distance_to_loss(self.model, self.informed, [one.pole for one in weakest_first])

    @property
    def distance(self) -> float:
        """Size of the least change of (A, B), in units of the fastest motion, that makes some motion uncontrollable.

        Found by local searches from the poles that are reached least: at most this, and 0 if one is lost already.
        """
        return 0.0 if self.lost else self._nearest[0]

    @cached_property
    def gramian(self) -> FloatArray:
        """Controllability Gramian in units of the fastest motion, over a finite or infinite horizon.

        Without a horizon its coordinates are those off the motions that nothing brings back; raises unless these decay.
        """
        return gramians(self.model, self.horizon, [self.informed])[0]

    @property
    def least_reach(self) -> float:
        """Smallest eigenvalue of the Gramian: the inverse energy of the most expensive unit motion."""
        return float(max(0.0, np.linalg.eigvalsh(self.gramian)[0]))


class ScaledModel(NamedTuple):
    """State matrix A of a flock in units of its fastest rate, that rate, the shape (n, m), neutral motions."""

    A: FloatArray
    pace: float
    shape: tuple[int, int]
    neutral: FloatArray

    def inputs(self, agents: Sequence[int]) -> FloatArray:
        """Return the input matrix B of forces on given agents."""
        n, m = self.shape
        columns = (np.asarray(agents)[:, None] * m + np.arange(m)).ravel()
        b = np.zeros((2 * n * m, len(columns)))
        b[n * m + columns, np.arange(len(columns))] = 1.0
        return b


def scaled_model(flock: LinearFlock) -> ScaledModel:
    """Return the first-order model of a linearised flock in units of its fastest rate, with neutral motions."""
    ensure_fits("A", flock.A_sparse.shape, "ask of fewer agents")
    k, d, pace = flock.stiffness.toarray(), flock.damping.toarray(), flock.second_order.fastest_rate
    zero, identity = np.zeros_like(k), np.eye(len(k))
    a = np.block([[zero, identity], [-k / pace**2, -d / pace]])
    kernel = flock.second_order.invariant.kernel
    _, singular_values, rows = np.linalg.svd(d @ kernel, full_matrices=False)
    drift = kernel @ rows[singular_values <= flock.zero * (float(np.abs(d).max()) or 1.0)].T
    rest_states, moving = np.vstack([kernel, 0.0 * kernel]), np.vstack([0.0 * drift, drift])
    return ScaledModel(a, pace, flock.q.shape, np.hstack([rest_states, moving]))


@check_kinds
def controllability(flock: LinearFlock, informed: Any, *, horizon: float | None = None) -> Controllability:
    """Return the controllability of a linearised flock by forces on the informed agents.

    A pole is controllable if no left eigenvector of it is orthogonal to the inputs (Hautus); of a multiple one that
    needs as many independent inputs as it has eigenvectors.

    Parameters
    ----------
    flock : Linearisation
        From `linearise`.
    informed : sequence of int
        Agents on which forces act.
    horizon : float, optional
        Time of the Gramian; by default for ever, off the motions that nothing brings back.

    Raises
    ------
    ArgumentError
        On agents that do not exist, or a horizon that is not positive.

    Examples
    --------
    Three agents in a row that hear their neighbours: from the middle the mode in which it rests is out of reach.

    >>> from flockana import NetConsensus
    >>> from flockana.stability import linearise
    >>> row = linearise(NetConsensus([[0, 1, 0], [1, 0, 1], [0, 1, 0]]), [[0.0], [0.0], [0.0]])
    >>> controllability(row, [0]).controllable, len(controllability(row, [1]).lost)
    (True, 2)
    """
    agents = ensure_agents("informed", informed, len(flock.q))
    if horizon is not None:
        horizon = ensure_positive("horizon", horizon)
    model = scaled_model(flock)
    b = model.inputs(agents)
    poles = [_reach(model, group, b) for group in pole_groups(model)]
    poles.sort(key=lambda one: (-one.pole.real, abs(one.pole.imag), one.pole.imag))
    return Controllability(agents, tuple(poles), horizon, model)


def ensure_agents(name: str, agents: Any, n: int) -> tuple[int, ...]:
    """Return distinct agent indices below n as a tuple; raise on none."""
    indices = np.atleast_1d(np.asarray(agents))
    if indices.ndim != 1 or not indices.size or indices.dtype.kind not in "iu":
        raise ArgumentError(f"{name} = {format_value(agents)}: expected numbers of agents, such as [0, 3]")
    if (indices < 0).any() or (indices >= n).any() or len(set(indices.tolist())) < len(indices):
        raise ArgumentError(f"{name} = {format_value(agents)}: expected different agents from 0 to {n - 1}")
    return tuple(indices.tolist())


class PoleGroup(NamedTuple):
    """Eigenvalues indistinguishable within rounding: their mean, number, and error."""

    value: complex
    size: int
    error: float


def pole_groups(model: ScaledModel) -> list[PoleGroup]:
    """Return the poles of a model, grouped where indistinguishable within rounding."""
    from scipy.sparse.csgraph import connected_components

    values, errors = eigenvalues(model.A)
    slack = np.maximum(errors, _ROUNDINGS * EPS * len(values) * float(np.linalg.norm(model.A, 2)))
    is_close = np.abs(values[:, None] - values) <= slack[:, None] + slack
    count, label = connected_components(is_close, directed=False)
    groups = []
    for k in range(count):
        is_in_group = label == k
        value, error = complex(values[is_in_group].mean()), float(slack[is_in_group].max())
        groups.append(PoleGroup(0j if abs(value) <= error else value, int(is_in_group.sum()), error))
    return groups


def _reach(model: ScaledModel, group: PoleGroup, b: FloatArray) -> PoleReach:
    left = left_eigenvectors(model.A, group)
    gains = np.linalg.svd(left.conj().T @ b, compute_uv=False)
    gains = np.concatenate([gains, np.zeros(max(0, left.shape[1] - gains.size))])
    edge = max(group.error, _ROUNDINGS * EPS * len(model.A))
    rank = int(np.sum(gains > edge))
    weakest = float(gains[-1]) if gains[-1] > edge else 0.0
    return PoleReach(group.value * model.pace, group.size, left.shape[1], rank, weakest)


def left_eigenvectors(a: FloatArray, group: PoleGroup) -> ComplexArray:
    """Return an orthonormal basis of the left eigenspace of a pole, as columns."""
    left, singular_values, _ = np.linalg.svd(a - group.value * np.eye(len(a)))
    is_null = singular_values <= kernel_edge(group, a)
    is_null[-1] = True  # it is an eigenvalue
    return left[:, is_null]


def kernel_edge(group: PoleGroup, a: FloatArray) -> float:
    """Return the threshold below which a singular value of A − λ counts as 0."""
    return max(2.0 * group.error, _ROUNDINGS * EPS * len(a) * float(np.linalg.norm(a, 2)))


def distance_to_loss(model: ScaledModel, agents: Sequence[int], poles: Sequence[complex]) -> tuple[float, complex]:
    """Return the distance to uncontrollability, the least σ of (A − s, B) in searches from poles, and s."""
    from scipy.optimize import minimize

    full_matrix = np.hstack([model.A, model.inputs(agents)])
    identity = np.eye(*full_matrix.shape)

    def least(x: FloatArray) -> float:
        return float(np.linalg.svd(full_matrix - complex(*x) * identity, compute_uv=False)[-1])

    least_loss = (inf, 0j)
    for pole in list(poles)[:_SEARCHES]:
        start = np.array([pole.real, pole.imag]) / model.pace
        result = minimize(least, start, method="Nelder-Mead", options={"xatol": 1e-10, "fatol": 1e-14, "maxiter": 200})
        least_loss = min(least_loss, (float(result.fun), complex(*result.x) * model.pace), key=lambda pair: pair[0])
    return least_loss


def gramians(model: ScaledModel, horizon: float | None, sets: Sequence[Sequence[int]]) -> list[FloatArray]:
    """Return the controllability Gramian of each set of agents, over a finite or infinite horizon."""
    from scipy.linalg import solve_continuous_lyapunov

    if horizon is not None:
        return _over_horizon(model, model.pace * horizon, sets)
    kept_basis = complement(model.neutral)
    a = kept_basis.T @ model.A @ kept_basis  # the neutral motions are invariant: dividing them out is exact
    values, errors = eigenvalues(a)
    if np.any(values.real >= -errors):
        raise ArgumentError(
            f"a motion does not decay (Re s = {float(values.real.max()) * model.pace:.3g}): expected a stable flock "
            "off its zero modes, or horizon=..., the time in which forces act"
        )
    pushes = (kept_basis.T @ model.inputs(agents) for agents in sets)
    return [_symmetric(solve_continuous_lyapunov(a, -b @ b.T)) for b in pushes]


def _over_horizon(model: ScaledModel, horizon: float, sets: Sequence[Sequence[int]]) -> list[FloatArray]:
    """Return ∫ e^(At) B Bᵀ e^(Aᵀt) dt by Van Loan's exponential of a short time, doubled."""
    from scipy.linalg import expm

    a, dimension = model.A, len(model.A)
    halvings = max(0, int(np.ceil(np.log2(max(1.0, horizon * float(np.linalg.norm(a, 2)))))))
    short, result = horizon / 2.0**halvings, []
    for agents in sets:
        b = model.inputs(agents)
        block = expm(short * np.block([[-a, b @ b.T], [np.zeros_like(a), a.T]]))
        step = block[dimension:, dimension:].T
        gramian = step @ block[:dimension, dimension:]
        for _ in range(halvings):
            gramian, step = gramian + step @ gramian @ step.T, step @ step
        result.append(_symmetric(gramian))
    return result


def _symmetric(matrix: Any) -> FloatArray:
    return 0.5 * (matrix + matrix.T)
