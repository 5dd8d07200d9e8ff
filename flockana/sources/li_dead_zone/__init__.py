"""Dead-zone flocking (Li, Yuan and Liu): the law with and without leaders, errata L1 to L10."""

from flockana.base.lazy_imports import attach_stub

__getattr__, __dir__, __all__ = attach_stub(__name__, __file__)
