"""Pair term as a LAMMPS table: energy and force at evenly spaced squared distances, and the table's error.

`pair_style table linear` interpolates the energy and the force over the distance linearly in the squared distance.
With as many points in the file as in the style, and the parameter RSQ, it takes the file's values as they are.
"""

from dataclasses import dataclass

import numpy as np

from flockana.base.value_checks import FloatArray
from flockana.laws.terms.pairs import PairTerm

KEYWORD = "PAIR"
_WITHIN = (0.125, 0.25, 0.5, 0.75, 0.875)  # where the error is looked at between two points
_BESIDE, _JUMP = 1e-9, 1e-6  # where a jump is looked for, in distances, and how large it is, in largest forces
_INNER, _INNER_SINGULAR = 1e-6, 0.25  # first distance: of the range, and of the length of a law that is infinite at 0


@dataclass(frozen=True, eq=False)
class PairTable:
    """Table of energy and force of a pair against its distance."""

    r: FloatArray  # shape (N,): distances, from the inner cutoff to the range; their squares are evenly spaced
    energy: FloatArray  # energy, force: shape (N,): potential, 0 at the range, and force, positive where it repels
    force: FloatArray
    # force_error, energy_error: Largest error of the linear interpolation between the points, but where the force jumps
    force_error: float
    energy_error: float
    # distances within at which the force jumps: there the table rises over one of its intervals
    jumps: tuple[float, ...]

    def text(self) -> str:
        """Return the file for `pair_coeff`: comment, keyword, parameters, and a line for each distance."""
        n, (inner, outer) = len(self.r), (float(self.r[0]), float(self.r[-1]))
        head = f"# UNITS: lj CONTRIBUTOR: flockana\n\n{KEYWORD}\nN {n} RSQ {inner!r} {outer!r}\n\n"
        rows = zip(self.r.tolist(), self.energy.tolist(), self.force.tolist(), strict=True)
        return head + "".join(f"{k} {r!r} {e!r} {f!r}\n" for k, (r, e, f) in enumerate(rows, 1))


def pair_table(term: PairTerm, points: int, inner: float) -> PairTable:
    """Tabulate a pair term's energy and force from an inner distance to the pair law's range."""
    outer = term.pair.range
    s2 = np.linspace(inner**2, outer**2, points)
    r = np.sqrt(s2)
    r[0], r[-1] = inner, outer
    energy, force = energy_and_force(term, r)
    shares = np.array(_WITHIN)[:, None]
    between = np.sqrt(s2[:-1] + shares * np.diff(s2))
    exact_energy, exact_force = (x.reshape(between.shape) for x in energy_and_force(term, between.ravel()))
    force_ratio = force / r
    read_force = (force_ratio[:-1] + shares * np.diff(force_ratio)) * between
    read_energy = energy[:-1] + shares * np.diff(energy)
    factors = np.array([1.0 - _BESIDE, 1.0 + _BESIDE])
    large = _JUMP * float(np.abs(force).max())
    inner_surfaces = [x for x in term.pair.surfaces if inner < x < outer]
    jumps = tuple(x for x in inner_surfaces if abs(np.diff(energy_and_force(term, x * factors)[1])[0]) > large)
    is_smooth = np.ones(points - 1, bool)
    is_smooth[np.searchsorted(r, jumps) - 1] = False
    errors = [np.abs(a - b)[:, is_smooth].max() for a, b in ((read_force, exact_force), (read_energy, exact_energy))]
    return PairTable(r, energy, force, float(errors[0]), float(errors[1]), jumps)


def inner_cutoff(term: PairTerm) -> float:
    """Return the first distance of a pair table: nearly 0, or a quarter of the length of a singular law."""
    is_bounded = bool(np.isfinite(term.pair.energy(np.zeros(1))).all())
    return _INNER * term.pair.range if is_bounded else _INNER_SINGULAR * term.pair.length


def energy_and_force(term: PairTerm, r: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return energy, 0 at the range, and force, positive for repulsion, of a pair at each distance."""
    pair = term.pair
    energy = term.stiffness * (pair.energy(r) - pair.far_potential)
    return energy, -term.stiffness * _pull_and_adjacency(term, r)[0]


def adjacency(term: PairTerm, r: FloatArray) -> FloatArray:
    """Return the weight a(r) of the velocity consensus at each distance up to the range."""
    return _pull_and_adjacency(term, r)[1]


def _pull_and_adjacency(term: PairTerm, r: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return (φ ‖n_ij‖, a_ij) at each distance, from many separate pairs."""
    n, reach = len(r), term.pair.range
    inner_distances = np.minimum(r, np.nextafter(reach, 0.0))  # at the range itself the limit from within
    q, p = np.zeros((2 * n, 2)), np.zeros((2 * n, 2))
    q[:, 1] = np.repeat(3.0 * reach * np.arange(n), 2)
    q[1::2, 0], p[1::2, 1] = inner_distances, 1.0
    u, _ = term.pair.forces(q, p, stiffness=1.0, damping=1.0)
    return u[::2, 0], u[::2, 1]
