"""Smallest and largest curvatures of a large flock, counted by factorisation.

Lanczos' method finds eigenvalues and may miss one; the signs of an elimination's pivots count them all. So those found
are held against the count, and more are asked for until what is not among them is surely positive.
"""

from functools import cached_property
from typing import Any

import numpy as np

from flockana.base.errors import SolverError
from flockana.base.value_checks import FloatArray
from flockana.equilibria.curvature import Landscape
from flockana.lattice.elimination import Elimination

_FEW, _MOST = 12, 400  # eigenvalues asked for at first and at last
_WHOLE = 6000  # n m up to which the whole spectrum is computed, in a minute, where a few eigenvalues decide nothing
_BELOW = 1e-7  # of the largest row sum: the shift below zero about which Lanczos' method looks
_GAP = 1e-9  # of the largest row sum: eigenvalues that differ by less cannot be separated


class LargeLandscape(Landscape):
    """Hessian of a large flock's potential, of which only smallest and largest eigenvalues are computed."""

    @cached_property
    def values(self) -> FloatArray:
        """Smallest eigenvalues of the Hessian off the rigid motions, rising, and its largest eigenvalue."""
        return self._extremes[0]

    @cached_property
    def vectors(self) -> FloatArray:  # noqa: D102
        return self._extremes[1]

    @cached_property
    def _extremes(self) -> tuple[FloatArray, FloatArray]:
        vector_count = max(_FEW, 2 * self._count(_BELOW * self.size))
        while vector_count <= _MOST:
            values, vectors = self._smallest(vector_count)
            gaps = np.diff(values[vector_count // 2 :])
            gap_index = vector_count // 2 + int(np.argmax(gaps))  # what is beyond the widest gap is not needed
            gap_middle = 0.5 * float(values[gap_index] + values[gap_index + 1])
            has_gap = gaps.max() > _GAP * self.size and gap_middle > self.rounding
            if has_gap and self._count(gap_middle) == gap_index + 1 and self._keeps_all(float(values[gap_index])):
                top, top_vectors = self._lanczos(lambda x: self._off_rigid(self.here @ self._off_rigid(x)), 1, "LA")
                return np.append(values, top), np.column_stack([vectors, top_vectors])
            vector_count *= 2
        if self.q.size <= _WHOLE:
            return super().values, super().vectors
        raise SolverError(
            f"more than {_MOST // 2} of the {self.q.size} curvatures are zero, negative, or not distinguishable from "
            "each other: too many to classify so large a flock; take its connected parts one by one"
        )

    def _count(self, bound: float) -> int:
        """Return the number of the Hessian's eigenvalues below a positive bound, rigid motions excluded."""
        return Elimination(self._shifted(-bound), self.q, keep=False).negative - int(self.rigid.shape[1])

    def _shifted(self, by: float) -> Any:
        from scipy.sparse import eye_array

        return (self.here + by * eye_array(self.q.size)).tocsr()

    def _off_rigid(self, x: FloatArray) -> FloatArray:
        """Return vectors less their projections on the rigid motions."""
        return x - self.rigid @ (self.rigid.T @ x)

    def _smallest(self, count: int) -> tuple[FloatArray, FloatArray]:
        """Return the Hessian's eigenvalues nearest to a shift below zero, rising, with their eigenvectors."""
        shift = _BELOW * self.size
        solve = Elimination(self._shifted(shift), self.q).solve
        return self._lanczos(lambda x: self._off_rigid(solve(self._off_rigid(x))), count, "LM")

    def _lanczos(self, act: Any, count: int, which: Any) -> tuple[FloatArray, FloatArray]:
        from scipy.sparse.linalg import ArpackError, LinearOperator, eigsh

        dimension = self.q.size
        operator: Any = LinearOperator((dimension, dimension), matvec=act, dtype=np.float64)
        start = self._off_rigid(np.random.default_rng(0).standard_normal(dimension))
        try:
            _, vectors = eigsh(operator, k=count, which=which, v0=start, ncv=min(dimension, 2 * count + 20))
        except ArpackError as error:
            raise SolverError(f"ARPACK found no {count} curvatures of {dimension} ({error})") from error
        vectors = np.linalg.qr(self._off_rigid(vectors))[0]
        values, turns = np.linalg.eigh(vectors.T @ (self.here @ vectors))
        return values, vectors @ turns
