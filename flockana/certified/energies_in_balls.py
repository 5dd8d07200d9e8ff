"""Energies of Algorithms 1 to 3 on boxes of states, levels of energy, and the work along a tube, as balls.

Below the levels no two agents can coincide, or no agent can leave. The counting is that of
`flockana.equilibria.energy_barrier`, with every length and level enclosed, and each count rounded to the safe side.
"""

from collections.abc import Sequence
from itertools import combinations
from math import ceil, floor
from typing import Any

from flint import arb, arb_series, ctx, fmpq

from flockana.certified.balls import ball, exact, hull, minus, norm2, series_length, square
from flockana.certified.flow_in_balls import Flow, Pieces, flow_of, sphere_terms
from flockana.certified.pair_laws_in_series import PairNumbers, Piece
from flockana.certified.structural_energy import BITS, Vectors, pair_energy
from flockana.certified.tube import Tube
from flockana.equilibria.energy_barrier import coincident_lattice, turan_pairs
from flockana.lattice import harborth

_HALVINGS = 40  # of the bracket of the shortest length of a bound pair
_ORDER = 12  # of the rate's Taylor polynomials


def total_energy(law: Any, q: Vectors, p: Vectors) -> arb:
    """Return the energy H of Algorithm 3 (obstacles, bounded pull, every pair once) on a box of states."""
    with ctx.workprec(BITS):
        area = arb(exact(law.alpha.unit)) ** 2
        start = [arb(exact(x)) for x in law.target.harmonic.terms[0].tolist()]
        distance_sum = sum(((1 + norm2(minus(x, start)) / area).sqrt() - 1 for x in q), arb(0))
        total = pair_energy(law, q) + arb(exact(law.gains.c1_gamma)) * area * distance_sum
        for term in sphere_terms(law):
            total += term.stiffness * sum((term.beta.potential(square(term.clearance(x))) for x in q), arb(0))
        return total + sum(map(norm2, p), arb(0)) / 2


def powers_during(tube: Tube, flow: Flow, k: int) -> list[arb]:
    """Return the summands of dH/dt (pair damping, single-agent forces) during step k of a tube, as balls."""
    box = tube.taken[k].during
    return flow.powers(box, flow.pieces(box))


def work(tube: Tube) -> arb:
    """Return a ball around the integral of dH/dt over the whole time span of an enclosed run."""
    # On a step where every pair and agent is on one piece, the rate's Taylor polynomial is integrated, with its last
    # coefficient taken over all states of the step; elsewhere the step's length times the rate's range.
    with ctx.workprec(BITS):
        flow, total = flow_of(tube.law, tube.n, tube.m), arb(0)
        for k, (start, end) in enumerate(zip(tube.t[:-1], tube.t[1:], strict=True)):
            h, state_range = arb(end) - arb(start), tube.taken[k].during
            pieces = flow.pieces(state_range)
            if Piece.SWITCH in pieces:
                total += h * sum(flow.powers(state_range, pieces), arb(0))
                continue
            first_rate = _rate(flow, arb(start), tube.boxes[k], pieces)
            last_rate = _rate(flow, arb(start) + hull(arb(0), h), state_range, pieces)
            total += sum((c * h ** (j + 1) / (j + 1) for j, c in enumerate(first_rate[:_ORDER])), arb(0))
            total += last_rate[_ORDER] * h ** (_ORDER + 1) / (_ORDER + 1)
        return total


def _rate(flow: Flow, t: arb, state: Sequence[arb], pieces: Pieces) -> list[arb]:
    """Return Taylor coefficients in time of dH/dt along the solutions from a box."""
    path = flow.taylor(t, state, _ORDER, pieces)
    with series_length(_ORDER + 1):
        total = sum(flow.powers([arb_series(row) for row in path], pieces), arb_series([0]))
        return [total[j] for j in range(_ORDER + 1)]


def coincident_floor(alpha: Any, n: int, m: int) -> arb:
    """Return a lower bound of the potential V of n agents, two of which coincide."""
    with ctx.workprec(BITS):
        pair, clique = PairNumbers.of_alpha(alpha), _largest_clique(alpha, m)
        if clique is None:
            return pair.c_star
        return pair.c_star + ((n - 1) * (n - 2) // 2 - turan_pairs(n - 1, clique)) * pair.far


def coincident_state(alpha: Any, n: int, m: int) -> arb:
    """Return the potential V of one state of n agents, two of which coincide."""
    q = coincident_lattice(alpha, n, m)
    with ctx.workprec(BITS):
        rows = [[arb(float(a)) for a in x] for x in q]
        s2 = (norm2(minus(x, y)) for x, y in combinations(rows, 2))
        return sum(map(PairNumbers.of_alpha(alpha).potential, s2), arb(0))


def disconnected_state(alpha: Any, n: int, m: int) -> arb | None:
    """Return the potential V of the best lattice of n − 1 agents and one far away; None if unknown."""
    with ctx.workprec(BITS):
        square_of_kappa = (exact(alpha.r) / exact(alpha.d)) ** 2
        if n < 2 or square_of_kappa >= (4 if m == 1 else 3):
            return None
        bonds = n - 2 if m == 1 else harborth(n - 1)
        return (n * (n - 1) // 2 - bonds) * PairNumbers.of_alpha(alpha).far


def _shortest_bound(alpha: Any) -> fmpq | None:
    """Return a length below which a pair certainly has ψ_α > ψ_α(r_α); None if there is none."""
    # ψ_α falls up to d_α, so that it holds below any length at which it holds.
    pair, low, high = PairNumbers.of_alpha(alpha), fmpq(0), exact(alpha.d)
    if not pair.c_star > pair.far:
        return None
    for _ in range(_HALVINGS):
        midpoint = (low + high) / 2
        low, high = (midpoint, high) if pair.potential(square(ball(midpoint))) > pair.far else (low, midpoint)
    return low


def _largest_clique(alpha: Any, m: int) -> int | None:
    """Return a bound of the number of points whose pairs all have ψ_α < ψ_α(r_α); None if there is no bound."""
    shortest = _shortest_bound(alpha)
    if not shortest:
        return None
    ratio = ball(exact(alpha.r) / shortest)
    clique_limit = floor(float(((1 + 2 * ratio * ball(fmpq(m, 2 * (m + 1))).sqrt()) ** m).upper()) * (1 + 2.0**-40))
    if m == 1:
        return min(clique_limit, ceil(float(ratio.upper()) * (1 + 2.0**-40)))
    reachable = [points - 1 for points, least_ratio in _least_ratios(m).items() if ratio < least_ratio]
    return min([clique_limit, *reachable])


def _least_ratios(m: int) -> dict[int, arb]:
    """Return the least ratio of longest to shortest distance by number of points (`equilibria.barrier`)."""
    if m == 2:
        return {4: arb(2).sqrt(), 5: (1 + arb(5).sqrt()) / 2, 6: 2 * arb(fmpq(2, 5)).sin_pi(), 7: arb(2)}
    return {5: arb(fmpq(12, 7)).sqrt()} if m == 3 else {}
