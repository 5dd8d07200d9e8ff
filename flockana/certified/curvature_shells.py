"""Lower bounds of the radial curvature of U about an orbit of equilibria, shell by shell.

Let w be orthogonal to the orbit's tangent at x*, Σ w_i = 0, and t = ‖w‖. If ⟨w, ∇²U(x* + s w) w⟩ >= k_i t² wherever
s t lies in the shell (t_{i−1}, t_i], then along the segment, ∇U(x*) being 0,

    ⟨∇U, w⟩ >= t G'(t),   U − U* >= G(t),   ⟨∇U, w⟩ − (U − U*) >= t G'(t) − G(t),

G'' = k_i in the i-th shell, G(0) = G'(0) = 0. The least of G'/t and of (t G' − G)/t² are at ends of shells, for they
are monotone within each; and G >= ½λt² where G' >= λt.

The k_i come from lower bounds of each pair's second derivative, uniform over all displacements up to a length.

Let e be the relative displacement of a pair at rest at Δ, of length ℓ0 and direction u, and f(Δ + e) = F(|Δ + e|).
Sought are numbers α ("along") and β ("across") with

    ⟨e, ∇²f(Δ + e) e⟩ >= α ⟨u, e⟩² + β (|e|² − ⟨u, e⟩²)        for all |e| <= η.

Only the direction in which the pair has been displaced counts, which costs in β the square of η/ℓ0 and not its first
power. With ℓ = |Δ + e|, x = ℓ − ℓ0 and b = 1 − cos of the angle by which the pair has turned,

    left − right = d0 + d1 b + d2 b²,    |e|² = x² + 2 ℓ ℓ0 b,
    d0 = (F'' − α) x²,   d1 = 2x (F'' ℓ0 + α ℓ) + 2 (T ℓ0² − β ℓ²),   d2 = F'' ℓ0² − α ℓ² − T ℓ0² + β ℓ²,

F'' and T = F'/ℓ at ℓ: of one length ℓ and of b in [0, (η² − x²)/(2 ℓ ℓ0)]. Lengths are cut into cells, and these again
where their enclosures are too wide. (`proofs/certified_basins.py` checks the identity.)
"""

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from itertools import pairwise
from typing import Any

import numpy as np
from flint import arb, arb_mat, fmpq

from flockana.base.value_checks import FloatArray
from flockana.certified.balls import ball, dot, hull, square
from flockana.certified.decimal_rounding import round_down
from flockana.certified.krawczyk import column, identity, least_eigenvalue
from flockana.certified.structural_potential import Balls, Structure, outer

LEVELS = 4  # cells of the first cut: 2^4 to either side, as many as there are shells
SHELLS = 2**LEVELS
_DEEPEST = 16
_POINTS = 801  # at which floating point looks
_SPARE = (0.03, 1e-5)  # of K (η/ℓ0)², and of K: margin that a proposed β keeps
ROOT_TWO = fmpq(14142136, 10**7)  # a little more than √2: |w_j − w_i| <= √2 ‖w‖
_ALIKE = 1e-7  # of d: pairs whose lengths agree so closely share one bound
_SLACKS = (0.03, 0.06, 0.12, 0.25, 0.5, 0.8)  # of K: by how much α may be less than the least F''
_LIFT = 10**7  # times the stiffest pair: curvature given to rigid motions, which are orthogonal to every w
_DIGITS = 4


@dataclass(frozen=True)
class LengthCells:
    """Cached enclosures of stiffness F'' and tension F'/ℓ of a pair over intervals of its length."""

    u: Structure
    rest: arb
    reach: fmpq
    kept: dict[tuple[int, int], tuple[arb, arb, arb]] = field(default_factory=dict, compare=False)

    def at(self, level: int, k: int) -> tuple[arb, arb, arb]:
        """Return (x, F'', T): change of length, stiffness and tension of a pair on one interval of lengths."""
        if (level, k) not in self.kept:
            unit = self.reach / 2**level
            x = ball(unit * k).union(ball(unit * (k + 1)))
            s = square(self.rest + x)
            self.kept[level, k] = x, self.u.stiffness(s), self.u.tension(s)
        return self.kept[level, k]

    def holds(self, shell: int, along: fmpq, across: fmpq) -> bool:
        """Return whether (α, β) certainly bound a pair's curvatures from below up to a shell."""
        cells = [(LEVELS, k) for k in range(-shell, shell)]
        limit = square(ball(self.reach * shell / SHELLS))
        while cells:
            level, k = cells.pop()
            if self._cell_holds(level, k, limit, ball(along), ball(across)):
                continue
            if level == _DEEPEST:
                return False
            cells += [(level + 1, 2 * k), (level + 1, 2 * k + 1)]
        return True

    def _cell_holds(self, level: int, k: int, limit: arb, along: arb, across: arb) -> bool:
        x, stiff, pull = self.at(level, k)
        rest, distance = self.rest, self.rest + x
        lower_end = (stiff - along).lower()  # by its ends: a product of balls about 0 would be far too wide
        d0 = lower_end * square(x.abs_lower() if lower_end >= 0 else x.abs_upper())
        d1 = 2 * x * (stiff * rest + along * distance) + 2 * (pull * square(rest) - across * square(distance))
        d2 = (stiff - pull) * square(rest) - (along - across) * square(distance)
        maximum = ((limit - square(x)).nonnegative_part() / (2 * distance * rest)).upper()
        slope = d1.lower() + d2.lower().min(arb(0)) * maximum  # d1 + d2 b >= slope for b in [0, most]
        return bool(d0 + slope.min(arb(0)) * maximum >= 0)


def proposed_across(along: float, rest: float, x: FloatArray, stiff: FloatArray, pull: FloatArray, eta: float) -> float:
    """Return a lower bound β of a pair's transverse curvature for a given axial bound α, unproved."""
    distance, unit = rest + x, max(float(np.abs(stiff).max()), abs(along))
    maximum = np.maximum((eta**2 - x**2) / (2.0 * distance * rest), 0.0)
    d1 = 2.0 * x * (stiff * rest + along * distance) + 2.0 * pull * rest**2
    d2 = np.minimum((stiff - pull) * rest**2 - along * distance**2, 0.0)
    is_positive = maximum > 0.0
    margin = (stiff - along) * x**2 + maximum * (d1 + d2 * maximum)
    bound = np.min(margin[is_positive] / (maximum * distance**2 * (2.0 - maximum))[is_positive], initial=np.inf)
    bound = min(bound, float(pull[np.argmin(np.abs(x))]))
    return float(bound - _SPARE[0] * unit * (eta / rest) ** 2 - _SPARE[1] * unit)


def points(reach: float) -> FloatArray:
    """Return sample points of the length change of a pair, with the ends of all shells, denser near 0."""
    inner = np.linspace(-1.0, 1.0, _POINTS) ** 3
    shell_edges = np.arange(-SHELLS, SHELLS + 1) / SHELLS
    return reach * np.unique(np.concatenate([inner, shell_edges]))


@dataclass(frozen=True)
class Bond:
    """Group of pairs of agents of nearly equal length that are or may come in range."""

    pairs: tuple[tuple[int, int], ...]
    rest: arb


@dataclass(frozen=True)
class ProposedBounds:
    """Unproved floating-point bounds of the curvatures of pairs and flock in each shell of a radius."""

    radius: float
    along: FloatArray
    across: FloatArray
    curvatures: FloatArray

    @property
    def mean(self) -> float:
        """Return the least of the mean curvatures over the first 1, 2, … shells."""
        return float(np.min(np.cumsum(self.curvatures) / np.arange(1, SHELLS + 1)))


class BondTable:
    """Pairs about an enclosed equilibrium, grouped by length, and matrices of their curvature bounds."""

    def __init__(self, law: Any, u: Structure, rest: Balls) -> None:
        self.law, self.u, self.rest = law, u, rest
        self.gaps = {(i, j): (gap, s.sqrt()) for i, j, gap, s in u.pairs(rest)}

    def bonds(self, reach: fmpq) -> list[Bond]:
        """Return pairs grouped by length, without the pairs that stay out of range."""
        groups: list[list[tuple[int, int]]] = []
        last_length, length_tolerance = -np.inf, _ALIKE * self.law.alpha.d
        for pair in sorted(self.gaps, key=lambda pair: float(self.gaps[pair][1])):
            distance = self.gaps[pair][1]
            if distance - ball(reach) > ball(self.u.par.r):
                continue
            if float(distance) > last_length + length_tolerance:
                groups.append([])
                last_length = float(distance)
            groups[-1].append(pair)
        return [Bond(tuple(group), hull(*(self.gaps[pair][1] for pair in group))) for group in groups]

    @cached_property
    def lifts(self) -> arb_mat:
        """Return Σ g gᵀ/‖g‖² over the rigid motions g, times a large number, to shift their eigenvalues."""
        total = arb_mat(len(self.rest), len(self.rest))
        largest_stiffness = max(abs(float(self.u.stiffness(distance**2).mid())) for _, distance in self.gaps.values())
        for motion in self.u.rotation_tangents(self.rest) + self.u.translations():
            g = column(motion)
            total += g * g.transpose() * (_LIFT * arb(largest_stiffness) / dot(motion, motion))
        return total

    def matrix(self, bonds: Sequence[Bond], along: Sequence[Any], across: Sequence[Any]) -> arb_mat:
        """Return c1γ 1 + Σ [α uuᵀ + β (1 − uuᵀ)] over pairs, with the eigenvalues of rigid motions shifted far up."""
        blocks = []
        for bond, a, b in zip(bonds, along, across, strict=True):
            for pair in bond.pairs:
                gap, distance = self.gaps[pair]
                blocks.append((*pair, outer(gap, ball(b), (ball(a) - ball(b)) / distance**2)))
        return self.u.assembled(blocks) + self.lifts

    def curvature(self, bonds: Sequence[Bond], along: Sequence[Any], across: Sequence[Any]) -> arb:
        """Return a lower bound of ⟨w, M w⟩/‖w‖² for the matrix M of given bounds, w ⊥ rigid motions."""
        total = self.matrix(bonds, along, across)
        shift = 2 * max(sum(map(abs, row), arb(0)).upper() for row in (total - self.lifts).tolist())
        eigenvalue = least_eigenvalue(total + identity(total.nrows()) * shift)
        return arb("-inf") if eigenvalue is None else (eigenvalue - shift).lower()

    def proposed(self, radius: float) -> ProposedBounds:
        """Return curvature bounds for all shells of a radius, found in floating point and not yet proved."""
        reach = float(ROOT_TWO.p) / float(ROOT_TWO.q) * radius
        bonds = self.bonds(fmpq(*reach.as_integer_ratio()))
        x = points(reach)
        lengths = [float(bond.rest) for bond in bonds]
        curves = [self._curves(distance + x) for distance in lengths]
        along_part, transverse_part, fixed_part = self._parts(bonds)
        shape = (SHELLS, len(bonds))
        along, across, curvatures = np.empty(shape), np.empty(shape), np.empty(SHELLS)
        for i in range(SHELLS):
            eta = reach * (i + 1) / SHELLS
            is_inside = np.abs(x) <= eta * (1.0 + 1e-12)
            near = [(rest, *(curve[is_inside] for curve in line)) for rest, line in zip(lengths, curves, strict=True)]
            curvatures[i] = -np.inf
            for slack in _SLACKS:
                a = [float(stiff.min()) - slack * float(np.abs(stiff).max()) for _, stiff, _ in near]
                b = [proposed_across(y, r, x[is_inside], k, t, eta) for y, (r, k, t) in zip(a, near, strict=True)]
                matrix = fixed_part + np.tensordot(a, along_part, 1) + np.tensordot(b, transverse_part, 1)
                lowest = np.min(np.linalg.eigvalsh(matrix), initial=np.inf)
                if lowest > curvatures[i]:
                    curvatures[i], along[i], across[i] = lowest, a, b
        return ProposedBounds(radius, along, across, curvatures)

    def _curves(self, length: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the stiffness F'' and the tension F'/ℓ of a pair at given lengths, in floating point."""
        alpha, gain = self.law.alpha, self.law.gains.c1_alpha
        root, z = np.sqrt(1.0 + alpha.eps * length**2), alpha.sigma_norm(length)
        action = alpha.phi_alpha(z)
        return gain * (alpha.phi_alpha_slope(z) * (length / root) ** 2 + action / root**3), gain * action / root

    def _parts(self, bonds: Sequence[Bond]) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return the coefficient matrices of each bond's α and β, and the constant matrix, off rigid motions."""
        dimension, m = len(self.rest), self.u.m
        motions = np.array([[float(y) for y in g] for g in self.u.rotation_tangents(self.rest) + self.u.translations()])
        basis = np.linalg.svd(motions, full_matrices=True)[2][len(motions) :]
        parts = np.zeros((2, len(bonds), len(basis), len(basis)))
        for k, bond in enumerate(bonds):
            for i, j in bond.pairs:
                gap = np.array([float(y) for y in self.gaps[i, j][0]])
                edge_rows = basis.reshape(-1, dimension // m, m)[:, j] - basis.reshape(-1, dimension // m, m)[:, i]
                axial_rows = edge_rows @ (gap / np.linalg.norm(gap))
                parts[0, k] += np.outer(axial_rows, axial_rows)
                parts[1, k] += edge_rows @ edge_rows.T - np.outer(axial_rows, axial_rows)
        gain = float(self.u.c1_gamma.p) / float(self.u.c1_gamma.q)
        return parts[0], parts[1], gain * np.eye(len(basis))


@dataclass(frozen=True)
class Shells:
    """Proved lower bounds k_i of the radial curvature of U in shells about an equilibrium's orbit.

    `along` and `across` hold, shell by shell, the α and β of every bond that the k_i were proved with.
    """

    radius: fmpq
    bonds: tuple[Bond, ...]
    along: tuple[tuple[fmpq, ...], ...]
    across: tuple[tuple[fmpq, ...], ...]
    curvatures: tuple[fmpq, ...]

    @property
    def slopes(self) -> tuple[fmpq, ...]:
        """Slopes G'(t_i) of the lower bound G of the energy at the outer radii t_i of the shells."""
        step, total = self.radius / SHELLS, fmpq(0)
        return tuple(total := total + k * step for k in self.curvatures)

    @property
    def level(self) -> fmpq:
        """Lower bound G(ρ) of U − U* on the sphere of the outermost shell's radius ρ."""
        step, slopes = self.radius / SHELLS, (fmpq(0), *self.slopes)
        return sum(((a + b) * step / 2 for a, b in pairwise(slopes)), fmpq(0))

    @property
    def curvature(self) -> fmpq:
        """Curvature λ = min G'(t)/t, for which ⟨∇U, w⟩ >= λ‖w‖² and U − U* >= ½ λ‖w‖²."""
        step = self.radius / SHELLS
        return min(slope / (step * (i + 1)) for i, slope in enumerate(self.slopes))

    @property
    def surplus(self) -> fmpq:
        """Surplus min (t G' − G)/t², a lower bound of (⟨∇U, w⟩ − (U − U*))/‖w‖², which may be negative."""
        step, total, surpluses = self.radius / SHELLS, fmpq(0), []
        for i, k in enumerate(self.curvatures):
            total += k * step**2 * ((i + 1) ** 2 - i**2) / 2
            surpluses.append(total / (step * (i + 1)) ** 2)
        return min(surpluses)


def prove(around: BondTable, floors: ProposedBounds) -> Shells | None:
    """Return proved curvature bounds from rounded-down proposals; None if one of them is not certain."""
    radius = round_down(arb(floors.radius), _DIGITS)
    reach = ROOT_TWO * radius
    bonds = around.bonds(reach)
    if len(bonds) != floors.along.shape[1]:
        return None
    cells = [LengthCells(around.u, bond.rest, reach) for bond in bonds]
    axial_bounds, transverse_bounds = (
        tuple(tuple(round_down(arb(y), _DIGITS) for y in row) for row in rows) for rows in (floors.along, floors.across)
    )
    curvatures = []
    for i, (a, b) in enumerate(zip(axial_bounds, transverse_bounds, strict=True), start=1):
        if not all(cell.holds(i, *pair) for cell, *pair in zip(cells, a, b, strict=True)):
            return None
        if not (curvature_bound := around.curvature(bonds, a, b)).is_finite():
            return None
        curvatures.append(round_down(curvature_bound, _DIGITS))
    return Shells(radius, tuple(bonds), axial_bounds, transverse_bounds, tuple(curvatures))
