"""Theorems and errata: every file of this package that defines `THEOREM` is in the catalogue."""

from flockana.theorems.catalogue import theorem, theorems, verify
from flockana.theorems.theorem import Claim, Hypothesis, Status, Theorem, Tolerances, Verdict

__all__ = ["Claim", "Hypothesis", "Status", "Theorem", "Tolerances", "Verdict", "theorem", "theorems", "verify"]
