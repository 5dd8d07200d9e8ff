"""Motsch and Tadmor (2011): alignment with sums of each agent's own, where influence is relative."""

from flockana.base.lazy import attach_stub

__getattr__, __dir__, __all__ = attach_stub(__name__, __file__)
