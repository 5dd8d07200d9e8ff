"""Requests for report sections other than the verdicts: comparison of laws, and linearised stability."""

from dataclasses import dataclass

# theorems that the section on linearised stability shows: measured decay, and margins
DECAYS = ("linearised-decay", "linearised-decay-terminal")
MARGINS = ("delay-margin", "sampling-margins", "heterogeneous-gains")
MANY_LAWS, LINEARISED = "one start under many laws", "linearised flocks"


@dataclass(frozen=True)
class Section:
    """Request for a report section, by name (`MANY_LAWS` or `LINEARISED`) and seed of its random start."""

    name: str
    seed: int = 0
