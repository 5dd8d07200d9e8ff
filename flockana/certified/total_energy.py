"""Energy of Algorithm 3 with a γ-agent at rest, in balls, and the integral of its rate along a tube."""

from collections.abc import Sequence
from typing import Any

from flint import arb, arb_series, ctx

from flockana.certified.balls import exact, hull, norm2, series_length, square
from flockana.certified.flow import Flow, Pieces
from flockana.certified.laws import flow_of, sphere_terms
from flockana.certified.series import PairNumbers, Piece
from flockana.certified.structural_energy import BITS
from flockana.certified.tube import Tube

_ORDER = 12  # of the rate's Taylor polynomials


def total_energy(law: Any, q: Sequence[Sequence[arb]], p: Sequence[Sequence[arb]]) -> arb:
    """Return the energy H of Algorithm 3 (obstacles, bounded pull, every pair once) on a box of states."""
    with ctx.workprec(BITS):
        gains, area = law.gains, arb(exact(law.alpha.unit)) ** 2
        squares = [norm2([b - a for a, b in zip(x, y, strict=True)]) for k, x in enumerate(q) for y in q[k + 1 :]]
        pairs = sum(map(PairNumbers.of_alpha(law.alpha).potential, squares), arb(0))
        start = [arb(exact(x)) for x in law.target.harmonic.terms[0].tolist()]
        far = sum(((1 + norm2([a - b for a, b in zip(x, start, strict=True)]) / area).sqrt() - 1 for x in q), arb(0))
        total = arb(exact(gains.c1_alpha)) * pairs + arb(exact(gains.c1_gamma)) * area * far
        for term in sphere_terms(law):
            total += term.stiffness * sum((term.beta.potential(square(term.clearance(x))) for x in q), arb(0))
        return total + sum(map(norm2, p), arb(0)) / 2


def powers_during(tube: Tube, flow: Flow, k: int) -> list[arb]:
    """Return the parts of dH/dt (`Flow.powers`) as balls valid from step k to the next."""
    box = tube.taken[k].during
    return flow.powers(box, flow.pieces(box))


def work(tube: Tube) -> arb:
    """Return a ball around the integral of dH/dt over the tube, from the closed form of the rate."""
    # On a step where every pair and agent is on one piece, the rate's Taylor polynomial is integrated, with its last
    # coefficient taken over all states of the step; elsewhere the step's length times the rate's range.
    with ctx.workprec(BITS):
        flow, total = flow_of(tube.law, tube.n, tube.m), arb(0)
        for k, (start, end) in enumerate(zip(tube.t[:-1], tube.t[1:], strict=True)):
            h, during = arb(end) - arb(start), tube.taken[k].during
            pieces = flow.pieces(during)
            if Piece.SWITCH in pieces:
                total += h * sum(flow.powers(during, pieces), arb(0))
                continue
            first = _rate(flow, arb(start), tube.boxes[k], pieces)
            last = _rate(flow, arb(start) + hull(arb(0), h), during, pieces)
            total += sum((c * h ** (j + 1) / (j + 1) for j, c in enumerate(first[:_ORDER])), arb(0))
            total += last[_ORDER] * h ** (_ORDER + 1) / (_ORDER + 1)
        return total


def _rate(flow: Flow, t: arb, state: Sequence[arb], pieces: Pieces) -> list[arb]:
    """Return Taylor coefficients of dH/dt along the solutions from a box."""
    path = flow.taylor(t, state, _ORDER, pieces)
    with series_length(_ORDER + 1):
        total = sum(flow.powers([arb_series(row) for row in path], pieces), arb_series([0]))
        return [total[j] for j in range(_ORDER + 1)]
