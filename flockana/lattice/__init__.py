"""α-lattices: build them, measure any configuration, find crossings, test planarity and rigidity."""

from flockana.base.lazy_imports import attach_stub

__getattr__, __dir__, __all__ = attach_stub(__name__, __file__)
