"""Wang, Ames and Egerstedt (2017): a safety filter that keeps agents apart by control barrier functions."""

from flockana.base.lazy_imports import attach_stub

__getattr__, __dir__, __all__ = attach_stub(__name__, __file__)
