"""Olfati-Saber and Murray: consensus on a digraph: average value, rate, and admissible steps."""

import numpy as np

from flockana.certified.balls import exact
from flockana.certified.consensus_polynomials import laplacian_of, moving_eigenvalues
from flockana.sources.olfati_saber_murray_2004.laws import AverageConsensus
from flockana.theorems.claims import judged, run_theorem, vacuous
from flockana.theorems.net_roots import closed_groups, has_root
from flockana.theorems.theorem import Checked, Claim, Hypothesis, Needs, Tolerances, unmet
from flockana.theorems.theorem_toolkit import EPS, Enclosure, FloatArray, Observed, condition, law_is, limit_claim

_PROOF = "average-consensus"
Rows = tuple[tuple[float, ...], ...]


def is_balanced(weights: Rows) -> Hypothesis:
    """Return the hypothesis that each agent's weights of hearing and being heard are equal, exactly."""
    columns = [sum((exact(row[j]) for row in weights), exact(0.0)) for j in range(len(weights))]
    rows = [sum(map(exact, row), exact(0.0)) for row in weights]
    off = [abs(float((a - b).p) / float((a - b).q)) for a, b in zip(rows, columns, strict=True)]
    worst = int(np.argmax(off))
    text = f"agent {worst} hears {float(sum(weights[worst])):.6g} and is off by {off[worst]:.3g}"
    return condition("the net is balanced: each agent is heard as much as it hears", max(off) == 0.0, -max(off), text)


def is_strong(weights: Rows) -> Hypothesis:
    """Return the hypothesis that every agent is heard by every other, directly or through others."""
    group, n = closed_groups(weights)[0], len(weights)
    return condition("the net is strongly connected", len(group) == n, detail=f"{len(group)} of {n}")


def _agreement(seen: Observed, root: Hypothesis) -> Claim:
    spread = float(np.ptp(seen.run.q[-1], axis=0).max())
    return limit_claim("agreement", [root], proof=_PROOF).described(
        computed=spread, stated="q_i - q_j -> 0 from every start", detail=f"at the end places differ by {spread:.3g}"
    )


def average(seen: Observed, needs: Needs) -> Claim:
    """Return the claim that all agents tend to the average of their initial positions."""
    deviation = np.linalg.norm(seen.run.q[-1] - seen.run.q[0].mean(axis=0), axis=1).max()
    return limit_claim("average", needs, proof=_PROOF, computed=float(deviation)).described(
        stated="all tend to the average of the start", detail=f"at the end agents are up to {deviation:.3g} from it"
    )


def _elsewhere(root: Hypothesis, balanced: Hypothesis) -> Claim:
    """Return the claim that some start does not tend to the average, vacuous on a balanced net."""
    opposite_status = {"met": "unmet", "unmet": "met"}[balanced.status]
    requirement = Hypothesis(f"not: {balanced.name}", opposite_status, detail=balanced.detail)  # type: ignore[arg-type]
    if requirement.status == "unmet":
        return vacuous("some-start", requirement)
    return judged("some-start", Enclosure.of(0.0), [root, requirement], about="all", proof=_PROOF).described(
        stated="from some start agents do not tend to its average", detail=balanced.detail
    )


def slowest_rate(laplacian: FloatArray) -> float:
    """Return λ₂ of (L + Lᵀ)/2, a bound of the decay rate of disagreement, rounded down."""
    doubled_symmetric = laplacian + laplacian.T
    rounding = 8.0 * len(doubled_symmetric) * EPS * float(np.abs(doubled_symmetric).sum(axis=1).max())
    return 0.5 * (float(np.linalg.eigvalsh(doubled_symmetric)[min(1, len(doubled_symmetric) - 1)]) - rounding)


def decay(seen: Observed, needs: Needs, rate: float) -> Claim:
    """Return the claim that the disagreement falls at least at a given rate."""
    magnitude = np.sqrt(np.sum((seen.run.q - seen.run.q.mean(axis=1, keepdims=True)) ** 2, axis=(1, 2)))
    error = np.sqrt(seen.n) * seen.shape_error.max(axis=1) + 8.0 * EPS * np.abs(seen.run.q).max(axis=(1, 2))
    bound = magnitude[0] * np.exp(-rate * (seen.t - seen.t[0]))
    return judged("decay", Enclosure.around(bound - magnitude, error + error[0]), needs, proof=_PROOF).described(
        computed=float(magnitude[-1] / (magnitude[0] or 1.0)),
        stated=f"‖q - q̄‖ <= ‖q(0) - q̄‖ exp(-λ₂ t), λ₂ = {rate:.6g}",
        detail=f"λ₂ of (L + Lᵀ)/2 = {rate:.6g}; ‖q - q̄‖ goes from {magnitude[0]:.4g} to {magnitude[-1]:.4g}",
    )


def _steps(law: AverageConsensus, root: Hypothesis) -> Claim:
    """Return the claim that steps q_i + ε Σ_j a_ij (q_j - q_i) converge up to an ε of at least 1/Δ."""
    moving, degree = moving_eigenvalues(laplacian_of(law.weights)), max(map(sum, law.weights))
    limits = [2 * mu.real / (mu.real**2 + mu.imag**2) for mu in moving]
    shortest = min(limits, key=lambda one: float(one.mid())) if limits else None
    margin = (
        Enclosure.of(0.0)
        if shortest is None
        else Enclosure.around(float(shortest.mid()) * degree - 1.0, float(shortest.rad()) * degree + 8.0 * EPS)
    )
    text = "no step is too long" if shortest is None else f"ε < min 2 Re μ/|μ|² = {shortest.str(8, radius=False)}"
    return judged("steps", margin, [root], about="all", proof=_PROOF).described(
        computed=None if shortest is None else float(shortest.mid()),
        stated="I - εL agrees for 0 < ε < 1/Δ, and exactly for 0 < ε < min 2 Re μ/|μ|² over μ ≠ 0",
        detail=f"{text}; 1/Δ = {1.0 / degree:.6g}" if degree else text,
    )


@run_theorem(
    _PROOF,
    title="Consensus on a digraph is the average of the start exactly if the net is balanced",
    source="Olfati-Saber and Murray 2004; Olfati-Saber, Fax and Murray 2007 (steps), in our words; exact limit ours",
    law=law_is("consensus of the first order", AverageConsensus),
    claims=("agreement", "average", "some-start", "decay", "steps"),
    references=("olfati-saber-murray-2004", "olfati-saber-fax-murray-2007", "flockana"),
)
def theorem(seen: Observed, tolerances: Tolerances) -> Checked:
    """Let q' = -Lq with the Laplacian L of a fixed digraph. If one agent is heard by all, directly or through others,
    all agree from every start; then they tend to its average exactly if each agent is heard as much as it hears. There
    the disagreement falls at the rate λ₂ of (L + Lᵀ)/2 or faster, also while such nets are switched, at the least of
    their rates. Steps I - εL agree exactly for 0 < ε < min 2 Re μ/|μ|² over the eigenvalues μ ≠ 0 of L: never less than
    1/Δ, Δ the most that an agent hears.
    """
    law: AverageConsensus = seen.law
    root, balance_hypothesis = has_root(law.weights), is_balanced(law.weights)
    if unmet([root]):
        return [root], []
    return [root], [
        _agreement(seen, root),
        average(seen, [root, balance_hypothesis]),
        _elsewhere(root, balance_hypothesis),
        decay(seen, [balance_hypothesis, is_strong(law.weights)], slowest_rate(law.laplacian)),
        _steps(law, root),
    ]
