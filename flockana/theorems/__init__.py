"""Theorems and errata of the catalogue, defined in the files of this package."""

from flockana.theorems.catalogue import theorem, theorems
from flockana.theorems.theorem import Claim, Hypothesis, Status, Theorem, Tolerances, Verdict
from flockana.theorems.verification import verify

__all__ = ["Claim", "Hypothesis", "Status", "Theorem", "Tolerances", "Verdict", "theorem", "theorems", "verify"]
