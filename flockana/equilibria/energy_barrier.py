"""Energy for bringing two agents together, and flock sizes for which no state is below c*.

All energies here are those of V, to be multiplied by c1α.
"""

from dataclasses import dataclass
from math import ceil, floor, inf, isfinite, pi, sin, sqrt

import numpy as np

from flockana.base.value_checks import FloatArray, ensure_count, ensure_dimension
from flockana.equilibria.equilibrium_search import lattice_starts, random_starts
from flockana.equilibria.potential import Potential
from flockana.equilibria.solve import all_pairs
from flockana.interactions import AlphaInteraction
from flockana.kernels.neighbours import pair_blocks
from flockana.lattice import harborth, hexagonal_spiral
from flockana.laws import Algorithm1

# Least ratio of the longest to the shortest distance among so many points, by dimension: in the plane 4 are at best a
# square, 5 a regular pentagon (Bateman and Erdős 1951, who go up to 7); in space 5 are a bipyramid (Seidel 1969).
_LEAST_RATIO = {2: {4: sqrt(2.0), 5: 0.5 * (1.0 + sqrt(5.0)), 6: 2.0 * sin(0.4 * pi), 7: 2.0}, 3: {5: sqrt(12.0 / 7.0)}}
_ABOVE = 1e-9  # relative: an upper bound also where the shortest length came out a few ulps too long
_LARGEST = 2_000  # agents up to which the counts are followed


@dataclass(frozen=True)
class Barrier:
    """Lowest known energies of n agents, with and without two coincident agents."""

    n: int
    m: int
    # lowest V found with a coincident pair: an upper bound of the true minimum, the unsafe side of a certificate
    together: float
    lowest: float  # lowest V found at all
    state: FloatArray  # shape (n, m): the configuration with a coincident pair
    solves: int  # successful solves behind the two figures

    @property
    def height(self) -> float:
        """Energy needed to make two agents of the best flock coincide, `together` − `lowest`."""
        return self.together - self.lowest


def collision_barrier(alpha: AlphaInteraction, n: int, *, m: int = 2, starts: int = 24, seed: int = 0) -> Barrier:
    """Search min{V(q) : two agents coincide} and min V by IPOPT from many starts; numeric, not rigorous."""
    # Any pair will do, as agents are alike: the constraint is q_1 = q_2. Since every other pair then counts at least 0,
    # the first is at least c*; and V(q) < the first minimum, with V not rising along the flow, excludes every
    # collision.
    from flockana.equilibria.ipopt_program import Program

    n, m = ensure_count("n", n), ensure_dimension(m)
    free_program = Program(Potential(Algorithm1(alpha)), (n, m), all_pairs(n), m)
    tied_program = Program(Potential(Algorithm1(alpha)), (n, m), all_pairs(n), 2 * m)
    translations = np.tile(np.eye(m), (n, 1)) / sqrt(n)
    constraint_rows = np.zeros((n, m, m))
    constraint_rows[0], constraint_rows[1] = np.eye(m), -np.eye(m)
    tie_basis = np.hstack([translations, constraint_rows.reshape(n * m, m)])
    lowest_value, meeting_energy, state, solves = inf, inf, np.full((n, m), np.nan), 0
    for q in _starts(alpha, n, m, starts, seed):
        low, converged, _ = free_program.solve(q, basis=translations)
        if converged:
            lowest_value, solves = min(lowest_value, alpha.potential_energy(low)), solves + 1
    for q in _starts(alpha, n - 1, m, starts, seed):
        lattice_with_double = _most_linked_first(q, alpha)
        lattice_with_double = np.vstack([lattice_with_double[:1], lattice_with_double])
        low, converged, _ = tied_program.solve(lattice_with_double, basis=tie_basis)
        if converged:
            solves += 1
            if (value := alpha.potential_energy(low)) < meeting_energy:
                meeting_energy, state = value, low
    return Barrier(n, m, meeting_energy, lowest_value, state, solves)


def _starts(alpha: AlphaInteraction, n: int, m: int, count: int, seed: int) -> list[FloatArray]:
    best_starts = [hexagonal_spiral(n, alpha.d)] if m == 2 else []
    grown_lattices = lattice_starts(n, m, alpha.d, count, seed=seed)
    return best_starts + grown_lattices + random_starts(n, m, alpha.d, count, seed=seed, density=2.0)


def _most_linked_first(q: FloatArray, alpha: AlphaInteraction) -> FloatArray:
    """Return positions sorted by the number of neighbours, the agent with the most neighbours first."""
    links = np.zeros(len(q), dtype=np.int64)
    for i, j in pair_blocks(q, alpha.r):
        links += np.bincount(i, minlength=len(q)) + np.bincount(j, minlength=len(q))
    order = np.argsort(-links, kind="stable")
    return np.ascontiguousarray(q[order])


def bound_range(alpha: AlphaInteraction) -> tuple[float, float]:
    """Return the interval of lengths with ψ_α < ψ_α(r_α), where a pair lowers V."""
    # They are (shortest, r); the shortest is 0 where even a coincident pair has no more than ψ_α(r_α).
    if alpha.c_star <= alpha.far_potential:
        return 0.0, alpha.r
    low, high = 0.0, alpha.d  # ψ_α falls from c* to 0; scipy.optimize takes longer to load than this
    while high - low > 1e-12 * alpha.d:
        midpoint = 0.5 * (low + high)
        exceeds_bound = float(alpha.psi_alpha(alpha.sigma_norm(midpoint))) > alpha.far_potential
        low, high = (midpoint, high) if exceeds_bound else (low, midpoint)
    return high, alpha.r


def largest_clique(ratio: float, m: int) -> int | None:
    """Return an upper bound of the number of points whose distances agree within a factor below `ratio`."""
    # On a line p points have a ratio of p − 1 at least; four of the plane √2 (one angle is not acute), up to seven of
    # it and five in space are known too. Beyond, balls of half the shortest distance about the points fit into Jung's
    # ball.
    if not isfinite(ratio):
        return None
    clique_limit = floor((1.0 + 2.0 * ratio * sqrt(m / (2.0 * (m + 1.0)))) ** m)
    reachable = [points - 1 for points, least_ratio in _LEAST_RATIO.get(m, {}).items() if ratio <= least_ratio]
    return min([clique_limit, ceil(ratio)] if m == 1 else [clique_limit, *reachable])


def turan_pairs(n: int, clique: int) -> int:
    """Return the most edges of a graph of n nodes without a clique of more than `clique` (Turán 1941)."""
    group_size, more = divmod(n, clique)
    inner_count = more * (group_size + 1) * group_size // 2 + (clique - more) * group_size * (group_size - 1) // 2
    return n * (n - 1) // 2 - inner_count


def energy_floor(alpha: AlphaInteraction, n: int, m: int = 2) -> float:
    """Return a proved lower bound of V over all configurations of n agents."""
    shortest, longest = bound_range(alpha)
    clique = largest_clique((1.0 + _ABOVE) * longest / shortest if shortest else inf, m)
    return 0.0 if clique is None else alpha.far_potential * (n * (n - 1) // 2 - turan_pairs(n, clique))


def least_infeasible_size(alpha: AlphaInteraction, m: int = 2) -> int | None:
    """Return the least n from which provably no state has V < c* (Theorem 1(iii) is empty); None if unknown."""
    # the floor rises with n: every agent more adds pairs outside the cliques
    return next((n for n in range(2, _LARGEST) if energy_floor(alpha, n, m) >= alpha.c_star > 0.0), None)


def lattice_reach(alpha: AlphaInteraction, m: int = 2) -> int | None:
    """Return the largest n whose exact α-lattice has V < c*; None where κ is too large, or m = 3."""
    if m == 3 or alpha.kappa > (2.0 if m == 1 else sqrt(3.0)):
        return None
    links = {n: n - 1 if m == 1 else harborth(n) for n in range(1, _LARGEST)}
    return max(n for n, most in links.items() if alpha.far_potential * (n * (n - 1) // 2 - most) < alpha.c_star)


def collision_bounds(alpha: AlphaInteraction, n: int, m: int = 2) -> tuple[float, float]:
    """Return a proved lower and an attained upper bound of min{V : two agents coincide}, without a search."""
    # Below the first no two agents can meet; at the second a configuration is known in which two do. Of a coincident
    # pair, which costs c*, one agent can be taken away: n − 1 are left, with at least `energy_floor` between them. The
    # upper one doubles the agent with the most links in a compact lattice.
    n, m = ensure_count("n", n), ensure_dimension(m)
    if n == 1:
        return inf, inf
    return alpha.c_star + energy_floor(alpha, n - 1, m), alpha.potential_energy(coincident_lattice(alpha, n, m))


def coincident_lattice(alpha: AlphaInteraction, n: int, m: int = 2) -> FloatArray:
    """Return a compact lattice of n − 1 agents with its most linked agent doubled, n >= 2."""
    lattice = hexagonal_spiral(n - 1, alpha.d) if m == 2 else lattice_starts(n - 1, m, alpha.d, 1, noise=0.0)[0]
    reordered = _most_linked_first(lattice, alpha)
    return np.vstack([reordered[:1], reordered])
