"""Final state of a run: distance from equilibrium, links, second-order character."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from flockana.base.value_checks import FloatArray
from flockana.equilibria.curvature import EPS, Landscape, least_curvature
from flockana.laws import Algorithm1, Algorithm2, ensure_one_gain
from flockana.measures.centre_frame import moving_frame
from flockana.measures.metrics import coincident_pairs, connectivity, velocity_mismatch
from flockana.measures.nets import link_lengths, links

DENSE_LIMIT = 4000  # rows of a Hessian whose whole spectrum is still a matter of seconds
_ON_A_LINE = 1e-9  # of the flock's size: agents off a line by less count as on it, within a solver's accuracy
_ROUNDINGS = 8.0  # of the places, as stored far from the origin


@dataclass(frozen=True)
class TerminalState:
    """Geometry and second-order character of a configuration under Algorithm 1 or 2."""

    # largest force on an agent in the moving frame at zero relative velocity, over the force of the law's `scales`
    force: float
    mismatch: float  # K̃ = K/n
    strain: float  # largest |link − d|/d, NaN without links
    shortest: float  # shortest, longest: Link lengths, NaN without links
    longest: float
    links: int  # number of links
    coincident: int  # number of pairs closer than 1e-9 d
    connected: bool  # whether the net is connected
    # smallest Hessian eigenvalue of V (Algorithm 1) or U_λ (Algorithm 2) off the rigid motions, over the largest
    curvature: float
    # by how much rounding, and the way that the force left here still is from an equilibrium, may change it; infinite
    # where no equilibrium is near
    curvature_error: float
    # bound of the distance to the strict minimum beside this state, over all coordinates, over d; infinite where there
    # is none
    distance: float


def terminal_state(
    law: Algorithm1 | Algorithm2, q: FloatArray, p: FloatArray, *, contact: float = 1e-9
) -> TerminalState:
    """Return residual force, link lengths and Hessian off the rigid motions of a state."""
    if law.target is not None:
        ensure_one_gain(law.gains)
    alpha = law.alpha
    still = np.ascontiguousarray(np.broadcast_to(p.mean(axis=0), p.shape))
    forces = moving_frame(law.flow(0.0, q, still)[0])
    force = float(np.linalg.norm(forces, axis=1).max())
    distances = link_lengths(q, links(q, alpha.range))
    has_no_links = distances.size == 0
    landscape = surroundings(law, q, force=float(np.linalg.norm(forces)))
    curvature, error = least_curvature(landscape) if landscape else (float("nan"), float("inf"))
    return TerminalState(
        force=force / law.scales.force,
        mismatch=velocity_mismatch(p) / len(q),
        strain=float("nan") if has_no_links else float(np.abs(distances - alpha.length).max() / alpha.length),
        shortest=float("nan") if has_no_links else float(distances.min()),
        longest=float("nan") if has_no_links else float(distances.max()),
        links=int(distances.size),
        coincident=coincident_pairs(q, contact * alpha.length),
        connected=connectivity(q, alpha.range) == 1.0,
        curvature=curvature,
        curvature_error=error,
        distance=landscape.distance / alpha.length if landscape else float("inf"),
    )


def generators(m: int) -> list[FloatArray]:
    """Return the skew matrices of rotations in each coordinate plane."""
    identity = np.eye(m)
    return [np.outer(identity[a], identity[b]) - np.outer(identity[b], identity[a]) for a in range(m) for b in range(a)]


def rigid_motions(q: FloatArray) -> FloatArray:
    """Return an orthonormal basis of infinitesimal translations and rotations, shape (n m, k)."""
    n, m = q.shape
    x = moving_frame(q)
    magnitude = float(np.linalg.norm(x))
    motions = [np.broadcast_to(axis, (n, m)).ravel() / np.sqrt(n) for axis in np.eye(m)]
    motions += [(x @ generator.T).ravel() / (magnitude or 1.0) for generator in generators(m)]
    basis, singular_values, _ = np.linalg.svd(np.array(motions).T, full_matrices=False)
    # a flock that is on a line but for rounding has no rotation about it
    rounding = EPS * np.sqrt(n) * float(np.abs(q).max()) / magnitude if magnitude > 0.0 else 0.0
    return basis[:, singular_values > max(_ON_A_LINE, _ROUNDINGS * rounding)]


def surroundings(law: Any, q: FloatArray, *, force: float = 0.0) -> Landscape | None:
    """Return the structural potential's Hessian at a configuration as a `Landscape`; None if too large."""
    if q.size > DENSE_LIMIT:
        return None
    scales = law.scales
    return Landscape(law.stiffness, q, rigid_motions(q), force=force, length=scales.length, unit=scales.force)
