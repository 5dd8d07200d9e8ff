"""Equilibria of laws with a potential: solvers, classification, searches, and barriers against collisions."""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
