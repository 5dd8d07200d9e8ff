"""Sections of the report beside its verdicts."""

from dataclasses import dataclass

# theorems that the section on linearised stability shows: measured decay, and margins
DECAYS = ("linearised-decay", "linearised-decay-terminal")
MARGINS = ("delay-margin", "sampling-margins", "heterogeneous-gains")
MANY_LAWS, LINEARISED = "one start under many laws", "linearised flocks"


@dataclass(frozen=True)
class Section:
    """Section to be built: a name (`MANY_LAWS` or `LINEARISED`) and the seed of its start."""

    name: str
    seed: int = 0
