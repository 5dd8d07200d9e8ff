"""Scalar functions from generated text, compiled as hand-written ones are.

The text is written by this package, from a formula that its own grammar has read.
"""

from functools import lru_cache

from flockana.jit import Kernel
from flockana.kernels.bound_templates import made
from flockana.kernels.pair_kernels import PairKernels, lift

_KEPT = 64  # compiled formulas
_MATH = "sqrt, exp, log, tan, sinh, cosh, tanh, asin, acos, atan, asinh, acosh, atanh"
_IMPORTS = f"""from math import {_MATH}

from flockana.jit import register_jitable
from flockana.kernels.sine_and_cosine import cosine, sine
from flockana.kernels.integral_tables import on_panels


@register_jitable
"""


def generated(text: str, name: str) -> Kernel:
    """Return a named function defined in a text, for compiled and interpreted use.

    Examples
    --------
    >>> generated("def NAME(x):\\n    return cosine(x)*x", "f")(0.0)
    0.0
    """
    kernel: Kernel = getattr(made(_IMPORTS + text.replace("NAME", name) + "\n", name), name)
    return kernel


@lru_cache(maxsize=_KEPT)
def generated_kernels(
    pair: str, slope: str, potential: str, adjacency_slope: str, norm: str | None = None
) -> PairKernels:
    """Return the pair sums of a law with generated scalar functions; equal texts share one module."""
    texts = {"pair": pair, "slope": slope, "potential": potential, "adjacency_slope": adjacency_slope}
    functions = (generated(text, name) for name, text in texts.items())
    return lift(*functions, norm=None if norm is None else generated(norm, "norm"))
