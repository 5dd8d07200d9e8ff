"""Compiled form of a formula law: source text of its scalar functions, parameters, facts."""

from __future__ import annotations

from bisect import bisect_right
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache
from itertools import pairwise
from math import inf, isfinite, nan
from typing import TYPE_CHECKING, Any

import numpy as np

from flockana.base.errors import ArgumentError
from flockana.base.function_facts import PairFacts
from flockana.base.value_checks import FloatArray
from flockana.interactions.distance_functions import SlopeBound
from flockana.interactions.formula_near_zero import TERMS, NearZero, near_zero
from flockana.kernels.integral_tables import integral_panels, series_nodes, series_of

if TYPE_CHECKING:
    from flockana.symbolic.pair_formula import PiecewiseFormula

_KEPT = 64  # formulas
_GRID = 257  # distances at which the force is looked at
_SMALL = 1e-9  # of the strength: a jump below it is rounding of the parameters
_NARROW = 1e-13  # of the range: to which a sign change is located, or a pole
_NEAR, _FAR = 1e-12, 1e-8  # of the range: how far from a pole the force is read
_GROWN, _STEEP = 1e6, 1e3  # times the force on the grid, and times that farther away: so a pole grows, and no spike
_HALVINGS = 12  # of a panel
_TAIL = 4e-15  # last coefficients of a panel, relative to the strength, or to the largest where that is larger
_ROUGH = 1e-9  # the same, where halving no longer helps
_HEAD = 4  # r², ψ(r), ε, bound of the series; its coefficients follow if there is one
Texts = tuple[str, str, str, str, str | None]


@dataclass(frozen=True, eq=False)
class FormulaParts:
    """Formula with parameter values, ready for compilation (see `FormulaInteraction`)."""

    cut: PiecewiseFormula
    texts: Texts
    par: FloatArray
    panels: FloatArray
    surfaces: tuple[float, ...]
    seams: tuple[float, ...]
    strength: float
    coincidence: bool
    holds: bool
    looks: FloatArray
    zeros: tuple[tuple[float, bool], ...]  # distances at which the force changes its sign; whether it attracts beyond
    ends: tuple[str, ...]  # where the force is infinite within the range, and what jumps at its end, in words

    @cached_property
    def facts(self) -> PairFacts:
        """Facts proved of the formula over its whole range."""
        from flockana.symbolic.pair_facts import pair_facts

        facts = pair_facts(self.cut, float(self.par[2]), self.strength, float(np.abs(self.looks[1]).max()) or 1.0)
        return replace(facts, zeros=tuple(zero for zero, _ in self.zeros))

    def slopes(self, parts: int) -> tuple[SlopeBound, ...]:
        """Return bounds of the slopes of force and adjacency on parts of the range."""
        from flockana.symbolic.pair_facts import slope_bounds

        eps = float(self.par[2])
        bounds = slope_bounds(self.cut, eps, float(np.sqrt(self.par[0])), _places(self.cut, eps), parts)
        return tuple(SlopeBound(*bound) for bound in bounds)

    def same_as(self, other: FormulaParts, length: float, force: float, tolerance: float) -> bool:
        """Return whether two formula laws are the same in different units, compared on a grid."""
        mine, their_values = self.looks * np.array([[force], [1.0]]), other.looks
        threshold = np.nanmax(np.abs(mine), axis=1, keepdims=True) * tolerance
        gap = np.abs(mine - their_values)
        return bool(np.all((gap <= threshold + tolerance * np.abs(mine)) | (np.isnan(mine) & np.isnan(their_values))))


@lru_cache(maxsize=_KEPT)
def formula_parts(
    main: str, forces: bool, adjacency: str, r: float, d: float, parameters: tuple[tuple[str, float], ...]
) -> FormulaParts:
    """Return a pair-law formula with parameter values as source texts, kernel parameters and facts."""
    import sympy as sp

    from flockana.symbolic import pair_formula as pf

    names = tuple(name for name, _ in parameters)
    formula = pf.read_pair("" if forces else main, main if forces else "", adjacency, names)
    eps = dict(parameters).get("eps", nan) if formula.distance == pf.Z else 0.0
    if formula.distance == pf.Z and not eps > 0.0:
        raise ArgumentError(f"parameters['eps'] = {eps:g}: expected a number > 0, the ε of the σ-norm")
    length_values = {"r": r, "d": d, "r_z": _norm(r, eps), "d_z": _norm(d, eps)}
    parameter_values = {sp.Symbol(name, positive=True): value for name, value in length_values.items()}
    parameter_values |= {pf.EPS if name == "eps" else sp.Symbol(name, real=True): value for name, value in parameters}
    parameter_values.setdefault(pf.EPS, eps)
    cut = pf.PiecewiseFormula(formula, parameter_values, length_values["r_z"] if eps else r)
    view = _PreciseForce(cut, eps, r)
    near = near_zero(cut, view.y(r))
    view.look(d, unbounded=near.kind == "excluded")
    panels = _panels(cut, view, d) if forces else near.panels
    texts, constants = _texts(cut, near, forces=forces)
    far = float(panels[-1, 2:].sum()) if forces else view.energy(view.r)  # the potential at the range; of powers of 1
    far = far if forces or isfinite(far) else inf
    head = np.array([r * r, far, eps, near.bound, *near.coefficients])
    marks = np.array([view.of_mark(mark) for mark in cut.marks[1:-1]])
    par = np.concatenate([head, marks, [float(cut.value(constant)) for constant in constants]])
    if not np.isfinite(np.delete(par, 1)).all() or np.isnan(far):
        raise ArgumentError(f"{main!r} has a part that is not finite with these parameters: expected finite numbers")
    for array in (par, panels, view.looks):
        array.setflags(write=False)
    facts = tuple(sorted({*view.jumps(), r})), (*view.places, r), view.strength, near.kind != "excluded", view.holds(d)
    return FormulaParts(cut, texts, par, panels, *facts, view.looks, view.zeros(d), (*view.poles(), *view.ends()))


def _norm(x: float, eps: float) -> float:
    """Return the σ-norm of a length; the length itself without ε."""
    return x * x / (np.sqrt(1.0 + eps * x * x) + 1.0) if eps > 0.0 else x


def _places(cut: PiecewiseFormula, eps: float) -> list[float]:
    """Return the Euclidean distances at which pieces of the formula meet, between both ends."""
    return [float(np.sqrt(mark * (2.0 + eps * mark))) if eps else mark for mark in cut.marks[1:-1]]


class _PreciseForce:
    """Force of a formula as a function of the Euclidean distance, in high precision."""

    def __init__(self, cut: PiecewiseFormula, eps: float, r: float) -> None:
        self.cut, self.eps, self.r = cut, eps, r
        self._forces = [cut.function(piece.weight) for piece in cut.pieces]
        self._weights = [cut.function(piece.adjacency) for piece in cut.pieces]
        energies = [piece.potential for piece in cut.pieces]
        self._energies = [(lambda y: 0.0) if energy is None else cut.function(energy) for energy in energies]
        self.strength, self.looks, self.places = 0.0, np.zeros((2, 0)), _places(cut, eps)

    def y(self, s: float) -> float:
        """Return the formula's variable at a Euclidean distance s: its square s² or its σ-norm z."""
        return float(_norm(s, self.eps)) if self.eps else s * s

    def of_mark(self, mark: float) -> float:
        """Return s² or the σ-norm z at a boundary between pieces of the formula, given as s or z."""
        return mark if self.eps else mark * mark

    def piece(self, s: float) -> int:
        """Return the index of the formula's piece that applies at a distance."""
        return bisect_right(self.places, s)

    def force(self, s: float, piece: int | None = None) -> float:
        """Return the force at a distance, NaN where undefined."""
        return float(self._forces[self.piece(s) if piece is None else piece](self.y(s)) * s)

    def weight(self, s: float) -> float:
        """Return the adjacency at a distance."""
        return float(self._weights[self.piece(s)](self.y(s)))

    def energy(self, s: float) -> float:
        """Return the potential at a distance, 0 where the force was given."""
        return float(self._energies[self.piece(s)](self.y(s)))

    def look(self, d: float, *, unbounded: bool) -> None:
        """Sample the force and adjacency of a formula along the range; raise where they are not finite."""
        grid = np.linspace(0.0, self.r, _GRID)[1:-1]
        self.looks = np.array([[self.force(s) for s in grid], [self.weight(s) for s in grid]])
        energies = [self.energy(s) for s in grid]
        if not np.isfinite([*self.looks, energies]).all():
            at = grid[int(np.argmax(~np.isfinite([*self.looks, energies]).all(axis=0)))]
            raise ArgumentError(f"the formula has no finite real value at s = {at:g}: expected one below the range")
        poles = not isfinite(self.force(self.r, len(self.cut.pieces) - 1))
        is_usual = (grid >= (0.5 * d if unbounded else 0.0)) & (grid <= (0.9 * self.r if poles else self.r))
        self.strength = float(np.abs(self.looks[0][is_usual]).max()) or float(np.abs(self.looks[0]).max()) or 1.0

    def poles(self) -> tuple[str, ...]:
        """Return where the force grows without bound within the range, in words."""
        poles: list[str] = []
        grid, magnitudes = np.linspace(0.0, self.r, _GRID)[1:-1], np.abs(self.looks[0])
        for k in np.flatnonzero((magnitudes[1:-1] >= magnitudes[:-2]) & (magnitudes[1:-1] >= magnitudes[2:])) + 1:
            left, right, peak_size = float(grid[k - 1]), float(grid[k + 1]), float(magnitudes[k])
            while right - left > _NARROW * self.r:
                third_width = (right - left) / 3.0
                low, high = (abs(self.force(s)) for s in (left + third_width, right - third_width))
                left, right = (left + third_width, right) if low < high else (left, right - third_width)
            midpoint = 0.5 * (left + right)
            near_force, far_force = (abs(self.force(midpoint + share * self.r)) for share in (_NEAR, _FAR))
            if near_force > _GROWN * peak_size and near_force > _STEEP * far_force:
                poles.append(f"the force is infinite at s = {midpoint:.6g}, within the range")
        return tuple(poles)

    def zeros(self, d: float) -> tuple[tuple[float, bool], ...]:
        """Return the sign changes of the force on a grid of distances, and whether it attracts beyond each."""
        grid = np.linspace(0.0, self.r, _GRID)[1:-1]
        signed = [(float(s), float(f)) for s, f in zip(grid, self.looks[0], strict=True) if f != 0.0]
        changes = [(a, b, right > 0.0) for (a, left), (b, right) in pairwise(signed) if left * right < 0.0]
        places = (self._change_between(a, b, attracts=is_attractive) for a, b, is_attractive in changes)
        return tuple(
            (d if abs(s - d) <= 2.0 * _NARROW * self.r else s, up) for s, (*_, up) in zip(places, changes, strict=True)
        )

    def _change_between(self, left: float, right: float, *, attracts: bool) -> float:
        while right - left > _NARROW * self.r:
            midpoint = 0.5 * (left + right)
            left, right = (left, midpoint) if (self.force(midpoint) > 0.0) is attracts else (midpoint, right)
        return 0.5 * (left + right)

    def ends(self) -> tuple[str, ...]:
        """Return in words which quantities do not vanish at the range, where the law ends."""
        force = -self.force(self.r, len(self.cut.pieces) - 1)
        adjacency = float(self._weights[-1](self.y(self.r)))
        sizes = (force, self.strength, "the force"), (adjacency, float(np.abs(self.looks[1]).max()), "the adjacency")
        return tuple(
            f"{name} jumps from {value:.4g} to 0 at the range, s = {self.r:g}"
            for value, scale, name in sizes
            if isfinite(value) and abs(value) > _SMALL * scale
        )

    def holds(self, d: float) -> bool:
        """Return whether the force repels just below a distance and attracts just above it."""
        return d < self.r and self.force(d * (1.0 - 1e-3)) < 0.0 < self.force(min(d * (1.0 + 1e-3), 0.5 * (d + self.r)))

    def jumps(self) -> list[float]:
        """Return the boundaries between pieces of the formula at which the force jumps beyond rounding."""
        small_force = _SMALL * self.strength
        return [s for k, s in enumerate(self.places) if not abs(self.force(s, k) - self.force(s, k + 1)) <= small_force]


def _panels(cut: PiecewiseFormula, view: _PreciseForce, d: float) -> FloatArray:
    """Return Chebyshev panels of ψ from its derivative, with ψ = 0 at the desired distance."""
    inner = view.y(d) if view.eps else d
    rows, edges = [cut.function(piece.force) for piece in cut.pieces], sorted({*cut.marks, inner})

    def values(z: FloatArray) -> FloatArray:
        piece_numbers = np.searchsorted(cut.marks[1:-1], z, side="right")
        return np.array([float(rows[k](x if view.eps else x * x)) for k, x in zip(piece_numbers, z, strict=True)])

    panel_edges: list[float] = [0.0]
    for left, right in pairwise(edges):
        panel_edges += _resolved(values, left, right, view.strength, 0)
    return integral_panels(values, np.array(panel_edges), anchor=inner)


def _resolved(values: Any, left: float, right: float, scale: float, depth: int) -> list[float]:
    """Return right ends of intervals on which a function is a polynomial up to rounding."""
    samples = values(0.5 * (left + right) + 0.5 * (right - left) * series_nodes())
    is_refused, series = not np.isfinite(samples).all(), np.abs(series_of(np.nan_to_num(samples)))
    tail = series[-2:].max() / max(series.max(), scale)
    if is_refused or (depth >= _HALVINGS and tail > _ROUGH):
        raise ArgumentError("the force cannot be integrated within the range: expected the potential, by its formula")
    if depth >= _HALVINGS or tail <= _TAIL:
        return [right]
    midpoint = 0.5 * (left + right)
    halves = ((left, midpoint), (midpoint, right))
    return [edge for half_interval in halves for edge in _resolved(values, *half_interval, scale, depth + 1)]


def _texts(cut: PiecewiseFormula, near: NearZero, *, forces: bool) -> tuple[Texts, list[Any]]:
    """Return the source texts of a formula's force weight, slopes, potential and σ-norm, and constants."""
    from flockana.symbolic import pair_formula as pf
    from flockana.symbolic.code_printing import Constants, function_text

    in_norm = cut.formula.distance == pf.Z
    head = _HEAD + near.coefficients.size
    pieces, first = cut.pieces, head + len(cut.marks) - 2
    shared = Constants([pf.SQUARE, pf.Z, pf.ROOT], first)

    def each(name: str) -> list[Any]:
        return [shared.extract_constants(getattr(piece, name)) for piece in pieces]

    rows = [[each("weight"), each("adjacency")], [each("slope")], [each("adjacency_slope")]]
    if not forces:
        rows.append([each("potential")])
    floor = [] if near.kind == "excluded" else ["s2 = max(s2, par[0]*1e-60)"]  # a form 0/0 at 0 has its limit there
    norm = [*floor, "root = sqrt(1.0 + par[2]*s2)", "z = s2/(root + 1.0)"]
    square_lines = [*norm, "y = z"] if in_norm else [*floor, "y = s2"]
    marks = [f"m{k} = par[{head + k}]" for k in range(len(cut.marks) - 2)]

    def source_text(arguments: str, wanted: list[list[Any]], after: str, before: list[str] = square_lines) -> str:
        symbols = {symbol for row in wanted for value in row for symbol in value.free_symbols}
        names = (f"c{k}" for k in range(first, first + len(shared.values)))
        constants = [f"{name} = par[{name[1:]}]" for name in names if any(str(s) == name for s in symbols)]
        return function_text("NAME", arguments, [*before, *marks, *constants], wanted, after)

    weight, slope, energy = "v0", "v0", "v0"
    if near.kind == "series":
        inner = "0.5/(root*par[3])" if in_norm else "1.0/par[3]"
        weight, slope = (_horner(table_row, order) for table_row, order in (("v0", 0), ("v0", 1)))
        slope = slope.replace("UNIT", inner)
        energy = "(on_panels(y, panels) if y < par[3] else v0)"
    potential = (
        source_text("s2, par, panels", rows[3], f"par[1] if s2 >= par[0] else {energy}")
        if not forces
        else _integrated(in_norm)
    )
    pair = ("z, root, par", rows[0], f"{weight}, v1", ["y = z"]) if in_norm else ("s2, par", rows[0], f"{weight}, v1")
    texts = (
        source_text(*pair),
        source_text("s2, par", rows[1], slope),
        potential,
        source_text("s2, par", rows[2], "v0"),
        function_text("NAME", "s2, par", norm, [], "z, root") if in_norm else None,
    )
    return texts, shared.values


def _horner(otherwise: str, order: int) -> str:
    """Return the source text of the weight's power series near 0, or of its derivative."""
    terms = [f"{float(k)}*par[{4 + k}]" if order else f"par[{4 + k}]" for k in range(order, TERMS)]
    source_text = terms[-1]
    for term in reversed(terms[:-1]):
        source_text = f"{term} + (y/par[3])*({source_text})"
    return f"(({source_text}){'*UNIT' if order else ''} if y < par[3] else {otherwise})"


def _integrated(in_norm: bool) -> str:
    """Return the source text of a potential given by panels."""
    argument_text = "s2/(sqrt(1.0 + par[2]*s2) + 1.0)" if in_norm else "sqrt(s2)"
    return f"def NAME(s2, par, panels):\n    return par[1] if s2 >= par[0] else on_panels({argument_text}, panels)"
