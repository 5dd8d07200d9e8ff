"""Olfati-Saber (2006): Theorems 1, 3, 5 and 6 on Algorithms 1 to 3, and the paper's simulations."""

from flockana.base.lazy_imports import attach_stub

__getattr__, __dir__, __all__ = attach_stub(__name__, __file__)
