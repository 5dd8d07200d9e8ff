"""Bases of subspaces of motions."""

from typing import Any

import numpy as np

NEUTRAL = 1e-9  # of the stiffness of its agents: a rigid motion that meets no more than that is neutral


def complement(basis: Any) -> Any:
    """Return an orthonormal basis of the orthogonal complement."""
    if basis.shape[1] == 0:
        return np.eye(basis.shape[0])
    return np.linalg.svd(basis, full_matrices=True)[0][:, basis.shape[1] :]
