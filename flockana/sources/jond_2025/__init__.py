"""Bearing-distance flocking (Jond 2025): zone-based flocking, the minimal model, errata J1 to J19."""

from flockana.base.lazy_imports import attach_stub

__getattr__, __dir__, __all__ = attach_stub(__name__, __file__)
