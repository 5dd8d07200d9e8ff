"""Blocks into which the matrices of a delayed flock fall together, as those of a symmetric lattice do.

Six types of motion under rotations and mirrors: the 74 coordinates of a hexagonal patch of 37 agents fall into blocks
of 13, 12 and four times 6, the first two of them twice. A generic sum of the matrices has eigenspaces in each of which
a block has a direction of its own, or none. From one direction the matrices lead to others, the strongest coupling
first, until nothing new is met: these span a block.
"""

from collections.abc import Sequence
from math import sqrt
from typing import Any

import numpy as np

from flockana.base.value_checks import FloatArray
from flockana.equilibria.curvature import EPS
from flockana.stability.strong_components import IndexArray

Four = tuple[FloatArray, FloatArray, FloatArray, FloatArray]

ROUNDINGS = 64.0  # of N eps: what counts as 0 in an entry of a matrix whose modes or blocks are taken
_PRECISE = 1e6  # times what counts as 0: parts of blocks that are smaller are not known well enough
_COUPLED = 1e-7  # relative: what couples directions by less, but by more than rounding, keeps the matrices whole
_LEFT = 0.1  # of a unit vector, beyond the blocks so far: enough to begin another with


def split_into_blocks(four: Four, *, neutral: bool = True) -> list[Four]:
    """Return the common diagonal blocks of K₀, D₀, K₁, D₁, each once, or these matrices if unsplit.

    Blocks are coupled by rounding at most (see `ROUNDINGS`). A part of a block that is 0 to rounding is 0; where one is
    so small beside the whole that rounding would matter in it, the four stay whole.

    Parameters
    ----------
    neutral : bool
        Whether some motions are held by nothing, so that a block's stiffness may be 0.

    Examples
    --------
    >>> pair, none = np.array([[2.0, 1.0], [1.0, 2.0]]), np.zeros((2, 2))  # of two agents
    >>> [round(k0.item(), 12) for k0, _, _, _ in split_into_blocks((pair, none, none, none))]
    [1.0, 3.0]
    """
    from scipy.linalg import block_diag

    sizes = [max(float(np.abs(four[k + i]).max()) for i in (0, 2)) for k in (0, 1)] * 2  # K₀ = K − K₁ is 0 to rounding
    rounding = ROUNDINGS * EPS * len(four[0])
    tolerances = [rounding * size for size in sizes]
    bases = _bases([x / np.abs(x).max() for x, small in zip(four, tolerances, strict=True) if np.abs(x).max() > small])
    if len(bases) < 2:
        return [four]
    blocks: list[Any] = [tuple(basis.T @ x @ basis for x in four) for basis in bases]
    rotation = np.column_stack(bases)
    is_square = rotation.shape == four[0].shape
    if not (is_square and np.abs(rotation.T @ rotation - np.eye(len(rotation))).max() <= rounding):
        return [four]
    for k, (x, tolerance) in enumerate(zip(four, tolerances, strict=True)):
        magnitudes = np.array([np.abs(block[k]).max() for block in blocks])
        if ((magnitudes > tolerance) & (magnitudes < _PRECISE * tolerance)).any():
            return [four]
        if np.abs(rotation.T @ x @ rotation - block_diag(*(block[k] for block in blocks))).max() > tolerance:
            return [four]
    blocks = [_without_rounding(block, tolerances) for block in blocks]
    if not neutral and not all((block[0] + block[2]).any() for block in blocks):
        return [four]
    return _different(blocks, tolerances)


def _without_rounding(block: Four, tolerances: list[float]) -> Any:
    """Return a block with zeros in place of parts that are 0 to rounding."""
    return tuple(x if np.abs(x).max() > small else 0.0 * x for x, small in zip(block, tolerances, strict=True))


def _different(blocks: list[Four], tolerances: list[float]) -> list[Four]:
    """Return the distinct blocks, one of each set of blocks that are equal within tolerances."""
    kinds: list[Four] = []
    for block in blocks:
        alike = [kind for kind in kinds if len(kind[0]) == len(block[0])]
        if not any(
            all(np.abs(x - y).max() <= small for x, y, small in zip(kind, block, tolerances, strict=True))
            for kind in alike
        ):
            kinds.append(block)
    return kinds


def _bases(parts: Sequence[FloatArray]) -> list[FloatArray]:
    """Return orthonormal bases of the subspaces that jointly block-diagonalise several matrices."""
    if not parts:
        return []
    values, vectors = np.linalg.eigh(sum((x + x.T) / sqrt(k + 2.0) for k, x in enumerate(parts)))
    starts = np.flatnonzero(np.append(True, np.diff(values) > _COUPLED * np.abs(values).max()))  # of eigenspaces
    rotated_parts = [vectors.T @ x @ vectors for x in parts]
    bases, covered = [], np.zeros((len(values), 0))
    for direction in np.eye(len(values)):
        remainder = direction - covered @ (covered.T @ direction)
        if np.linalg.norm(remainder) > _LEFT:
            block = _block_of(remainder / np.linalg.norm(remainder), rotated_parts, starts)
            covered = np.column_stack([covered, block])
            bases.append(vectors @ block)
    return bases


def _block_of(direction: FloatArray, parts: Sequence[FloatArray], starts: IndexArray) -> FloatArray:
    """Return a basis, by eigenspaces, of the invariant subspace that matrices generate from a direction.

    Where an eigenspace holds two directions of a block one may be missed: then the blocks are coupled, and not used.
    """
    basis, candidates = np.zeros((len(direction), 0)), direction.copy()  # the strongest of each eigenspace
    numbers = np.repeat(np.arange(len(starts)), np.diff(np.append(starts, len(direction))))  # of the eigenspaces
    while True:
        squares = np.add.reduceat(candidates**2, starts)
        if squares.max() <= _COUPLED**2 or basis.shape[1] == len(direction):
            return basis
        vector = np.where(numbers == squares.argmax(), candidates, 0.0)
        basis = np.column_stack([basis, vector / np.linalg.norm(vector)])
        columns = np.column_stack([candidates, *(x @ basis[:, -1] for x in parts)])
        for _ in range(2):  # once leaves rounding, which may be all of a small remainder
            columns -= basis @ (basis.T @ columns)
        best_columns = np.add.reduceat(columns**2, starts, axis=0).argmax(axis=1)
        candidates = columns[np.arange(len(columns)), best_columns[numbers]]
