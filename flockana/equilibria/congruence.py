"""Congruence of configurations up to isometries and renumbering."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from flockana.base.value_checks import FloatArray

if TYPE_CHECKING:
    from scipy.spatial import KDTree

_FLAT = 1e-6  # share of the extent: a configuration this near to a line or plane counts as in it


def spectrum_of_distances(q: FloatArray) -> FloatArray:
    """Return all pairwise distances in rising order, nearly always distinct for incongruent configurations."""
    from scipy.spatial.distance import pdist

    return np.sort(pdist(q))


def congruent(first: FloatArray, second: FloatArray, *, tol: float) -> bool:
    """Return whether an isometry and a renumbering map one configuration to the other."""
    # Equal distance spectra are asked first; then the isometry is constructed, since different configurations can share
    # a spectrum.
    from scipy.spatial import KDTree
    from scipy.spatial.distance import cdist

    if first.shape != second.shape:
        return False
    if first.size and np.abs(spectrum_of_distances(first) - spectrum_of_distances(second)).max(initial=0.0) > 2.0 * tol:
        return False
    x, y = first - first.mean(axis=0), second - second.mean(axis=0)
    frame = _frame(x)
    distances, tree = cdist(y, y), KDTree(y)
    target, norms = cdist(x[frame], x[frame]), np.linalg.norm(x[frame], axis=1)
    candidates = [np.flatnonzero(np.abs(np.linalg.norm(y, axis=1) - norm) <= 2.0 * tol) for norm in norms]
    return any(_maps(x, y, frame, image, tree, tol) for image in _images(candidates, distances, target, 4.0 * tol))


def _frame(x: FloatArray) -> list[int]:
    """Return up to m agents with independent positions about the centre, the farthest first."""
    from scipy.linalg import qr

    triangle, order = qr(x.T, mode="r", pivoting=True)
    magnitudes = np.abs(np.diag(triangle))
    return [int(k) for k, size in zip(order, magnitudes, strict=False) if size > _FLAT * magnitudes[0]]


def _images(candidates: list[Any], distances: FloatArray, wanted: FloatArray, tol: float) -> list[tuple[int, ...]]:
    """Return all tuples of agents whose distances from the centre and from each other are the given ones."""
    images: list[tuple[int, ...]] = [()]
    for k, options in enumerate(candidates):
        images = [
            (*image, int(agent))
            for image in images
            for agent in options
            if all(abs(distances[agent, image[e]] - wanted[k, e]) <= tol for e in range(k))
        ]
    return images


def _maps(x: FloatArray, y: FloatArray, frame: list[int], image: tuple[int, ...], tree: KDTree, tol: float) -> bool:
    """Return whether the isometry that maps given agents of x to given agents of y maps all of x to y."""
    # The frame spans x, so the map is fixed where it matters: what it does across a flat x moves nothing.
    u, _, vt = np.linalg.svd(x[frame].T @ y[list(image)])
    distance, nearest = tree.query(x @ u @ vt)
    return bool(np.max(distance) <= 10.0 * tol) and _one_to_one(nearest, y, tol)


def _one_to_one(nearest: Any, y: FloatArray, tol: float) -> bool:
    """Return whether a map of positions preserves the number of agents at each position."""
    from scipy.spatial import KDTree

    if np.unique(nearest).size == len(nearest):
        return True
    place = np.array([min(group) for group in np.atleast_1d(KDTree(y).query_ball_point(y, 20.0 * tol)).tolist()])
    return bool(np.array_equal(np.bincount(place[nearest], minlength=len(y)), np.bincount(place, minlength=len(y))))
