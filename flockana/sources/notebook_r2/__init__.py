"""The R² notebook: Algorithms 1 and 2 with a tenfold push of pairs that are too close."""

from flockana.base.lazy import attach_stub

__getattr__, __dir__, __all__ = attach_stub(__name__, __file__)
