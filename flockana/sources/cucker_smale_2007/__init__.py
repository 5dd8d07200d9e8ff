"""Cucker and Smale (2007), Ha and Liu (2009): velocity consensus of all agents."""

from flockana.base.lazy_imports import attach_stub

__getattr__, __dir__, __all__ = attach_stub(__name__, __file__)
