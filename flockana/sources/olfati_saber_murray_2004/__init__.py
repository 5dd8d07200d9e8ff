"""Olfati-Saber and Murray (2004): consensus of the first order, on directed nets and under a delay."""

from flockana.base.lazy_imports import attach_stub

__getattr__, __dir__, __all__ = attach_stub(__name__, __file__)
