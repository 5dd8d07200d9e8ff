"""Theorem 5 of Olfati-Saber (2006): nets of α-lattices are planar and not complete; extension to every net.

Checked on a configuration (``"os-5"``) or on the last state of a run (``"os-5-terminal"``).
"""

from dataclasses import replace
from fractions import Fraction
from itertools import combinations
from math import sqrt
from typing import Any

import numpy as np

from flockana.lattice import classify, crossings, harborth, is_planar, kuratowski, links, planar_bound, separation
from flockana.lattice.classification import GUARD
from flockana.lattice.crossings import LISTED
from flockana.measures.metrics import min_distance
from flockana.measures.nets import LinkArray, link_lengths
from flockana.theorems.claims import run_theorem
from flockana.theorems.hypotheses import has_lattice
from flockana.theorems.theorem import Checked, Claim, Hypothesis, Needs, Theorem, Tolerances, unmet
from flockana.theorems.theorem_toolkit import EPS, FloatArray, Observed, by_count, condition, counted, of_state, vacuous

_OURS = ("ii-sharp", "extension", "extension-lengths", "extension-links", "extension-quantitative")
CLAIMS = ("i", "i-graph", "ii", "ii-sharp", "iii", *_OURS[1:])
_SHOWN = 10  # and shown as witness
_WITNESS_LIMIT = 20_000  # links of which a Kuratowski subgraph is still found in about a minute
_CROSSINGS, _COUNTS = "theorem5-crossings", "theorem5-counts"  # executable proofs
_ROUNDING = 1e-12  # relative error of a distance of two stored positions near the origin
_CERTAIN = 64.0 * EPS  # relative difference of two squared lengths that floating point gets the sign of


class Net:
    """Configuration with its links, their lengths and their crossings.

    Positions may be off by `off`: then pairs that may be linked count as links, and no crossing is certain.
    """

    def __init__(self, q: FloatArray, d: float, r: float, off: float = 0.0) -> None:
        self.q, self.d, self.r, self.off = q, d, r, off
        self.n, self.m = q.shape
        self.rounding = 8.0 * EPS * float(np.abs(q).max()) + _ROUNDING * r + 2.0 * off  # of a distance
        self.links: LinkArray = links(q, r, guard=min(0.5, max(GUARD, self.rounding / r)))
        self.lengths = link_lengths(q, self.links)
        self.strain = float(np.abs(self.lengths - d).max() / d) if len(self.links) else float("nan")
        self.closest = min_distance(q)
        self.crossings = crossings(q, self.links, limit=LISTED)

    def agents(self, pair: Any) -> list[list[int]]:
        """Return the two agents of each of two links, given by their indices."""
        return [[int(v) for v in self.links[k]] for k in pair]

    @property
    def crossing_count(self) -> int | str:
        """Number of crossing pairs of links, or a text if too many."""
        count = len(self.crossings)
        return f"at least {count}" if count >= LISTED else count

    @property
    def crossing_text(self) -> str:
        """Number of pairs of links that cross, in words."""
        if not self.crossing_count:
            return f"no two of {len(self.links)} links cross"
        return f"{self.crossing_count} pairs of {len(self.links)} links cross"


def _lattice_hypotheses(net: Net, tolerances: Tolerances) -> list[Hypothesis]:
    spacing_margin, kappa = net.closest / net.d - tolerances.contact, net.r / net.d
    kind = classify(net.strain, lattice=tolerances.lattice, quasi=tolerances.quasi).replace("neither", "no lattice")
    text = f"{kind}: δ/d = {net.strain:.3g}" if len(net.links) else "there are no links"
    return [
        condition("distinct positions", spacing_margin > 0.0, spacing_margin, f"shortest distance {net.closest:.6g}"),
        condition("κ = r/d > 1", kappa > 1.0, kappa - 1.0, f"κ = {kappa:.6g}"),
        condition(
            "q is an α-lattice",
            kind == "α-lattice" and not net.strain + 2.0 * net.off / net.d > tolerances.lattice,
            tolerances.lattice - net.strain,
            text,
        ),
    ]


def _dimension(name: str, holds: bool, net: Net) -> Hypothesis:
    return condition(name, holds, detail=f"m = {net.m}, n = {net.n}")


def _far_apart(net: Net, length: float, name: str) -> Hypothesis:
    margin = net.closest - length / sqrt(2.0)
    text = f"shortest distance {net.closest:.6g}; needed: more than {length / sqrt(2.0):.6g}"
    # what rounding decides is not taken for met
    return condition(f"all pairs are farther apart than {name}", margin > net.rounding, margin, text)


def uncrossed(net: Net, needs: Needs, name: str) -> Claim:
    """Return the claim that no two links cross: exact in the plane; in space a clearance beyond rounding."""
    count = net.crossing_count
    if (unmet_hypothesis := unmet(needs)) is not None:
        return vacuous(name, unmet_hypothesis, computed=count, stated="no two links cross", proof=_CROSSINGS)
    if count:
        margin, error, which, near = -float(len(net.crossings)), 0.0, None, ""
    else:
        gap = separation(net.q, net.links, reach=0.5 * net.d)
        margin, error = gap.distance / net.d, 2.0 * net.rounding / net.d
        which = None if gap.links is None else net.agents(gap.links)
        near = f"; links without a common agent stay {'at least ' if which is None else ''}{gap.distance:.4g} apart"
    return of_state(name, margin, error, needs, proof=_CROSSINGS, computed=count).described(
        stated="no two links cross",
        witness={"crossing": [net.agents(p) for p in net.crossings[:_SHOWN]]} if count else {"nearest": which},
        detail=f"{net.crossing_text}{near}",
    )


def _graph(net: Net, needs: Needs) -> Claim:
    """Return the printed claim that the graph is planar, met if the net is drawn without crossings."""
    is_drawn = net.m < 3 and len(net.crossings) == 0 and net.closest > 0.0
    planar = is_drawn or is_planar(net.n, net.links)
    witness = kuratowski(net.n, net.links) if not planar and len(net.links) <= _WITNESS_LIMIT else None
    remark = "" if witness is None else f"; it contains a subdivision of {witness.kind} with {len(witness.links)} links"
    return by_count("i-graph", 0 if planar else 1, needs, computed="planar" if planar else "not planar").described(
        stated="the graph of the net is planar (as printed)",
        witness=None if witness is None else vars(witness),
        detail=f"the graph of {len(net.links)} links on {net.n} agents is {'' if planar else 'not '}planar{remark}; "
        f"a planar one has at most {planar_bound(net.n)}",
    )


def _bound(net: Net, needs: Needs, name: str, bound: int, text: str, *, proof: str | None = _COUNTS) -> Claim:
    count = len(net.links)
    return counted(name, bound, count, count, needs, proof=proof, computed=count).described(
        stated=f"at most {bound} links",
        detail=f"{count} links, {text} = {bound} (Harborth's number is {harborth(net.n)})",
    )


def _incomplete(net: Net, needs: Needs) -> Claim:
    missing = net.n * (net.n - 1) // 2 - len(net.links)
    return by_count("iii", 0 if missing else 1, needs, proof=_COUNTS, computed=missing).described(
        stated="at least one pair is not linked",
        witness=_unlinked(net) if missing else None,
        detail=f"{missing} of {net.n * (net.n - 1) // 2} pairs of agents are not linked",
    )


def _unlinked(net: Net) -> list[int]:
    """Return an unlinked pair: an agent with the fewest neighbours, and one outside its neighbours."""
    count = np.bincount(net.links.ravel(), minlength=net.n)
    i = int(np.argmin(count))
    link_agents = net.links[(net.links == i).any(axis=1)].ravel()
    return [i, int(np.setdiff1d(np.arange(net.n), np.append(link_agents, i))[0])]


def _quantitative(net: Net) -> Claim:
    """Return the claim that two crossing links of length at most ℓ have two agents within ℓ/√2."""
    name, stated = "extension-quantitative", "of two crossing links of lengths at most ℓ, two agents are within ℓ/√2"
    if not len(net.crossings):
        return vacuous(name, "no links cross", computed=0, stated=stated, proof=_CROSSINGS)
    longest, shortest = crossing_lengths(net)
    spare = longest - 2.0 * shortest
    unclear = np.flatnonzero(np.abs(spare) <= _CERTAIN * longest)
    exact = [holds_exactly(net, net.links[net.crossings[k]]) for k in unclear]
    failing = np.concatenate([np.flatnonzero(spare < -_CERTAIN * longest), unclear[~np.array(exact, dtype=bool)]])
    slack = np.sqrt(0.5 * longest) - np.sqrt(shortest)
    worst = int(failing[0]) if failing.size else int(np.argmin(slack))
    return by_count(
        name,
        failing.size,  # each sign is certain: in whole numbers where floats cannot decide
        computed=net.crossing_count,
        stated=stated,
        witness=net.agents(net.crossings[worst]),
        proof=_CROSSINGS,
        detail=f"{net.crossing_text}; the nearest pairs are closer than ℓ/√2 by {slack[worst] / net.d:.3g} d or more",
    )


def crossing_lengths(net: Net) -> tuple[FloatArray, FloatArray]:
    """Return each crossing's longer squared link length and the least squared distance of its four agents."""
    agents = net.links[net.crossings].reshape(-1, 4)
    squared = [
        np.where(agents[:, i] == agents[:, j], np.inf, ((net.q[agents[:, i]] - net.q[agents[:, j]]) ** 2).sum(axis=1))
        for i, j in combinations(range(4), 2)
    ]
    return np.maximum(squared[0], squared[-1]), np.min(squared, axis=0)


def holds_exactly(net: Net, two: LinkArray) -> bool:
    """Return whether two of the agents of two crossing links are within ℓ/√2, in exact arithmetic."""

    def squared(i: Any, j: Any) -> Fraction:
        return sum(((Fraction(a) - Fraction(b)) ** 2 for a, b in zip(net.q[i], net.q[j], strict=True)), Fraction(0))

    longest = max(squared(i, j) for i, j in two)
    return 2 * min(squared(i, j) for i, j in combinations(sorted(set(two.ravel().tolist())), 2)) <= longest


def _unless_open(net: Net, claim: Claim) -> Claim:
    """Return a claim with refuted changed to inconclusive if inexact positions leave links uncertain."""
    if not net.off or claim.status != "refuted":
        return claim
    return replace(claim, status="inconclusive", detail=f"{claim.detail}; positions are known to {net.off:.3g}")


def check(q: FloatArray, d: float, r: float, tolerances: Tolerances, *, off: float = 0.0) -> Checked:
    """Return hypotheses and claims of Theorem 5 and its extension for a configuration with position error `off`."""
    net = Net(q, d, r, off)
    lattice = _lattice_hypotheses(net, tolerances)
    wide = _dimension("m = 2 or 3", net.m > 1, net)
    plane, count_need = _dimension("m = 2", net.m == 2, net), _dimension("n >= 3", net.n >= 3, net)
    more, far = _dimension("n > m + 1", net.n > net.m + 1, net), _far_apart(net, net.r, "r/√2")
    longest = float(net.lengths.max(initial=0.0))
    length_need = _far_apart(net, longest, "ℓ/√2, ℓ the longest link")
    printed_value = 3 * net.n - 6
    claims = [
        uncrossed(net, [*lattice, wide], "i"),
        _graph(net, [*lattice, wide]),
        _bound(net, [*lattice, plane, count_need], "ii", printed_value, "3n - 6"),
        _bound(net, [*lattice, plane], "ii-sharp", harborth(net.n), "floor(3n - sqrt(12n - 3))", proof=None),  # cited
        _incomplete(net, [*lattice, more]),
        uncrossed(net, [far], "extension"),
        uncrossed(net, [length_need], "extension-lengths"),
        _bound(net, [length_need, plane, count_need], "extension-links", printed_value, "3n - 6"),
        _quantitative(net),
    ]
    return [*lattice, wide, plane, count_need, more, far, length_need], [_unless_open(net, claim) for claim in claims]


def _check_terminal(seen: Observed, tolerances: Tolerances) -> Checked:
    d, r = seen.law.lattice
    return check(np.asarray(seen.given.q[-1]), d, r, tolerances, off=seen.accuracy_of_end)


_STATEMENT = (
    "Of an α-lattice of scale d and ratio κ > 1 with distinct positions: (i) no two edges cross, for m = 2 and 3 (and, "
    "as printed, the graph is planar: true of m = 2, false of m = 3, erratum E5); (ii) for m = 2 and n >= 3 there are "
    "at most 3n - 6 links, and sharply ⌊3n - √(12n - 3)⌋ (Harborth); (iii) with n > m + 1 agents it is not complete. "
    "Extension to every net: if all pairs are farther apart than r/√2 (or only ℓ/√2, ℓ the longest link), no two "
    "links cross, and in the plane there are at most 3n - 6; if two links of lengths at "
    "most ℓ cross, some two of their agents are within ℓ/√2 of each other. "
    f"Distances within {GUARD:g} r of r, or within the rounding of the positions, count as r."
)
_SAME: dict[str, Any] = {
    "source": "Olfati-Saber 2006, Theorem 5; Harborth's number and the extension are added here",
    "references": ("olfati-saber-2006", "harborth-1974"),
    "ours": _OURS,
}
theorem = Theorem(
    "os-5", "α-lattices: no crossing, few links, not complete", _STATEMENT, kind="configuration", check=check, **_SAME
)
on_last_state = run_theorem(
    "os-5-terminal",
    title="Theorem 5 on the last state of a run",
    statement=f"Checked on the last state of a run. {_STATEMENT}",
    claims=CLAIMS,
    law=has_lattice,
    on_motion=True,
    **_SAME,
)(_check_terminal)
