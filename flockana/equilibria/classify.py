"""Classification of critical points by the Hessian's spectrum off the rigid motions."""

from typing import Literal, NamedTuple

import numpy as np

from flockana.base.errors import ArgumentError
from flockana.base.value_checks import FloatArray
from flockana.equilibria.curvature import Landscape, descent_direction
from flockana.equilibria.large_curvature import LargeLandscape
from flockana.equilibria.potential import Potential

EquilibriumKind = Literal["minimum", "saddle", "maximum", "degenerate"]

DENSE_SIZE = 3000  # n m: its whole spectrum takes seconds; beyond, the few eigenvalues that decide
MAX_SIZE = 60_000  # n m


class Spectrum(NamedTuple):
    """Hessian eigenvalues off the rigid motions, and numbers of rigid motions, negative and zero ones.

    Of a large flock the eigenvalues are some only, with all negative and zero ones and the largest among them.
    """

    eigenvalues: FloatArray
    rigid: int
    negative: int
    zero: int


def ensure_small(n: int, m: int, *, most: int = MAX_SIZE) -> None:
    """Raise if n agents in m dimensions are too many to compute an equilibrium within minutes."""
    if n * m > most:
        raise ArgumentError(f"n = {n} agents in m = {m} dimensions: expected n m <= {most}, or it takes many minutes")


def landscape(potential: Potential, q: FloatArray) -> Landscape:
    """Return the potential's second-order model about a configuration, with its residual force."""
    kind = Landscape if q.size <= DENSE_SIZE else LargeLandscape
    force, length_scale, unit = float(np.linalg.norm(potential.force(q))), potential.pair.length, potential.force_scale
    return kind(potential.stiffness, q, potential.symmetries(q), force=force, length=length_scale, unit=unit)


def spectrum(potential: Potential, q: FloatArray) -> Spectrum:
    """Return eigenvalues of the Hessian on the complement of the potential's rigid motions."""
    # What is zero there is a soft mode: a hinge that bends, a component that drifts; or a direction whose stiffness is
    # no larger than what rounding and the force that is left account for (see `flockana.equilibria.curvature`).
    local_landscape = landscape(potential, q)
    values, signs, _ = local_landscape.curvatures()
    return Spectrum(values, local_landscape.rigid.shape[1], int(np.sum(signs < 0)), int(np.sum(signs == 0)))


def falling(potential: Potential, q: FloatArray) -> FloatArray | None:
    """Return the unit direction (n, m) of the potential's lowest curvature; None if it is not negative."""
    local_landscape = landscape(potential, q)
    signs = local_landscape.curvatures().signs
    return descent_direction(local_landscape) if signs.size and signs[0] < 0 else None


def classify_spectrum(modes: Spectrum) -> EquilibriumKind:
    """Return the kind of a critical point: minimum, saddle, maximum or degenerate, from its spectrum."""
    if modes.negative:
        return "maximum" if modes.negative == modes.eigenvalues.size else "saddle"
    return "degenerate" if modes.zero else "minimum"
