"""Gazi and Passino (2003): swarms of first order with linear attraction and repulsion of bounded range."""

from flockana.base.lazy_imports import attach_stub

__getattr__, __dir__, __all__ = attach_stub(__name__, __file__)
