"""Claims about the share of random starts for which something holds, with exact confidence intervals."""

from collections.abc import Iterable
from typing import Any

from flockana.base.binomial_intervals import clopper_pearson
from flockana.theorems.claims import judged
from flockana.theorems.enclosure import Enclosure
from flockana.theorems.theorem import Claim

CONFIDENCE = 0.95
INTERVAL_ERROR = 1e-9  # of the ends of an interval, which are quantiles of a beta distribution


def interval(count: int, size: int, *, undecided: int = 0) -> tuple[float, float]:
    """Return the exact Clopper-Pearson confidence interval of a proportion, `count` successes in `size`."""
    # Outcomes that are undecided count against the lower end and for the upper one.
    low, _ = clopper_pearson(count, size, level=CONFIDENCE)
    _, high = clopper_pearson(count + undecided, size, level=CONFIDENCE)
    return float(low), float(high)


def always(name: str, holds: Iterable[bool | None], what: str, stated: str, *, witness: Any = None) -> Claim:
    """Return a claim that every start has a property: refuted if the proportion is certainly below 1."""
    return _judged(name, list(holds), 1.0, what, about="all", stated=stated, witness=witness)


def mostly(name: str, holds: Iterable[bool | None], what: str, stated: str, *, witness: Any = None) -> Claim:
    """Return a claim that at least half of random starts have a property, from a confidence interval."""
    return _judged(name, list(holds), 0.5, what, stated=stated, witness=witness)


def _judged(name: str, holds: list[bool | None], least: float, what: str, **fields: Any) -> Claim:
    """Return a claim about the proportion of starts with a property; None entries are undecided."""
    count, case_count, unknown = sum(map(bool, holds)), len(holds), sum(answer is None for answer in holds)
    low, high = interval(count, case_count, undecided=unknown)
    text = f", undecided in {unknown}" if unknown else ""
    return judged(
        name,
        Enclosure(low, count / max(case_count, 1), high).widened(INTERVAL_ERROR) - least,
        computed={"holds": count, "of": case_count, "share": (low, high)},
        detail=f"{what} in {count} of {case_count} seeds{text}: a share of {low:.2f} to {high:.2f} ({CONFIDENCE:.0%})",
        **fields,
    )
