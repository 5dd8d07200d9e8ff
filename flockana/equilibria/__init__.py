"""Equilibria of laws with a potential: solvers, classification, searches, and barriers against collisions."""

from flockana.base.lazy_imports import attach_stub

__getattr__, __dir__, __all__ = attach_stub(__name__, __file__)
