"""Wang and Xiao (2010): finite-time agreement of velocities over an undirected net."""

from flockana.base.lazy_imports import attach_stub

__getattr__, __dir__, __all__ = attach_stub(__name__, __file__)
