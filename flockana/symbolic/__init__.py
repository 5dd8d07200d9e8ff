"""Mathematics of flocking in sympy: scalar functions, potentials, energies, transfer functions.

One of three witnesses of every fact (a derivation here, a fast kernel, a test that holds them together),
this layer imports no kernel. Identities come out as computed residuals, for generic n from one generic pair
and one generic agent, and again written out for a concrete small flock. Every result prints as LaTeX, by
itself in a notebook.

Examples
--------
>>> from flockana import symbolic
>>> symbolic.algorithm1_identity(m=2).residual, symbolic.e1_identity(m=2).holds
(0, False)
"""

from flockana.base.lazy_imports import attach_stub

__getattr__, __dir__, __all__ = attach_stub(__name__, __file__)
