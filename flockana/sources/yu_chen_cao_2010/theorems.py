"""Ren and Atkins; Yu, Chen and Cao: second-order consensus on a digraph, by the eigenvalues of its Laplacian."""

import numpy as np

from flockana.certified.balls import exact
from flockana.certified.consensus_polynomials import (
    laplacian_of,
    moving_eigenvalues,
    stable_off_agreement,
    velocity_threshold,
)
from flockana.sources.yu_chen_cao_2010.laws import NetConsensus
from flockana.theorems.net_roots import has_root
from flockana.theorems.theorem import Checked, Claim, Hypothesis, Needs, Tolerances
from flockana.theorems.theorem_toolkit import (
    Enclosure,
    Observed,
    condition,
    judged,
    law_is,
    limit_claim,
    run_theorem,
    vacuous,
)

_PROOF = "net-consensus"
_MORE = "raise β or lower α"
_MOST = 30  # agents of which equality is decided with rationals


def gains_positive(law: NetConsensus) -> Hypothesis:
    """Return the hypothesis α, β > 0."""
    smallest = min(law.position, law.velocity)
    text = f"α = {law.position:g}, β = {law.velocity:g}"
    return condition("α > 0 and β > 0", smallest > 0.0, smallest, text, remedy="raise both above 0")


def threshold_exceeded(law: NetConsensus) -> Hypothesis:
    """Return the hypothesis β²/α > max Im²μ/(Re μ |μ|²) of a rooted net, by enclosures or exact algebra."""
    name = "β²/α > max Im²μ/(Re μ |μ|²) over μ ≠ 0"
    laplacian = laplacian_of(law.weights)
    bound, ratio = velocity_threshold(moving_eigenvalues(laplacian)), exact(law.velocity) ** 2 / exact(law.position)
    margin, text = (
        float((ratio - bound).mid()),
        f"β²/α = {float(ratio.p) / float(ratio.q):.6g}, the bound {bound.str(6, radius=False)}",
    )
    if ratio > bound or ratio < bound:
        return condition(name, bool(ratio > bound), margin, text, remedy=_MORE)
    if len(law.weights) > _MOST:
        return Hypothesis(name, "assumed", margin, f"{text}; equal to 30 digits")
    is_exceeded = stable_off_agreement(laplacian, law.position, law.velocity)
    return condition(name, is_exceeded, margin, f"{text}, decided exactly", remedy=_MORE)


def _consensus(seen: Observed, needs: Needs) -> Claim:
    final_spreads = [float(np.ptp(series[-1], axis=0).max()) for series in (seen.run.q, seen.run.p)]
    return limit_claim("consensus", needs, proof=_PROOF, computed=final_spreads).described(
        stated="q_i - q_j -> 0 and p_i - p_j -> 0 from every start",
        detail=f"at the end positions differ by {final_spreads[0]:.3g} and velocities by {final_spreads[1]:.3g}",
    )


def _never(gains: Hypothesis, root: Hypothesis, above: Hypothesis | None) -> Claim:
    """Return the claim that agents do not agree from some start, vacuous if the conditions are met."""
    missed = root if above is None else above
    opposite_status = {"met": "unmet", "unmet": "met", "assumed": "assumed"}[missed.status]
    requirement = Hypothesis(f"not: {missed.name}", opposite_status, detail=missed.detail)  # type: ignore[arg-type]
    if requirement.status == "unmet":
        return vacuous("some-start", requirement)
    return judged("some-start", Enclosure.of(0.0), [gains, requirement], about="all", proof=_PROOF).described(
        stated="from some start positions or velocities never agree", detail=missed.detail
    )


@run_theorem(
    "net-consensus",
    title="Second-order consensus on a digraph: a root, and enough damping for the net's turns",
    source="Ren and Atkins 2007; Yu, Chen and Cao 2010, in our words",
    law=law_is("consensus over a net", NetConsensus),
    claims=("consensus", "some-start"),
    references=("ren-atkins-2007", "yu-chen-cao-2010"),
)
def theorem(seen: Observed, tolerances: Tolerances) -> Checked:
    """Let u = -L(αq + βp) with α, β > 0 and the Laplacian L of a fixed digraph. Positions and velocities agree from
    every start if and only if one agent is heard by all, directly or through others, and β²/α > max Im²μ/(Re μ |μ|²)
    over the eigenvalues μ ≠ 0 of L. On a directed ring of n agents the bound is ½ cot²(π/n).
    """
    law: NetConsensus = seen.law
    gains, root = gains_positive(law), has_root(law.weights)
    threshold_claim = threshold_exceeded(law) if gains.status == root.status == "met" else None
    requirements = [gains, root, *([] if threshold_claim is None else [threshold_claim])]
    return requirements, [_consensus(seen, requirements), _never(gains, root, threshold_claim)]
