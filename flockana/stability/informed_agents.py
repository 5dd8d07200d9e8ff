"""Choice of the agents to inform, by the states that forces on them reach."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import combinations
from math import comb, e
from typing import TYPE_CHECKING, Any

import numpy as np

from flockana.base.argument_kinds import check_kinds
from flockana.base.errors import ArgumentError
from flockana.base.value_checks import FloatArray, ensure_count, ensure_known, ensure_positive
from flockana.equilibria.curvature import EPS
from flockana.stability.controllability import (
    PoleGroup,
    ScaledModel,
    gramians,
    kernel_edge,
    left_eigenvectors,
    pole_groups,
    scaled_model,
)
from flockana.stability.zero_modes import complement

if TYPE_CHECKING:
    from flockana.stability.linear_flock import LinearFlock

CRITERIA = ("rank", "trace", "log det", "least reach")
_SUBMODULAR = ("rank", "trace", "log det")
_FLOOR = 1e-9  # of the largest eigenvalue of the Gramian of all agents: beside it nothing counts as reached
_RANK = 1e-9  # relative


@dataclass(frozen=True)
class InformedAgents:
    """Agents to inform, with the quality of the choice.

    Parameters
    ----------
    agents : tuple of int
        In the order in which they were chosen; rising after a search of all sets.
    criterion : str
        What was made as large as can be.
    value : float
        Its value: states that are reached, trace of the Gramian, log det(1 + Gramian/floor), or its least eigenvalue.
    exhaustive : bool
        Whether every set was tried, so that none is better.
    share : float
        Share of the best value that is reached at least: 1 after an exhaustive search, 1 − 1/e of a greedy one where
        the criterion has diminishing returns, else 0, unknown.
    """

    agents: tuple[int, ...]
    criterion: str
    value: float
    exhaustive: bool
    share: float


@check_kinds
def agents_to_inform(
    flock: LinearFlock, count: int, *, criterion: str = "log det", horizon: float | None = None, most: int = 20_000
) -> InformedAgents:
    """Return the agents from which forces reach most of a linearised flock.

    Parameters
    ----------
    flock : Linearisation
        From `linearise`.
    count : int
        Number of agents.
    criterion : {"log det", "rank", "trace", "least reach"}
        Of the Gramian: the volume that unit forces reach, the mean, or the least reach of all directions (which has no
        guarantee if the search is greedy); or the number of states that are reached at all.
    horizon : float, optional
        Time in which forces act; by default for ever, off the motions that nothing brings back.
    most : int
        Sets that are tried at most; where there are more, agents are added one by one, each the best.

    Examples
    --------
    Of five agents in a row the one at an end reaches all, the one in the middle does not:

    >>> from flockana import NetConsensus
    >>> from flockana.stability import linearise
    >>> row = np.eye(5, k=1) + np.eye(5, k=-1)
    >>> agents_to_inform(linearise(NetConsensus(row), np.zeros((5, 1))), 1, criterion="rank").agents
    (0,)
    """
    n, count = len(flock.q), ensure_count("count", count)
    if count > n:
        raise ArgumentError(f"count = {count}: expected at most {n}, the number of agents")
    ensure_known("criterion", criterion, CRITERIA)
    model = scaled_model(flock)
    if horizon is not None:
        horizon = ensure_positive("horizon", horizon)
    value = (
        _rank_of(model) if criterion == "rank" else _worth(gramians(model, horizon, [[i] for i in range(n)]), criterion)
    )
    is_exhaustive = comb(n, count) <= ensure_count("most", most)
    if is_exhaustive:
        best_agents = max(combinations(range(n), count), key=value)
        return InformedAgents(best_agents, criterion, value(best_agents), is_exhaustive, 1.0)
    informed_agents: tuple[int, ...] = ()
    for _ in range(count):
        informed_agents = max(((*informed_agents, i) for i in range(n) if i not in informed_agents), key=value)
    share = 1.0 if criterion == "trace" else 1.0 - 1.0 / e if criterion in _SUBMODULAR else 0.0
    return InformedAgents(informed_agents, criterion, value(informed_agents), is_exhaustive, share)


def _worth(each: Sequence[FloatArray], criterion: str) -> Callable[[Sequence[int]], float]:
    """Return a function that measures the summed controllability Gramian of a set of agents."""
    floor = _FLOOR * float(np.linalg.eigvalsh(sum(each[1:], each[0]))[-1])

    def value(agents: Sequence[int]) -> float:
        gramian = sum((each[i] for i in agents), np.zeros_like(each[0]))
        if criterion == "trace":
            return float(np.trace(gramian))
        eigenvalues = np.maximum(np.linalg.eigvalsh(gramian), 0.0)
        return float(np.log1p(eigenvalues / floor).sum()) if criterion == "log det" else float(eigenvalues[0])

    return value


def _rank_of(model: ScaledModel) -> Callable[[Sequence[int]], float]:
    """Return the number of states reached by forces on given agents, pole by pole with Krylov vectors."""
    n, m = model.shape
    all_inputs = model.inputs(range(n))
    reach_matrices = [_krylov(model.A, group, all_inputs) for group in pole_groups(model)]
    edges = [_RANK * max(float(np.abs(item).max()), EPS) for item in reach_matrices]

    def value(agents: Sequence[int]) -> float:
        columns = (np.asarray(agents)[:, None] * m + np.arange(m)).ravel()
        ranks = (
            np.linalg.matrix_rank(item[:, :, columns].reshape(len(item), -1), tol=edge)
            for item, edge in zip(reach_matrices, edges, strict=True)
        )
        return float(sum(ranks))

    return value


def _krylov(a: FloatArray, group: PoleGroup, b: FloatArray) -> Any:
    """Return WᴴB, (A − λ)WᴴB, … of the left invariant subspace W of one pole, shape (dimension, powers, inputs)."""
    shifted_matrix = a - group.value * np.eye(len(a))
    basis, rest, left = left_eigenvectors(a, group), np.eye(len(a)), np.zeros((len(a), 0))
    while True:  # a staircase: the left kernel, then that of what is left when it is divided out
        left = np.hstack([left, rest @ basis])
        if left.shape[1] >= group.size:
            break
        rest = rest @ complement(basis)
        u, singular_values, _ = np.linalg.svd(rest.conj().T @ shifted_matrix @ rest)
        basis = u[:, singular_values <= kernel_edge(group, a)]
        if not basis.shape[1]:
            break
    own_flow, push = left.conj().T @ shifted_matrix @ left, left.conj().T @ b
    powers = [push]
    for _ in range(left.shape[1] - 1):
        powers.append(own_flow @ powers[-1])
    return np.stack(powers, axis=1)
