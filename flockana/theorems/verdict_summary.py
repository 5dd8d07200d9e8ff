"""One-line verdict status with counts, and its numbers as plain data."""

import math
from collections.abc import Iterable
from itertools import groupby
from typing import Any

from flockana.theorems.claim import BYLINES, Claim, Hypothesis, Status, does_not_hold

_SHORT = 60  # characters of a statement that is quoted; a longer one is named


def headline(
    status: Status, claims: tuple[Claim, ...], further: tuple[Claim, ...], hypotheses: tuple[Hypothesis, ...]
) -> str:
    """Return the counts of the author's claims by status, then each correction and extension with its status."""
    other_claims = sorted(further, key=lambda claim: claim.by)
    texts = (f"{BYLINES[author]}: {_listed(group)}" for author, group in groupby(other_claims, lambda c: c.by))
    return "; ".join([_counts(status, claims, hypotheses), *texts])


def _counts(status: Status, claims: tuple[Claim, ...], hypotheses: tuple[Hypothesis, ...]) -> str:
    """Return in words how many claims have the deciding status, then the other counts."""
    if not claims:
        return "no claim"
    order = dict.fromkeys((status, "refuted", "inconclusive", "verified", "vacuous"))
    counts = {item: sum(claim.status == item for claim in claims) for item in order}
    suffixes = {status: f" of {len(claims)}"}
    texts = [f"{count}{suffixes.get(item, '')} {item}" for item, count in counts.items() if count]
    return ", ".join(texts) + (_reason(claims, hypotheses) if counts["vacuous"] else "")


def _reason(claims: tuple[Claim, ...], hypotheses: tuple[Hypothesis, ...]) -> str:
    """Return in words why claims are vacuous: the first unmet hypothesis, or the claim's own detail."""
    silent = [claim for claim in claims if claim.status == "vacuous"]
    requirements = [need for claim in silent for need in (*claim.needs, *hypotheses) if need.status == "unmet"]
    if not requirements:
        return f": {silent[0].detail}" if silent[0].detail else ""
    return f": {does_not_hold(requirements[0].name)}"


def merged(claims: Iterable[Claim]) -> list[tuple[str, Claim]]:
    """Return claims with their names; adjacent vacuous ones with equal reasons are merged."""

    def reason(claim: Claim) -> tuple[str, str]:
        is_silent = claim.status == "vacuous" and claim.computed is None
        return claim.by, claim.detail if is_silent else claim.name

    groups = (list(group) for _, group in groupby(claims, reason))
    return [(", ".join(claim.name for claim in group), group[0]) for group in groups]


def _listed(claims: Iterable[Claim]) -> str:
    """Return a text with each claim in short and its status; vacuous claims only if all are."""
    claims_given = tuple(claims)
    counted_claims = [claim for claim in claims_given if claim.status != "vacuous"] or list(claims_given[:1])
    return "; ".join(dict.fromkeys(f"{_short(claim)}, {claim.status}" for claim in counted_claims))


def _short(claim: Claim) -> str:
    """Return a claim's statement if short, else its name."""
    return claim.stated if isinstance(claim.stated, str) and len(claim.stated) <= _SHORT else claim.name


def overall(statuses: Iterable[Status]) -> Status:
    """Return a theorem's status from its claims: refuted, inconclusive, verified or vacuous, in this order.

    Examples
    --------
    >>> overall(["verified", "refuted"]), overall(["vacuous", "verified"]), overall([])
    ('refuted', 'verified', 'vacuous')
    """
    statuses_given = set(statuses)
    order: tuple[Status, ...] = ("refuted", "inconclusive", "verified")
    return next((status for status in order if status in statuses_given), "vacuous")


def plain(value: Any) -> Any:
    """Return a value as JSON data; infinities, NaN and unknown objects become text."""
    import numpy as np

    if isinstance(value, dict):
        return {str(k): plain(v) for k, v in value.items()}
    if isinstance(value, list | tuple):
        return [plain(v) for v in value]
    if isinstance(value, np.ndarray):
        return plain(value.tolist())
    if isinstance(value, np.generic):
        return plain(value.item())
    if isinstance(value, float) and not math.isfinite(value):
        return str(value)
    if value is None or isinstance(value, bool | int | float | str):
        return value
    return str(value)
