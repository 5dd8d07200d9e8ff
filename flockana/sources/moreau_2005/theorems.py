"""Moreau; Ren and Beard: averaging agents agree if the nets of every bounded time window have a common root."""

import numpy as np

from flockana.sources.moreau_2005.laws import NetAveraging
from flockana.theorems.claims import by_count, judged, run_theorem, vacuous
from flockana.theorems.net_roots import closed_groups, describe_groups
from flockana.theorems.theorem import Checked, Claim, Hypothesis, Needs, Tolerances, unmet
from flockana.theorems.theorem_toolkit import EPS, Enclosure, Observed, condition, law_is, limit_claim

_LAW = law_is("averaging over nets in turn", NetAveraging)
_PROOF = "rooted-averaging"
_GROWS = "growing-windows"
HALVES = (  # agent 1 hears 0, is heard by 0, hears 2, is heard by 2
    ((1.0, 0.0, 0.0), (0.5, 0.5, 0.0), (0.0, 0.0, 1.0)),
    ((0.5, 0.5, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)),
    ((1.0, 0.0, 0.0), (0.0, 0.5, 0.5), (0.0, 0.0, 1.0)),
    ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.5, 0.5)),
)


def windows_rooted(law: NetAveraging) -> tuple[Hypothesis, Hypothesis]:
    """Return the hypotheses that every window of some length has a root, and that all nets together have none."""
    nets, grows = np.array(law.nets), np.array(law.growth) > 0
    together = closed_groups(nets.sum(axis=0))
    rootless_claim = condition("the nets have no root together", len(together) > 1, detail=describe_groups(together))
    name, remedy = "the nets of every window of T steps have a root together, for some T", ""
    if not grows.any():
        text, holds = f"T = {sum(law.lengths)}: {describe_groups(together)}", len(together) == 1
        remedy = "let all but one of these groups hear another"
    else:  # a net acts for longer and longer, so that long windows show it alone
        alone = [(k, closed_groups(nets[k])) for k in np.flatnonzero(grows).tolist()]
        lacking = [(k, groups) for k, groups in alone if len(groups) > 1]
        holds, text = not lacking, f"T = {sum(law.lengths) + 1}: each net that acts ever longer has a root"
        if lacking:
            text = f"net {lacking[0][0]} acts ever longer, in which {describe_groups(lacking[0][1])}"
            remedy = "keep the lengths bounded"
    return condition(name, holds, detail=text, remedy=remedy), rootless_claim


def _hull(seen: Observed, needs: Needs) -> Claim:
    minimum, maximum = seen.run.q.min(axis=1), seen.run.q.max(axis=1)
    out = np.flatnonzero(((np.diff(minimum, axis=0) < 0.0) | (np.diff(maximum, axis=0) > 0.0)).any(axis=1))
    spread = (maximum - minimum).max(axis=1)
    return by_count("hull", out.size, needs, proof=_PROOF, computed=float(spread[-1])).described(
        stated="along no axis the greatest place ever rises, or the least falls",
        witness={"steps at which one does": int(out.size), "first": int(out[0]) if out.size else None},
        detail=f"the extent goes from {spread[0]:.4g} to {spread[-1]:.4g}",
    )


def _agreement(seen: Observed, needs: Needs) -> Claim:
    spread = float(np.ptp(seen.run.q[-1], axis=0).max())
    return limit_claim("agreement", needs, proof=_PROOF).described(
        computed=spread, stated="q_i - q_j -> 0 from every start", detail=f"at the end places differ by {spread:.3g}"
    )


@run_theorem(
    _PROOF,
    title="Averages over changing nets agree, if every window of some length has a root",
    source="Moreau 2005; Ren and Beard 2005, in our words; hull and some-start ours",
    law=_LAW,
    claims=("agreement", "hull", "some-start"),
    ours=("hull", "some-start"),
    references=("moreau-2005", "ren-beard-2005", "jadbabaie-lin-morse-2003", "flockana"),
)
def theorem(seen: Observed, tolerances: Tolerances) -> Checked:
    """Let q_i become Σ_j w_ij q_j, rows summing to 1, all w_ii and all other weights that are not 0 at least an ε > 0.
    If for some T in the nets of every T steps together one agent is heard by all, directly or through others, all agree
    from every start. No agent ever leaves the extent of the places before. If all nets together have no such root, some
    start never agrees. Where the root is an agent who hears nobody all come to it: a leader.
    """
    floor = min(min(np.diag(np.array(net))) for net in seen.law.nets)
    share_need = condition("each agent keeps a share of its own place", floor > 0.0, floor, f"least w_ii = {floor:g}")
    windows, rootless_claim = windows_rooted(seen.law)
    some_claim = judged("some-start", Enclosure.of(0.0), [rootless_claim], about="all", proof=_PROOF)
    return [], [
        _agreement(seen, [share_need, windows]),
        _hull(seen, []),
        vacuous("some-start", rootless_claim)
        if rootless_claim.status == "unmet"
        else some_claim.described(stated="from some start places never agree", detail=rootless_claim.detail),
    ]


@run_theorem(
    _GROWS,
    title="Averages need not agree where every round has a root, but rounds grow",
    source="Ours, on Moreau 2005",
    law=_LAW,
    claims=("apart",),
    references=("moreau-2005", "flockana"),
    author="flockana",
)
def growing(seen: Observed, tolerances: Tolerances) -> Checked:
    """Let agent 1, between agents 0 and 2 on a line, average in halves with 0 for L steps, then 0 with 1 for one, then
    1 with 2 for L, then 2 with 1 for one, L >= 2 rising by one or more from round to round. Each round has a root, and
    the distance of 0 and 2 stays above 1 - 2^(1-L) times the first, L of the first round.
    """
    law, q = seen.law, seen.given.q[0]
    length, growth = law.lengths[0], law.growth[0]
    like = law.nets == HALVES and law.lengths == (length, 1, length, 1) and law.growth == (growth, 0, growth, 0)
    text = f"lengths {law.lengths}, growth {law.growth}"
    needs = [condition("agent 1 hears 0 and 2 in turn, ever longer", like and length >= 2 and growth >= 1, detail=text)]
    ends = sorted(q[[0, 2], 0].tolist()) if q.shape == (3, 1) else [0.0, 0.0]
    between = ends[0] < ends[1] and ends[0] <= q[1, 0] <= ends[1]
    needs.append(
        condition(
            "on a line, agent 1 between 0 and 2", bool(between), detail=f"at {np.array2string(q[:3, 0], precision=4)}"
        )
    )
    if unmet(needs):
        return needs, []
    apart = np.abs(seen.run.q[:, 2, 0] - seen.run.q[:, 0, 0])
    share = 1.0 - 2.0 ** (1 - length)
    error = 4.0 * EPS * float(np.abs(seen.run.q).max()) * (1.0 + (seen.t[-1] - seen.t[0]) / law.dt)
    margin = Enclosure.around(float(apart.min()) - share * apart[0], error)
    claim = judged("apart", margin, needs, about="all", proof=_GROWS, computed=float(apart.min() / apart[0])).described(
        stated=f"above {share:g} of the first distance for ever",
        detail=f"the least seen is {apart.min() / apart[0]:.6g} of the first",
    )
    return needs, [claim]
