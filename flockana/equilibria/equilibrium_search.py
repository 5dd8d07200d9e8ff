"""Distinct equilibria from many starts (random discs and lattice patches), found in parallel, ranked by energy."""

from collections.abc import Iterable, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, field
from functools import partial
from math import sqrt
from typing import Any

import numpy as np

from flockana.base.errors import ArgumentError, SolverError
from flockana.base.value_checks import FloatArray, ensure_known, ensure_points, ensure_positive
from flockana.equilibria.congruence import congruent
from flockana.equilibria.potential import Potential
from flockana.equilibria.solve import METHODS, Equilibrium, find_equilibrium
from flockana.measures.metrics import coincident_pairs

SAME = 1e-5  # of d: how closely two equilibria must agree to be one
_CONTACT = 1e-6  # of d
_TIE = 1e-14  # of force scale times length, for each pair: lattices of as many links have the same energy
_LEVEL = 1e-4  # of c1α ψ_α(r_α): energies this close may be those of one equilibrium


def random_starts(n: int, m: int, d: float, count: int, *, seed: int = 0, density: float = 1.3) -> list[FloatArray]:
    """Return random configurations of agents uniform in a ball, with `density` agents per volume d^m."""
    rng = np.random.default_rng([n, m, seed])
    volume = {1: 2.0, 2: np.pi, 3: 4.0 * np.pi / 3.0}[m]
    radius = d * (n / (ensure_positive("density", density) * volume)) ** (1.0 / m)
    starts = []
    for _ in range(count):
        direction = rng.standard_normal((n, m))
        direction /= np.linalg.norm(direction, axis=1, keepdims=True)
        starts.append(radius * direction * rng.uniform(size=(n, 1)) ** (1.0 / m))
    return starts


def lattice_starts(n: int, m: int, d: float, count: int, *, seed: int = 0, noise: float = 0.05) -> list[FloatArray]:
    """Return configurations grown agent by agent at random free sites of a lattice, then perturbed."""
    # Of three random free places the one with the most neighbours is taken: compact patches, but not the same each
    # time.
    rng = np.random.default_rng([n, m, seed, 1])
    face_centred = np.array([[1.0, 1, 0], [1, 0, 1], [0, 1, 1]]) / sqrt(2)
    basis = {1: np.eye(1), 2: np.array([[1.0, 0.0], [0.5, sqrt(0.75)]]), 3: face_centred}[m]
    cube = np.stack(np.meshgrid(*[np.arange(-1, 2)] * m, indexing="ij"), -1).reshape(-1, m)
    steps = [tuple(step) for step in cube.tolist() if abs(np.linalg.norm(np.array(step) @ basis) - 1.0) < 1e-9]

    def beside(site: tuple[int, ...]) -> list[tuple[int, ...]]:
        """Return the neighbouring sites of a lattice site."""
        return [tuple(a + b for a, b in zip(site, step, strict=True)) for step in steps]

    starts = []
    for _ in range(count):
        cells: set[tuple[int, ...]] = {(0,) * m}
        while len(cells) < n:
            free_sites = sorted({neighbour for site in cells for neighbour in beside(site)} - cells)
            tried_sites = [free_sites[k] for k in rng.integers(len(free_sites), size=3)]
            cells.add(max(tried_sites, key=lambda site: sum(neighbour in cells for neighbour in beside(site))))
        sites = np.array(sorted(cells), dtype=float) @ basis
        starts.append(d * (sites + noise * rng.standard_normal((n, m))))
    return starts


@dataclass(frozen=True)
class Distinct:
    """Equilibrium found by a search, with the number of starts that ended there."""

    equilibrium: Equilibrium  # the first of those that are the same but for a rigid motion and the numbering
    count: int  # how many starts ended there
    coincident: int  # pairs of its agents at one place


@dataclass(frozen=True)
class Search:
    """Distinct equilibria reached from many starts."""

    # distinct equilibria, lowest energy first; degenerate ones are distinguished by their energy only
    found: tuple[Distinct, ...]
    starts: int  # how many starts there were
    failures: tuple[str, ...] = field(default=(), repr=False)  # messages of the solves that found nothing

    @property
    def best(self) -> Equilibrium:
        """Equilibrium of lowest energy among those found by a search."""
        if not self.found:
            raise SolverError(
                f"none of {self.starts} starts led to an equilibrium; the first failure: {self.failures[:1]}"
            )
        return self.found[0].equilibrium


def _attempt(law: Any, method: str, start: FloatArray) -> Equilibrium | str:
    try:
        return find_equilibrium(law, start, method=method)
    except SolverError as failure:
        return str(failure)


def search(law: Any, starts: Iterable[Any], *, method: str = "minimise", executor: Executor | None = None) -> Search:
    """Find the distinct equilibria reached from many starts."""
    ensure_known("method", method, METHODS)
    points = [ensure_points(f"starts[{k}]", start) for k, start in enumerate(starts)]
    if not points or any(point.shape != points[0].shape for point in points):
        raise ArgumentError(f"starts: expected at least one, all of one shape, got {sorted({p.shape for p in points})}")
    outcomes = list((executor.map if executor else map)(partial(_attempt, law, method), points))
    failures = tuple(outcome for outcome in outcomes if isinstance(outcome, str))
    return Search(distinct([item for item in outcomes if isinstance(item, Equilibrium)]), len(points), failures)


def distinct(equilibria: Sequence[Equilibrium]) -> tuple[Distinct, ...]:
    """Group equilibria up to translation, rotation, reflection and numbering, lowest energy first."""
    # Degenerate ones come in families (a hinge bends, a component drifts): those of equal energy and index are one.
    groups: list[list[Equilibrium]] = []
    for equilibrium in _by_energy(equilibria):
        potential = Potential(equilibrium.law)
        for group in reversed(groups):
            if equilibrium.energy - group[0].energy > _LEVEL * potential.gain * potential.pair.far_potential:
                groups.append([equilibrium])
                break
            if _same(group[0], equilibrium):
                group.append(equilibrium)
                break
        else:
            groups.append([equilibrium])
    contact_distance = Potential(equilibria[0].law).pair.length * _CONTACT if equilibria else 1.0
    return tuple(Distinct(group[0], len(group), coincident_pairs(group[0].q, contact_distance)) for group in groups)


def _by_energy(equilibria: Sequence[Equilibrium]) -> list[Equilibrium]:
    """Return equilibria with the lowest energy first; equal energies stay in the order of discovery."""
    if not equilibria:
        return []
    potential, n = Potential(equilibria[0].law), len(equilibria[0].q)
    tie_tolerance = _TIE * n * n * potential.force_scale * potential.pair.length
    energy_order = sorted(range(len(equilibria)), key=lambda k: equilibria[k].energy)
    ordered: list[list[int]] = []
    for k in energy_order:
        if ordered and equilibria[k].energy - equilibria[ordered[-1][0]].energy <= tie_tolerance:
            ordered[-1].append(k)
        else:
            ordered.append([k])
    return [equilibria[k] for group in ordered for k in sorted(group)]


def _same(first: Equilibrium, second: Equilibrium) -> bool:
    if (first.kind, first.index) != (second.kind, second.index):
        return False
    is_loose = bool(first.zero_modes or second.zero_modes)
    return is_loose or congruent(first.q, second.q, tol=SAME * Potential(first.law).pair.length)
