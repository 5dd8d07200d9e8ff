"""Laws of motion: the base class in `law.py`, and one file for each family."""

from flockana.base.lazy_imports import attach_stub

__getattr__, __dir__, __all__ = attach_stub(__name__, __file__)
