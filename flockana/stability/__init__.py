"""Linearised stability: Jacobians, modes, transfer functions, margins, norms and the design of gains."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
