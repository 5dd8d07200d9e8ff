"""Cucker and Dong (2010): flocks that avoid collisions by a repulsion which ends with the differences of velocities."""

from flockana.base.lazy import attach_stub

__getattr__, __dir__, __all__ = attach_stub(__name__, __file__)
