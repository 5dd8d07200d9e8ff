"""Krick, Broucke and Francis (2009): formations held by distances."""

from flockana.base.lazy_imports import attach_stub

__getattr__, __dir__, __all__ = attach_stub(__name__, __file__)
