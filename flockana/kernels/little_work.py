"""Little work in the interpreter: to compile a kernel takes as long as some ten thousand of its rounds there.

Only kernels run so whose text gives the same bits there: sums, products, quotients, square roots and comparisons are
rounded alike everywhere; powers and exponentials are not.
"""

import builtins
import dis
from collections.abc import Callable
from functools import cache, partial
from math import floor, sqrt
from types import FunctionType
from typing import Any

import numpy as np

from flockana.jit import Kernel

ENOUGH = 2000  # rounds of a kernel in one process, some twenty microseconds each, after which it is compiled
_FUNCTIONS = frozenset({abs, floor, len, max, min, range, sqrt})
_NAMES = frozenset(
    {"bool_", "copy", "empty", "floor", "inf", "int32", "int64", "isfinite", "isnan", "nan", "shape", "size"}
)
_NAMES |= {"sqrt", "uint32", "uint64", "zeros"}  # of numpy and of arrays
_POWERS = {"**", "**=", "@", "@="}


def for_little(kernel: Any, rounds: int) -> Callable[..., Any]:
    """Return a kernel, or its text for the interpreter as long as it has little work; `rounds` are those of its loops.

    The text must write nothing before it could fail: it is compiled then, and called again.
    """
    if not isinstance(kernel, Kernel) or kernel.is_compiled or kernel.rounds + rounds > ENOUGH:
        return kernel
    function = in_python(kernel)
    if function is None:
        return kernel
    kernel.rounds += rounds
    return partial(_interpret, kernel, function)


def _interpret(kernel: Kernel, function: Callable[..., Any], *arguments: Any) -> Any:
    """Run a kernel's text in the interpreter; where that raises, say of a quotient by 0, compiled code decides."""
    try:
        with np.errstate(all="ignore"):
            return _plain(function(*arguments))
    except (ArithmeticError, IndexError, TypeError, ValueError):
        return kernel(*arguments)


def _plain(result: Any) -> Any:
    """Return numbers as compiled code does: as Python's."""
    if isinstance(result, tuple):
        return tuple(map(_plain, result))
    return result.item() if isinstance(result, np.generic) else result


@cache
def in_python(kernel: Kernel) -> Callable[..., Any] | None:
    """Return a kernel's text as a function that calls others as text, too; None if its bits may be others."""
    function = kernel.py_func
    code, known, texts = function.__code__, function.__globals__, dict[str, Any]()
    if code.co_freevars or any(hasattr(each, "co_code") for each in code.co_consts):
        return None
    if any(each.opname == "BINARY_OP" and each.argrepr in _POWERS for each in dis.get_instructions(code)):
        return None
    for name in code.co_names:
        value = known.get(name, getattr(builtins, name, None))
        if isinstance(value, Kernel):
            texts[name] = in_python(value)
            if texts[name] is None:
                return None
        elif (callable(value) and value not in _FUNCTIONS) or (value is None and name not in _NAMES):
            return None
    return FunctionType(code, known | texts, code.co_name, function.__defaults__)
