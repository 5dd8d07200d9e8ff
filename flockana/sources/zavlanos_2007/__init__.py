"""Zavlanos et al. (2007), Ji and Egerstedt (2007): flocks that keep their links."""

from flockana.base.lazy_imports import attach_stub

__getattr__, __dir__, __all__ = attach_stub(__name__, __file__)
