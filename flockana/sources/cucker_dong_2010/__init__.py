"""Cucker and Dong (2010): collision avoidance by a repulsion that ends when velocities agree."""

from flockana.base.lazy_imports import attach_stub

__getattr__, __dir__, __all__ = attach_stub(__name__, __file__)
