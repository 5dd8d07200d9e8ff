"""Definition 5 of Olfati-Saber (2006), α-flocking, decided by a tube, also between its steps."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from functools import partial
from math import floor
from typing import TYPE_CHECKING

from flint import arb, ctx

from flockana.certified.balls import exact, norm, square
from flockana.certified.structural_energy import BITS
from flockana.certified.tube import Pair, Tube
from flockana.theorems.theorem_toolkit import Checked, Claim, Hypothesis, Tolerances, condition
from flockana.theorems.tube_claims import certain_links, decided, groups

if TYPE_CHECKING:
    from flockana.certified.tube import BasinLike

_SHARE = 1e-9  # of an agent: what a share of n agents, as a decimal fraction, may be off by


def _window(tube: Tube, tolerances: Tolerances) -> tuple[Hypothesis, range]:
    """Return the hypothesis that a tube covers the judged window, and the numbers of the steps within."""
    start = tube.t[0] + tolerances.settle * (tube.t[-1] - tube.t[0])
    steps = [k for k in range(len(tube.taken)) if tube.t[k + 1] > start]
    is_broken = tube.status != "complete"
    detail = tube.message if is_broken else f"from t = {start:.4g} to {tube.t[-1]:.4g}, at all times"
    is_window = condition("judged over a window", bool(steps) and not is_broken, detail=detail)
    return is_window, range(steps[0], steps[-1] + 1) if steps else range(0)


def _highest(tube: Tube, window: range, value: Callable[[int], arb]) -> tuple[arb, float]:
    """Return a ball around the largest value of a quantity over the window, and its approximate time."""
    values = [value(k) for k in window]
    low, high = (max((end(x) for x in values), key=float) for end in (arb.lower, arb.upper))
    worst = max(range(len(values)), key=lambda i: float(values[i].upper()))
    return low.union(high), tube.t[window[worst]]


def _distances(tube: Tube, k: int) -> dict[Pair, arb]:
    return dict(zip(tube.pairs, tube.distances_during(k), strict=True))


def _components(tube: Tube, window: range, name: str, most: int, missing: Callable[[list[Pair]], int]) -> Claim:
    """Return the claim that a number that falls with each link, such as that of components, never exceeds a bound."""
    reach = arb(exact(tube.law.alpha.r))

    def count(k: int) -> arb:
        certain_pairs, possible_pairs = certain_links(_distances(tube, k), reach)
        return arb(missing(possible_pairs)).union(arb(missing(certain_pairs)))

    number, time_of_highest = _highest(tube, window, count)
    stated_text = "the net is connected" if name == "flock" else f"at most {most} agents outside the giant component"
    quantity_name = "components" if name == "flock" else "agents outside the giant component"
    text = f"{quantity_name}: {float(number.upper()):.0f} at most, about t = {time_of_highest:.4g}"
    return decided(name, most + arb("0.5") - number, computed=float(number.mid()), stated=stated_text, detail=text)


def _deviation(tube: Tube, window: range, tolerances: Tolerances) -> Claim:
    """Return the claim that the deviation energy is small, Ẽ <= ε₁, at all times of the window."""
    d, reach = arb(exact(tube.law.alpha.d)), arb(exact(tube.law.alpha.r))

    def value(k: int) -> arb:
        lengths = _distances(tube, k)
        certain, possible = certain_links(lengths, reach)
        sums = [2 * sum((square(lengths[pair] / d - 1) for pair in pairs), arb(0)) for pairs in (certain, possible)]
        return (sums[0] / (2 * len(possible) + 1)).union(sums[1] / (2 * len(certain) + 1))

    highest, when = _highest(tube, window, value)
    return _below("deviation", "Ẽ", highest, tolerances.deviation, when)


def _mismatch(tube: Tube, window: range, tolerances: Tolerances) -> Claim:
    """Return the claim that the velocity mismatch is small, K̃ <= ε₂, at all times of the window."""
    units, n, m = arb(tube.law.scales.energy), tube.n, tube.m

    def value(k: int) -> arb:
        p = tube.taken[k].during[n * m :]
        mean_values = [sum(p[axis::m], arb(0)) / n for axis in range(m)]
        return sum((square(x - mean_values[i % m]) for i, x in enumerate(p)), arb(0)) / (2 * n * units)

    highest, time_of_highest = _highest(tube, window, value)
    return _below("mismatch", "K̃", highest, tolerances.mismatch, time_of_highest)


def _below(name: str, symbol: str, highest: arb, bound: float, when: float) -> Claim:
    """Return the claim that the largest value of a quantity is below a bound."""
    top = float(highest.upper())
    detail = f"{symbol} <= {top:.4g} throughout, largest about t = {when:.4g}"
    return decided(name, arb(bound) - highest, computed=top, stated=f"{symbol} <= {bound:g}", detail=detail)


def _cohesive(tube: Tube, window: range, tolerances: Tolerances) -> Claim:
    """Return the claim that the cohesion radius R never exceeds a multiple of its value at the window's start."""
    rows = [[norm(x) for x in tube.taken[k].deviations] for k in window]
    radii = [max(row, key=lambda x: float(x.upper())).union(max(row, key=lambda x: float(x.lower()))) for row in rows]
    bound = arb(tolerances.cohesion) * radii[0]
    highest = _highest(tube, range(len(radii)), lambda k: radii[k])[0]
    detail = f"R is at most {float(highest.upper()):.5g}, and {float(radii[0].mid()):.5g} when the window begins"
    top, stated_text = float(highest.upper()), "R stays bounded"
    return decided("cohesive", bound - highest, computed=top, stated=stated_text, detail=detail)


def _connected(tube: Tube, window: range, tolerances: Tolerances) -> Claim:
    """Return the claim that the net is connected throughout."""
    return _components(tube, window, "flock", 1, lambda pairs: len(groups(tube.n, pairs)))


def _giant(tube: Tube, window: range, tolerances: Tolerances) -> Claim:
    """Return the claim that one component always has more than a given share of all agents."""
    outer_count = tube.n - floor(tolerances.giant * tube.n + _SHARE) - 1
    return _components(tube, window, "giant", outer_count, lambda pairs: tube.n - groups(tube.n, pairs)[0])


def _check(
    claims: Iterable[Callable[..., Claim]], tube: Tube, basin: BasinLike | None, tolerances: Tolerances
) -> Checked:
    """Return the hypothesis and given claims of α-flocking for all starts enclosed by a tube."""
    spans, window = _window(tube, tolerances)
    with ctx.workprec(BITS):
        return [spans], [] if spans.status == "unmet" else [claim(tube, window, tolerances) for claim in claims]


alpha_flocking = partial(_check, (_giant, _cohesive, _deviation, _mismatch))
alpha_flocking_strict = partial(_check, (_connected, _deviation, _mismatch))
