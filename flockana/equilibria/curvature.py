"""Signs of a potential's curvatures at a computed equilibrium, given rounding and the residual force.

Where a force ρ is left and the Hessian has the eigenvalue λ along v, the true critical point lies about ρ/|λ| away, and
the curvature that counts is the one there. So λ has a sign only if the stiffness keeps half of |λ| within twice that
distance,

    |vᵀ(H(q′) − H(q)) v| ≤ |λ|/2 for q′ up to δ = 2ρ/|λ| from q,

and counts as zero otherwise. If L is the Lipschitz constant of H along v, that reads |λ| ≥ √(4Lρ): the threshold is
the root of the residual times the law's own third derivative. It is stricter than λ² > 2Lρ, under which Newton's and
Kantorovich's theorem puts one critical point of that very sign next to q. A root is what is needed: where a link lets
go at r the force vanishes as (r − x)², so a solver that has taken it down to ρ stops √ρ short of r and finds a
stiffness of that size, of either side's sign. No number with a unit enters, and none that fits one law only.
"""

from collections.abc import Callable
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from flockana.base.errors import SolverError
from flockana.base.value_checks import FloatArray

EPS = float(np.finfo(np.float64).eps)
_ROUNDING = 8.0  # of eps √N ‖H‖: eigenvalues of a symmetric matrix come out to a few eps ‖H‖
_REACH = 0.05  # of the law's length: a critical point farther off than that is another one
_FREE = 1e-6  # norm below which a unit translation, minus its projection on the rigid motions, counts as one of them
_GROUP = 2.0  # eigenvalues within this factor are tried together


class Curvatures(NamedTuple):
    """Eigenvalues of a Hessian off the rigid motions, rising, with signs and a common rounding error."""

    values: FloatArray
    signs: npt.NDArray[np.int64]
    rounding: float


class Landscape:
    """Hessian of a potential at a configuration, off the rigid motions, with bounds of its variation nearby."""

    def __init__(
        self,
        stiffness: Callable[[FloatArray], Any],
        q: FloatArray,
        rigid: FloatArray,
        *,
        force: float,
        length: float,
        unit: float,
    ) -> None:
        self.stiffness, self.q, self.rigid, self.length = stiffness, q, rigid, length
        self.here = stiffness(q)
        self.size = _row_sum(self.here)
        if not np.isfinite(self.size):
            raise SolverError(
                "the potential's curvature is infinite here: expected a configuration without pairs at a kink of the "
                "force, and units in which forces and lengths are far from 1e±100 (fl.rescale)"
            )
        self.rounding = _ROUNDING * EPS * float(np.sqrt(q.size)) * max(self.size, unit / length)
        self.force = force + self.rounding * length  # what a few eps of a length or of a force amount to

    @cached_property
    def _matrix(self) -> FloatArray:
        """Hessian with the eigenvalues of rigid motions shifted beyond all others."""
        hessian: FloatArray = self.here.toarray()
        rigid = self.rigid
        deflated_hessian: Any = hessian - rigid @ (rigid.T @ hessian)
        deflated_hessian = deflated_hessian - (deflated_hessian @ rigid) @ rigid.T
        rigid_shift = 2.0 * self.size or 1.0
        return np.asarray(0.5 * (deflated_hessian + deflated_hessian.T) + rigid_shift * (rigid @ rigid.T))

    @cached_property
    def values(self) -> FloatArray:
        """Eigenvalues of the Hessian, rising, without those of rigid motions; all 0 if the Hessian is 0."""
        count = self.q.size - self.rigid.shape[1]
        return np.asarray(np.linalg.eigvalsh(self._matrix)[:count] if self.size else np.zeros(count))

    @cached_property
    def vectors(self) -> FloatArray:
        """Eigenvectors of the Hessian, as columns in the order of `values`, without rigid motions."""
        return np.linalg.eigh(self._matrix)[1][:, : self.values.size]

    def curvatures(self) -> Curvatures:
        """Return the Hessian's eigenvalues off the rigid motions, with signs that are 0 if undecidable."""
        magnitudes = np.abs(self.values)
        is_decided = np.zeros(magnitudes.size, dtype=bool)
        left = np.flatnonzero(magnitudes > self.rounding)
        if left.size and self._keeps_all(float(magnitudes[left].min())):
            is_decided[left], left = True, left[:0]
        while left.size:
            group = left[magnitudes[left] > magnitudes[left].max() / _GROUP]
            if 2.0 * self.force / float(magnitudes[group].min()) > _REACH * self.length:
                break  # and all smaller ones with it
            if self._keeps_all(float(magnitudes[group].min())):
                is_decided[group] = True
            else:
                is_decided[group] = [self.change(int(k)) <= 0.5 * magnitudes[k] for k in group]
            left = np.setdiff1d(left, group)
        signs = np.where(is_decided, np.sign(self.values), 0.0).astype(np.int64)
        return Curvatures(self.values, signs, self.rounding)

    def change(self, k: int) -> float:
        """Return by how much eigenvalue k may change up to the critical point; infinite if that is far."""
        reach = 2.0 * self.force / max(abs(float(self.values[k])), self.rounding or np.inf)
        if not reach <= _REACH * self.length:
            return float("inf")
        v = self.vectors[:, k]
        step = reach * v.reshape(self.q.shape)
        positions = [self.q + step, self.q - step, *self._around(reach)]
        return max(abs(float(v @ ((self.stiffness(x) - self.here) @ v))) for x in positions)

    @cached_property
    def distance(self) -> float:
        """Bound of the distance to the nearby minimum, over all coordinates; infinite if unknown."""
        values, signs, rounding = self.curvatures()
        if not values.size:
            return 0.0
        return 2.0 * self.force / (float(values[0]) - rounding) if np.all(signs > 0) else float("inf")

    def holds(self, energy: float) -> bool:
        """Return whether a flock with this kinetic energy stays near the minimum, if the energy never rises."""
        # Within a distance R up to which the stiffness keeps half of its least value λ, the potential rises by λR²/4
        # from the minimum, which is lower than here by no more than ρ²/λ.
        if not np.isfinite(self.distance):
            return False
        if not self.values.size:
            return True
        lowest_value = float(self.values[0])
        reach = 2.0 * float(np.sqrt((energy + self.force**2 / lowest_value) / lowest_value)) + self.distance
        return self._keeps(reach, lowest_value)

    def _keeps_all(self, least: float) -> bool:
        """Return whether no eigenvalue of size `least` or more changes by half up to the critical point."""
        return self._keeps(2.0 * self.force / least, least)

    def _keeps(self, reach: float, least: float) -> bool:
        """Return whether the Hessian changes by less than half of `least` within the distance `reach`."""
        if reach > _REACH * self.length:
            return False
        turned = 8.0 * reach / self.length * self.size  # links turn by as much; lengths are what `_around` changes
        return turned + max(_row_sum(self.stiffness(x) - self.here) for x in self._around(reach)) <= 0.5 * least

    def _around(self, reach: float) -> list[FloatArray]:
        """Return the configuration scaled up and down, and shifted if shifts change the potential."""
        # Every distance above half of `length` changes by √2 `reach` at least, as those of links may.
        (n, m), factor = self.q.shape, np.sqrt(8.0) * reach / self.length
        centre = self.q.mean(axis=0)
        positions = [centre + (1.0 + sign * factor) * (self.q - centre) for sign in (1.0, -1.0)]
        shifts = np.tile(np.eye(m), (n, 1))
        if np.abs(shifts - self.rigid @ (self.rigid.T @ shifts)).max() > _FREE:
            positions += [self.q + sign * reach * axis for axis in np.eye(m) for sign in (1.0, -1.0)]
        return positions


def least_curvature(landscape: Landscape) -> tuple[float, float]:
    """Return the smallest curvature relative to the largest, and its error from rounding and residual force."""
    # They are (NaN, ∞) where there is nothing but rigid motions, and (0, 0) where nothing is stiff at all.
    values = landscape.values
    if not values.size:
        return float("nan"), float("inf")
    largest = float(np.abs(values).max())
    if largest <= landscape.rounding:
        return 0.0, 0.0
    return float(values[0]) / largest, min((landscape.change(0) + 2.0 * landscape.rounding) / largest, float("inf"))


def descent_direction(landscape: Landscape) -> FloatArray:
    """Return the unit direction (n, m) of the potential's lowest curvature at a configuration."""
    # The same on every machine, in an eigenspace of several dimensions too: what a fixed vector has in it.
    is_lowest = landscape.values <= landscape.values[0] + 1e-6 * abs(landscape.values[0])
    basis = landscape.vectors[:, is_lowest]
    random_direction = np.random.default_rng(0).standard_normal(landscape.q.size)
    direction = basis @ (basis.T @ random_direction)
    return np.ascontiguousarray((direction / np.linalg.norm(direction)).reshape(landscape.q.shape))


def _row_sum(matrix: Any) -> float:
    """Return the largest row sum of absolute values, a bound of a symmetric matrix's norm."""
    return float(abs(matrix).sum(axis=1).max()) if matrix.shape[0] else 0.0
