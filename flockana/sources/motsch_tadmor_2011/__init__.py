"""Motsch and Tadmor (2011): alignment normalised by each agent's own sum of influences."""

from flockana.base.lazy_imports import attach_stub

__getattr__, __dir__, __all__ = attach_stub(__name__, __file__)
