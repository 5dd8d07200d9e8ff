"""Theorems and errata: all that the files of this package define are in the catalogue."""

from flockana.theorems.catalogue import theorem, theorems
from flockana.theorems.theorem import Claim, Hypothesis, Status, Theorem, Tolerances, Verdict
from flockana.theorems.verification import verify

__all__ = ["Claim", "Hypothesis", "Status", "Theorem", "Tolerances", "Verdict", "theorem", "theorems", "verify"]
