"""Linearised stability: Jacobians, modes, transfer functions, margins, norms and the design of gains."""

from flockana.base.lazy_imports import attach_stub

__getattr__, __dir__, __all__ = attach_stub(__name__, __file__)
