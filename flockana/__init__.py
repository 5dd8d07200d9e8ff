"""flockana: does this flock provably do what the theorem says, and how does it behave near its equilibrium?

The public names stand in ``__init__.pyi``, once; each is imported when it is first used.
"""

from flockana.base.lazy import attach_stub

__getattr__, __dir__, __all__ = attach_stub(__name__, __file__)
