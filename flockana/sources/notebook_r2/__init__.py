"""R² notebook: Algorithms 1 and 2 with a tenfold repulsion of close pairs."""

from flockana.base.lazy_imports import attach_stub

__getattr__, __dir__, __all__ = attach_stub(__name__, __file__)
