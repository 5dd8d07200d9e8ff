"""Claims decided by a tube (`flockana.enclose`): rigorous for every enclosed start.

A margin is a ball. Where it lies on one side of 0, it decides; where it does not, it is too wide, and the claim is
inconclusive. A limit is claimed from the certified basin that the tube ends in.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from importlib import import_module
from math import inf
from typing import TYPE_CHECKING, Any

import numpy as np

from flockana.measures.nets import components
from flockana.theorems.hypotheses import condition
from flockana.theorems.limit_certificates import Certificate, limit_claim
from flockana.theorems.theorem_toolkit import (
    Checked,
    Claim,
    Enclosure,
    Hypothesis,
    Needs,
    Tolerances,
    judged,
    positive_room,
)

if TYPE_CHECKING:
    from flint import arb

    from flockana.certified.tube import BasinLike, Tube

Pair = tuple[int, int]
certain = partial(condition, decided="enclosed")  # a hypothesis that balls decide


@dataclass(frozen=True)
class TubeAndBasin:
    """Tube enclosing the motion, with the certified basin at its end, if any."""

    tube: Tube  # The tube
    basin: BasinLike | None  # A certified basin that holds all of its end; None if none is known to
    doubt: str  # Why there is none

    @classmethod
    def of(cls, tube: Tube, basin: BasinLike | None) -> TubeAndBasin:
        """Return a tube enclosing the motion, with the certified basin at its end, if any."""
        if basin is None:
            return cls(tube, None, "no certified basin was given")
        if tube.status != "complete":
            return cls(tube, None, f"the tube ends early: {tube.message}")
        if not tube.ends_in(basin):
            return cls(tube, None, f"the end of the tube, at t = {tube.t[-1]:g}, is not certainly in the basin")
        return cls(tube, basin, "")

    @property
    def until(self) -> str:
        """Time of validity of the tube's claims, in words."""
        tube = self.tube
        note = f"; {tube.message}" if tube.message and tube.message not in self.doubt else ""
        if self.basin is not None:
            return f"at all times: up to t = {tube.t[-1]:g} by the tube, from then on in the basin{note}"
        return f"from t = {tube.t[0]:g} to {tube.t[-1]:g}; {self.doubt}{note}"


def enclosed_by(name: str, module: str) -> Callable[..., Checked]:
    """Return the function that decides a theorem for tubes, imported from its module at the first call."""

    def check(tube: Tube, basin: BasinLike | None, tolerances: Tolerances) -> Checked:
        decide_claim = getattr(import_module(module), name)
        return decide_claim(tube, basin, tolerances)

    return check


def ends(ball: arb) -> Enclosure:
    """Return a ball as an enclosure in floating point, with infinite ends if it is not finite."""
    from flockana.certified.tube import down, up

    return Enclosure.between(*((down(ball.lower()), up(ball.upper())) if ball.is_finite() else (-inf, inf)))


def decided(name: str, margin: arb, needs: Needs = (), *, detail: str = "", **fields: Any) -> Claim:
    """Return a claim that holds for a certainly nonnegative margin, and fails for a certainly negative one."""
    slack = ends(margin)
    if slack.lo < 0.0 <= slack.hi:
        wide = f"the enclosure alone is too wide to tell: the margin is between {slack.lo:.3g} and {slack.hi:.3g}"
        detail = f"{detail}; {wide}".lstrip("; ")
    return judged(name, slack, needs, rigour="interval", detail=detail, **fields)


def below(name: str, energy: arb, bound: arb) -> Hypothesis:
    """Return the hypothesis that an energy lies below a bound, assumed if ball arithmetic cannot decide."""
    text = f"H(0) is in [{float(energy.lower()):.6g}, {float(energy.upper()):.6g}], the bound is {float(bound):.6g}"
    return positive_room(name, ends(bound - energy), text)


def met(tube: Tube) -> dict[Pair, float]:
    """Return pairs of agents that certainly meet, as they swap order on a line, with latest meeting times."""
    times: dict[Pair, float] = {}
    if tube.m > 1:
        return times
    first_positions = [row[0] for row in tube.state(0)[0]]
    for k, t in enumerate(tube.t):
        q = [row[0] for row in tube.state(k)[0]]
        for i, j in tube.pairs:
            previous_gap, current_gap = first_positions[j] - first_positions[i], q[j] - q[i]
            if (previous_gap > 0 and current_gap < 0) or (previous_gap < 0 and current_gap > 0):
                times.setdefault((i, j), t)
    return times


def no_collision(case: TubeAndBasin, needs: Needs, *, name: str, proof: str | None = None) -> Claim:
    """Return the claim that no two agents ever coincide: certain by positive distances, refuted by a meeting."""
    from flint import arb

    tube = case.tube
    distance, certain_meetings = tube.min_distance(), met(tube)
    pair, margin = distance.pair, arb(min(distance.lower, 1e300)) if distance.lower > 0.0 else arb(0, 1)
    if tube.status != "complete":
        margin = arb(0, 1)  # of what comes after its end nothing is known
    text = f"no two agents come nearer than {distance.lower:.6g}, {case.until}"
    if certain_meetings:
        pair = min(certain_meetings, key=lambda each: certain_meetings[each])
        margin, text = arb(-1), f"agents {pair[0]} and {pair[1]} certainly meet before t = {certain_meetings[pair]:.6g}"
    time_text = "always" if case.basin is not None else f"from t = {tube.t[0]:g} to {tube.t[-1]:g}"
    return decided(
        name,
        margin,
        list(needs),
        computed=distance.lower,
        stated=f"no two agents meet, {time_text}",
        witness={"pair": pair, "time": certain_meetings.get(pair, distance.time)},
        proof=proof,
        detail=text,
    )


def in_the_limit(case: TubeAndBasin, needs: Needs, margin: arb | None = None, *, name: str, **fields: Any) -> Claim:
    """Return a limit claim for every start of a tube, by a margin of the basin at its end."""
    if case.basin is None:
        return limit_claim(name, needs, [Certificate(-1.0, case.doubt)], rigour="interval", **fields)
    slack = Enclosure.of(1.0) if margin is None else ends(margin)
    escape = Certificate(float(-slack.hi), "", 0.0)
    return limit_claim(name, needs, [Certificate(float(slack.lo), "", 0.0)], escape=escape, rigour="interval", **fields)


def converges(case: TubeAndBasin, needs: Needs, name: str, stated: str, detail: str, proof: str | None = None) -> Claim:
    """Return the claim that every start of the tube converges to the basin's orbit, or by a proof."""
    last = case.tube.t[-1]
    basin_text = f"{detail}; all states at t = {last:g} lie in a certified basin" if case.basin is not None else ""
    return in_the_limit(case, needs, name=name, stated=stated, witness={"time": last}, detail=basin_text, proof=proof)


def certain_links(distances: Mapping[Pair, arb], reach: arb) -> tuple[list[Pair], list[Pair]]:
    """Return the pairs of agents certainly in range and those possibly in range."""
    return (
        [pair for pair, distance in distances.items() if distance < reach],
        [pair for pair, distance in distances.items() if not distance >= reach],
    )


def groups(n: int, pairs: Sequence[Pair]) -> list[int]:
    """Return the sizes of the connected components of n agents, largest first."""
    label = components(n, np.array(pairs, dtype=np.int32).reshape(-1, 2))
    return sorted(np.bincount(label).tolist(), reverse=True)


def rest_strain(basin: BasinLike, alpha: Any) -> arb:
    """Return the largest |link − d|/d of a basin's equilibrium, as a ball; 1 without links."""
    from flint import arb

    from flockana.certified.balls import exact

    d, r = arb(exact(alpha.d)), arb(exact(alpha.r))
    link_lengths = [s.sqrt() for *_, s in basin.proof.structure.pairs(basin.proof.rest) if not s >= r * r]
    strain = arb(0)
    for distance in link_lengths:
        deviation = abs(distance - d) / d
        strain = strain.max(deviation if distance < r else deviation.union(arb(0)))  # a pair at r may be no link
    has_link = any(distance < r for distance in link_lengths)
    return strain if has_link else strain.union(arb(1)) if link_lengths else arb(1)
