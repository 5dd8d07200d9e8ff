"""Yu, Chen and Cao (2010), Ren and Atkins (2007): second-order consensus on digraphs."""

from flockana.base.lazy_imports import attach_stub

__getattr__, __dir__, __all__ = attach_stub(__name__, __file__)
