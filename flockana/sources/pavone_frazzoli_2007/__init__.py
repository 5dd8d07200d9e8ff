"""Pavone and Frazzoli (2007): cyclic pursuit with an offset angle."""

from flockana.base.lazy_imports import attach_stub

__getattr__, __dir__, __all__ = attach_stub(__name__, __file__)
