"""The MSN project (Isola 2024): Algorithms 1 and 2 in steps of its own, and its errata."""

from flockana.base.lazy_imports import attach_stub

__getattr__, __dir__, __all__ = attach_stub(__name__, __file__)
