"""Moreau (2005); Ren and Beard (2005): averaging over nets that change with time."""

from flockana.base.lazy_imports import attach_stub

__getattr__, __dir__, __all__ = attach_stub(__name__, __file__)
