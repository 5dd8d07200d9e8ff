"""Compiled form of a law: one generated module that sums its terms, with two callbacks.

A term is two kernels: ``act(t, x, v, u, numbers, panels, listed)`` adds to u and returns the power, ``energy(t, x, v,
numbers, panels, listed)`` returns the potential energy (`flockana.kernels.listed_pairs`). Obstacles of a kind are
guarded by a kernel ``guard(points, allowance, numbers, shell, far, share)``, which returns the share given, or less.
"""

from functools import cache
from typing import Any, NamedTuple

import numpy as np

from flockana.jit import Kernel, callback, launch_threads, load_numba
from flockana.kernels.bound_templates import made
from flockana.kernels.large_flocks import parallel_twin

_HEAD = """from flockana.jit import kernel
from flockana.kernels.listed_pairs import Listed

"""
_SEEN = "frame, numbers, panels, starts, first, second, count, cuts, order, near, room"
_LISTED = "    seen, total = Listed(frame, first, second, count, cuts, order, near, room), 0.0"
_ACT = f"def force(t, x, v, u, {_SEEN}):\n{_LISTED}"
_ENERGY = f"def energy(t, x, v, {_SEEN}):\n{_LISTED}"
_GUARD = "def guard(points, allowance, numbers, starts, shell, far, share):\n"


class LawFunctions(NamedTuple):
    """Force-and-power and energy functions of a law, as callbacks for compiled code."""

    force: Any
    energy: Any


class LawNumbers(NamedTuple):
    """Numbers read by a law's functions: numbers and panels of all terms, with start indices."""

    numbers: Any
    panels: Any
    starts: Any


def law_numbers(terms: Any) -> LawNumbers:
    """Return the parameters of all terms in one vector, and their polynomial panels in one matrix."""
    kernel_parameters = np.concatenate([np.empty(0), *(term.numbers for term in terms)])
    width = max((term.panels.shape[1] for term in terms), default=0)
    panels = np.concatenate([np.empty((0, width)), *(term.panels.reshape(-1, width) for term in terms if width)])
    counts = [(term.numbers.size, len(term.panels) if width else 0) for term in terms]
    starts = np.concatenate([[(0, 0)], np.cumsum(np.array(counts, np.int64).reshape(-1, 2), axis=0)]).astype(np.int64)
    return LawNumbers(kernel_parameters, panels, starts)


@cache
def law_functions(terms: tuple[tuple[Kernel, Kernel], ...], several: bool = False) -> LawFunctions:
    """Return the compiled functions of a law with given terms, for one thread or several."""
    if several:
        launch_threads()
        terms = tuple((parallel_twin(act_kernel), parallel_twin(energy)) for act_kernel, energy in terms)
    functions: dict[str, Kernel] = {}
    lines: dict[str, list[str]] = {_ACT: [], _ENERGY: []}
    for k, (act_kernel, energy) in enumerate(terms):
        own_numbers = f"numbers[starts[{k}, 0] : starts[{k + 1}, 0]]"
        argument_text = f"{own_numbers}, panels[starts[{k}, 1] : starts[{k + 1}, 1]]"
        functions |= {f"act_{k}": act_kernel, f"energy_{k}": energy}
        lines[_ACT].append(f"    total += act_{k}(t, x, v, u, {argument_text}, seen)")
        lines[_ENERGY].append(f"    total += energy_{k}(t, x, v, {argument_text}, seen)")
    bodies = ("\n".join([head, *body, "    return total"]) for head, body in lines.items())
    module = made(_HEAD + "\n".join(f"\n@kernel\n{body}\n" for body in bodies), "law", **functions)
    return LawFunctions(*(callback(getattr(module, k), sign) for k, sign in signatures()._asdict().items()))


@cache
def guard_of(kinds: tuple[Kernel, ...]) -> Any:
    """Return one compiled check that no agent skips an obstacle in a step, for obstacles of several kinds."""
    numba = load_numba()
    vector, real = numba.float64[::1], numba.float64
    lines = [
        f"    share = guard_{k}(points, allowance, numbers[starts[{k}] : starts[{k + 1}]], shell, far, share)\n"
        for k in range(len(kinds))
    ]
    text = "from flockana.jit import kernel\n\n\n@kernel\n" + _GUARD + "".join(lines) + "    return share\n"
    module = made(text, "guard", **{f"guard_{k}": kind for k, kind in enumerate(kinds)})
    return callback(module.guard, real(real[:, :, ::1], vector, vector, numba.int64[::1], real, real, real))


@cache
def signatures() -> LawFunctions:
    """Return numba's signatures of a law's force and energy."""
    numba = load_numba()
    float64, int64 = numba.float64, numba.int64
    matrix, vector, indices = float64[:, ::1], float64[::1], numba.uint32[::1]
    types = (
        matrix, vector, matrix, int64[:, ::1], indices, indices, int64, int64[::1], numba.uint64[::1],
        numba.uint64[:, ::1], matrix,
    )  # fmt: skip
    return LawFunctions(float64(float64, matrix, matrix, matrix, *types), float64(float64, matrix, matrix, *types))
