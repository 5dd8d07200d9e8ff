"""Carrillo, Choi, Mucha and Peszek (2017), Ahn, Choi, Ha and Lee (2012): alignment with a singular weight."""

from flockana.base.lazy_imports import attach_stub

__getattr__, __dir__, __all__ = attach_stub(__name__, __file__)
