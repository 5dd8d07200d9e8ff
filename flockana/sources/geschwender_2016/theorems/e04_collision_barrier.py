"""Erratum E4: H < c* excludes collisions, but no large flock has such a state; an alternative barrier."""

from math import sqrt

import numpy as np

from flockana.equilibria.energy_barrier import (
    bound_range,
    collision_barrier,
    collision_bounds,
    energy_floor,
    lattice_reach,
    least_infeasible_size,
)
from flockana.interactions import AlphaInteraction
from flockana.lattice import harborth, hexagonal_spiral
from flockana.theorems.theorem_toolkit import EPS, Claim, Tolerances, erratum, of_state

_SIZES = (3, 7, 10)  # of the barrier that is searched here; the larger ones take longer and change nothing
_STARTS = 8
_TRIANGLE = 3  # up to here all pairs can be in range, and the barrier is c* itself
# the sources' parameter sets: d, r, ε, h, a, b
_SETS = {
    "paper": AlphaInteraction(),
    "notebook-algorithm1": AlphaInteraction(1.9, 2.8, 0.1, 0.4, 7.0, 9.0),
    "notebook-algorithm2": AlphaInteraction(1.7, 2.5, 0.01, 0.2, 7.0, 15.0),
    "msn": AlphaInteraction(15.0, 18.0, 0.1, 0.1, 3.0, 3.0),
}


_SPACES = {1: "on a line", 2: "in the plane", 3: "in space"}
_LATTICES = {  # of links of length 1: the largest below (n − 1) ψ_α(r_α), a trapezium of five and an octahedron
    1: np.arange(3.0)[:, None],
    2: hexagonal_spiral(5, 1.0),
    3: np.vstack([np.eye(3), -np.eye(3)]) / sqrt(2.0),
}


def _error(alpha: AlphaInteraction, n: int) -> float:
    """Return the rounding error of V of n agents, with each pair known to 1e-13 c*."""
    pairs = n * (n - 1) // 2
    return pairs * (1e-13 + pairs * EPS) * alpha.c_star


def _implication(alpha: AlphaInteraction) -> Claim:
    """Return the printed claim, which is true, that V >= c* where two agents coincide, since ψ_α >= 0."""
    # ψ_α has its zero at d_α, so what is looked at is ψ_α/(z − d_α)², which is positive there too, where it is φ_α'/2.
    z = alpha.sigma_norm(np.linspace(0.0, 1.1 * alpha.r, 2001))
    z = z[np.abs(z - alpha.d_alpha) > 1e-3 * alpha.d_alpha]
    square = (z - alpha.d_alpha) ** 2
    ratio, error = alpha.psi_alpha(z) / square, 1e-13 * alpha.c_star / float(square.min())
    slope = float(min(ratio.min(), 0.5 * alpha.phi_alpha_slope(alpha.d_alpha)))
    return of_state("printed", slope, error, about="all", proof="collisions", computed=slope).described(
        stated="ψ_α >= 0, so that V >= c* where two agents coincide, and c < c* excludes it",
        witness="ψ_α/(z - d_α)² at 2001 lengths; the sign of ψ_α follows from that of φ_α",
        detail=f"the implication holds: ψ_α is at least {slope:.2g} (z - d_α)², and V does not rise",
    )


def _reached(alpha: AlphaInteraction) -> Claim:
    """Return the claim on the largest number of agents whose best α-lattice has an energy V below c*."""
    n = lattice_reach(alpha) or 0
    energies = [alpha.potential_energy(hexagonal_spiral(size, alpha.d)) for size in (n, n + 1)]
    margin, error = min(alpha.c_star - energies[0], energies[1] - alpha.c_star), _error(alpha, n + 1)
    return of_state("found", margin, error, about="all", proof="n-max", computed=n).described(
        stated="the best α-lattices have V < c* for n <= 14 only",
        witness={"V(n)": energies[0], "V(n + 1)": energies[1], "c*": alpha.c_star},
        detail=f"with the most links possible ({harborth(n)} at n = {n}), V = {energies[0]:.4g} < c* = "
        f"{alpha.c_star:.4g}; at n = {n + 1}, {energies[1]:.4g}",
    )


def _none(alpha: AlphaInteraction) -> Claim:
    """Return the claim that no state of 23 agents has V < c*."""
    n = least_infeasible_size(alpha)
    shortest, longest = bound_range(alpha)
    table = {
        name: {m: [lattice_reach(own_set, m), least_infeasible_size(own_set, m)] for m in (1, 2, 3)}
        for name, own_set in _SETS.items()
    }
    return of_state(
        "vacuous",
        float("nan") if n is None else energy_floor(alpha, n) - alpha.c_star,
        _error(alpha, n or 1),
        about="all",
        computed=n,
        stated="for n >= 23 no configuration in the plane has V < c*",
        witness={"[largest n of a lattice below c*, least n without any state], by set and dimension": table},
        proof="n-max",
        detail=f"only pairs {shortest:.4g} to {longest:.4g} apart lower V, a ratio of {longest / shortest:.4g} < √2; "
        f"no four agents have such distances, so by Turán V > c* from n = {n} on",
    )


def _together(alpha: AlphaInteraction) -> Claim:
    """Return the claim that only small lattices meet Theorem 1's energy hypothesis."""
    rooms, table = [], {}
    for m, q in _LATTICES.items():
        n, far_energy = len(q), alpha.far_potential
        rooms.append((n - 1) * far_energy - alpha.potential_energy(alpha.d * q))
        agent_count = next(k for k in range(2, 100) if energy_floor(alpha, k, m) > (k - 1.5) * far_energy)
        table[m] = [n, agent_count]
    return of_state(
        "together",
        float(min(rooms)),
        _error(alpha, max(len(q) for q in _LATTICES.values())),
        about="all",
        computed=table,
        stated="H(0) < (n-1) ψ_α(r_α) keeps every solution from there connected",
        witness={"[n of a lattice below, least n without any state], by dimension": table},
        proof="any-potential",
        detail="the best lattices at rest are below this energy up to n = "
        + ", ".join(f"{n} ({_SPACES[m]}; no state from n = {agent_count} on)" for m, (n, agent_count) in table.items())
        + f", by {min(rooms) / alpha.far_potential:.3g} ψ_α(r_α) at least, left for kinetic energy",
    )


def _barrier(alpha: AlphaInteraction) -> Claim:
    """Return the claim that min{V : two agents coincide} is above c*, by a lower bound and a search."""
    barriers = {n: collision_barrier(alpha, n, starts=_STARTS) for n in _SIZES}
    margin = min(collision_bounds(alpha, n)[0] - alpha.c_star for n in _SIZES if n > _TRIANGLE)
    heights = ", ".join(f"{barrier.height:.3f} at n = {n}" for n, barrier in barriers.items())
    return of_state("barrier", margin, _error(alpha, max(_SIZES))).described(
        computed={n: {"together": barrier.together, "ground": barrier.lowest} for n, barrier in barriers.items()},
        stated="min{V : two agents coincide} > c*: a sharper certificate, and one that grows with min V",
        witness="minimised from many starts, an upper bound; the margin is that of a lower bound, which counts pairs",
        detail=f"to bring two agents together takes {heights}, from the best lattice (c* = {alpha.c_star:.3f})",
    )


@erratum(
    "E4",
    expected={"verified": "printed found vacuous barrier together"},
    ours=("found", "vacuous", "barrier", "together"),
)
def theorem(tolerances: Tolerances) -> list[Claim]:
    """Theorem 1(iii) excludes collisions below c* = ψ_α(0). That is true, but each pair out of range adds ψ_α(r_α) to
    the energy: in the plane no α-lattice of more than 14 agents is below c*, and no state of 23 or more (18 on a line,
    26 in space). The barrier min{V : two agents coincide} is a bound that does not become vacuous; it is found
    numerically. The hypothesis of Theorem 1 on all solutions is met for energies below (n-1) ψ_α(r_α): by lattices of
    up to 3 agents on a line, 5 in the plane and 6 in space.
    """
    alpha = AlphaInteraction()
    return [_implication(alpha), _reached(alpha), _none(alpha), _barrier(alpha), _together(alpha)]
