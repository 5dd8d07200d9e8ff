"""Theorems and errata: all that the files of this package define are in the catalogue."""

from flockana.theorems.catalogue import theorem, theorems, verify
from flockana.theorems.theorem import Claim, Hypothesis, Status, Theorem, Tolerances, Verdict

__all__ = ["Claim", "Hypothesis", "Status", "Theorem", "Tolerances", "Verdict", "theorem", "theorems", "verify"]
