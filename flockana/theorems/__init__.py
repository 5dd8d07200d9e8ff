"""Theorems and errata: each file of this package that defines `THEOREM` is found by itself."""

from flockana.theorems.catalogue import theorem, theorems, verify
from flockana.theorems.theorem import Claim, Hypothesis, Theorem, Tolerances, Verdict

__all__ = ["Claim", "Hypothesis", "Theorem", "Tolerances", "Verdict", "theorem", "theorems", "verify"]
