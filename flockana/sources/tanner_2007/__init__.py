"""Tanner, Jadbabaie and Pappas (2007): potentials and velocity consensus along a net."""

from flockana.base.lazy_imports import attach_stub

__getattr__, __dir__, __all__ = attach_stub(__name__, __file__)
