"""Scalar functions from generated text, compiled as hand-written ones are.

The text is written by this package, from a formula that its own grammar has read. A function's name says what is in its
text, so that no two formulas share a symbol of machine code or a file of the cache.
"""

from __future__ import annotations

import hashlib
import math
from collections.abc import Callable
from functools import lru_cache
from typing import Any

from flockana.kernels import elementary
from flockana.kernels.compiling import register_jitable
from flockana.kernels.lift import PairKernels, lift, lift_scalar, source_digest
from flockana.kernels.scalars import on_panels

_MATH = ("sqrt", "exp", "log", "tan", "sinh", "cosh", "tanh", "asin", "acos", "atan", "asinh", "acosh", "atanh")
_KEPT = 64  # compiled formulas


def generated(text: str, name: str) -> Callable[..., Any]:
    """The function of a name that a text defines, for compiled and interpreted use.

    Parameters
    ----------
    text : str
        What `flockana.symbolic.printing.function_text` wrote: one definition, whose name ``NAME`` stands for.
    name : str
        What it is called, before a digest of the text.

    Examples
    --------
    >>> generated("def NAME(x):\\n    return cosine(x)*x", "f")(0.0)
    0.0
    """
    digest = hashlib.sha256(f"{text}{source_digest(elementary.sine)}".encode()).hexdigest()[:16]
    whole = f"{name}_{digest}"
    known = {each: getattr(math, each) for each in _MATH}
    known |= {"sine": elementary.sine, "cosine": elementary.cosine, "on_panels": on_panels}
    space: dict[str, Any] = {"__name__": __name__, "max": max, **known}
    # numba looks for the module of what it loads from its cache, so it must be one that there is
    exec(compile(text.replace("NAME", whole), f"<formula {digest}>", "exec"), space)  # our own text
    return register_jitable(space[whole])


@lru_cache(maxsize=_KEPT)
def generated_kernels(
    pair: str, slope: str, potential: str, adjacency_slope: str, norm: str | None = None
) -> PairKernels:
    """The sums over pairs of a law whose scalar functions are generated, the same for the same texts.

    Parameters
    ----------
    pair, slope, potential, adjacency_slope : str
        Texts of the functions that `lift` takes.
    norm : str, optional
        That of its norm, if the law begins with one.
    """
    texts = {"pair": pair, "slope": slope, "potential": potential, "adjacency_slope": adjacency_slope}
    functions = (generated(text, name) for name, text in texts.items())
    begins = None if norm is None else generated(norm, "norm")
    return lift(*functions, norm=begins, error_model="numpy")


@lru_cache(maxsize=_KEPT)
def generated_potential(text: str) -> Callable[..., Any]:
    """A generated potential over an array of squared distances.

    Parameters
    ----------
    text : str
        As `generated_kernels` takes it.
    """
    return lift_scalar(generated(text, "potential"), error_model="numpy")
