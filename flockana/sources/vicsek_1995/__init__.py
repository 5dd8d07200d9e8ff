"""Vicsek et al. (1995), Jadbabaie, Lin and Morse (2003): averaged headings."""

from flockana.base.lazy_imports import attach_stub

__getattr__, __dir__, __all__ = attach_stub(__name__, __file__)
