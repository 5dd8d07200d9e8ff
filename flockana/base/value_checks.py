"""Validation of arguments at the public entry points, before any work starts."""

import math
import os
from collections.abc import Callable, Collection, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from flockana.base.errors import DIGITS, ArgumentError, UnknownNameError, format_value

FloatArray = npt.NDArray[np.float64]
Numbers = Sequence[float] | npt.NDArray[Any]  # several, as a user gives them
TimeSpan = Numbers  # two times
ComplexArray = npt.NDArray[np.complex128]
PerAgent = float | tuple[float, ...]


def ensure_finite_scalar(name: str, value: Any) -> float:
    """Return `value` as a finite float."""
    try:
        number = float(_real(value))
    except (TypeError, ValueError, OverflowError):
        raise ArgumentError(f"{name} = {format_value(value)}: expected one real number") from None
    if not math.isfinite(number):
        raise ArgumentError(f"{name} = {number}: expected a finite number")
    return number


def ensure_positive(name: str, value: Any) -> float:
    """Return `value` as a finite float > 0; errors as `ensure_finite_scalar`."""
    number = ensure_finite_scalar(name, value)
    if number <= 0.0:
        raise ArgumentError(f"{name} = {number:g}: expected a number > 0")
    return number


def ensure_nonnegative(name: str, value: Any) -> float:
    """Return `value` as a finite float >= 0; errors as `ensure_finite_scalar`."""
    number = ensure_finite_scalar(name, value)
    if number < 0.0:
        raise ArgumentError(f"{name} = {number:g}: expected a number >= 0")
    return number


def per_agent(name: str, value: Any, ensure: Any = ensure_positive) -> PerAgent:
    """Return one validated number, or one for each agent."""
    if np.ndim(value) == 0:
        return float(ensure(name, value))
    if np.ndim(value) != 1 or not len(value):
        raise ArgumentError(f"{name} has shape {np.shape(value)}: expected one number, or one for each agent")
    return tuple(ensure(f"{name}[{i}]", item) for i, item in enumerate(value))


def normalise(item: Any, check: Callable[[str, Any], Any], *names: str) -> None:
    """Replace fields of a frozen dataclass by what a check returns for their names and values."""
    for name in names:
        object.__setattr__(item, name, check(name, getattr(item, name)))


def freeze_vector(item: Any, name: str, m: int | None = None) -> FloatArray:
    """Replace a vector field of a frozen dataclass by a tuple of finite numbers, and return it as an array."""
    vector = ensure_vector(name, getattr(item, name), m)
    object.__setattr__(item, name, tuple(vector.tolist()))
    return vector


def _real(value: Any) -> Any:
    """Return a number or array as it is; raise on text, booleans, dates and masked entries."""
    if isinstance(value, str | bytes | bool | np.bool_ | np.datetime64 | np.timedelta64) or np.ma.is_masked(value):
        raise TypeError(f"{format_value(value)} is no number")
    return value


def real_array(value: Any) -> FloatArray:
    """Return a contiguous float64 array of real numbers; raise on what numpy would merely convert."""
    # Texts, truth values, times, masked entries and complex numbers are refused rather than turned into numbers.
    array = np.asarray(_real(value))
    if array.dtype.kind == "O":
        array = np.array([float(_real(item)) for item in array.ravel()]).reshape(array.shape)
    if array.dtype.kind not in "fiu" and array.size:
        raise TypeError(f"{array.dtype.str} are no real numbers")
    return np.asarray(array, dtype=np.float64, order="C")


def ensure_numbers(name: str, value: Any, wanted: str) -> FloatArray:
    """Return `value` as a real float64 array; raise with the expected shape or kind otherwise."""
    try:
        return real_array(value)
    except (TypeError, ValueError, OverflowError):
        raise ArgumentError(f"{name} = {format_value(value)}: expected {wanted}") from None


def ensure_points(name: str, value: Any) -> FloatArray:
    """Return an (n, m) float64 array of n >= 1 points in m = 1, 2 or 3 dimensions."""
    try:
        points = real_array(value)
    except (TypeError, ValueError, OverflowError):
        raise ArgumentError(f"{name}: expected numbers in an (n, m) array, got {type(value).__name__}") from None
    if points.ndim != 2:
        raise ArgumentError(
            f"{name} has shape {points.shape}: expected (n, m), one row per agent; "
            "for agents on a line use a column, q[:, None]"
        )
    if points.shape[0] < 1:
        raise ArgumentError(f"{name} has no agents (shape {points.shape}): expected n >= 1")
    if points.shape[1] not in (1, 2, 3):
        raise ArgumentError(f"{name} has shape {points.shape}: expected m = 1, 2 or 3 columns, one per dimension")
    bad = ~np.isfinite(points).all(axis=1)
    if bad.any():
        agent = int(np.argmax(bad))
        raise ArgumentError(f"{name}[{agent}] = {points[agent]}: expected finite numbers ({int(bad.sum())} bad agents)")
    return points


def ensure_state(q: Any, p: Any) -> tuple[FloatArray, FloatArray]:
    """Return positions and velocities of equal shape (n, m)."""
    q = ensure_points("q", q)
    p = ensure_points("p", p)
    if q.shape != p.shape:
        raise ArgumentError(f"q has shape {q.shape} but p has shape {p.shape}: expected equal shapes (n, m)")
    return q, p


def draw_start(q0: Any, p0: Any, seed: int, velocities: Any = None) -> tuple[FloatArray, FloatArray]:
    """Return positions and velocities of a start, given as arrays or as functions of a seed; at rest by default.

    `velocities` is a function of positions that completes a start without p0 otherwise.

    Examples
    --------
    >>> draw_start(lambda seed: [[1.0 * seed]], None, 3)
    (array([[3.]]), array([[0.]]))
    """
    q = q0(seed) if callable(q0) else q0
    p = p0(seed) if callable(p0) else p0
    if p is None and isinstance(q, tuple) and len(q) == 2 and np.ndim(q[0]) == 2:
        q, p = q
    if p is None:
        p = np.zeros(np.shape(q)) if velocities is None else velocities(q)
    return ensure_state(q, p)


def ensure_kind(name: str, value: Any, kind: type | tuple[type, ...] | str, example: str) -> None:
    """Raise unless a value is of a kind: a class, or its name where importing it would load a heavy library."""
    names = {item.__name__ for item in type(value).__mro__}
    if not (kind in names if isinstance(kind, str) else isinstance(value, kind)):
        raise ArgumentError(f"{name} = {format_value(value)}: expected {example}")


def ensure_vector(name: str, value: Any, m: int | None = None) -> FloatArray:
    """Return a finite float64 vector, of m components if `m` is given."""
    vector = ensure_numbers(name, value, "a vector of numbers")
    if vector.ndim != 1 or vector.size not in (1, 2, 3):
        raise ArgumentError(f"{name} has shape {vector.shape}: expected a vector of 1, 2 or 3 components")
    if m is not None and vector.size != m:
        raise ArgumentError(f"{name} has {vector.size} components: expected {m}, the dimension of the flock")
    return ensure_series(name, vector)


def ensure_series(name: str, value: Any, length: int | None = None) -> FloatArray:
    """Return a finite float64 series, of the given length if there is one."""
    series = ensure_numbers(name, value, "a series of numbers")
    if series.ndim != 1 or (length is not None and len(series) != length):
        expectation = "a series" if length is None else f"a series of {length} numbers"
        raise ArgumentError(f"{name} has shape {series.shape}: expected {expectation}")
    if not np.isfinite(series).all():
        raise ArgumentError(f"{name} = {' '.join(str(series).split())}: expected finite numbers")
    return series


def ensure_links(links: Any, n: int, name: str = "links") -> npt.NDArray[np.int32]:
    """Return links as an int32 array (M, 2) of agents 0 … n − 1."""
    ensure_fits(f"the data of n = {format_value(n)} agents,", (3, n), "ask for fewer agents")
    array = np.asarray(links)
    if array.size == 0:
        return np.empty((0, 2), dtype=np.int32)
    if array.ndim != 2 or array.shape[1] != 2 or array.dtype.kind not in "iu":
        raise ArgumentError(f"{name} has shape {array.shape} of {array.dtype}: expected (M, 2) whole numbers")
    is_invalid = ((array < 0) | (array >= n)).any(axis=1) | (array[:, 0] == array[:, 1])
    if is_invalid.any():
        k = int(np.argmax(is_invalid))
        raise ArgumentError(f"{name}[{k}] = {array[k].tolist()}: expected two different agents of 0 … {n - 1}")
    return np.ascontiguousarray(array, dtype=np.int32)


def ensure_fits(name: str, shape: tuple[int, ...], remedy: str) -> None:
    """Raise before an array of floats is allocated that would take more than half of the machine's memory."""
    byte_count = 8 * math.prod(shape)
    if not hasattr(os, "sysconf"):
        return  # the system does not say; the allocation itself may fail
    memory = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")
    if 2 * byte_count > memory:
        much = f"{byte_count:.3g}" if byte_count < 10**DIGITS else format_value(byte_count)
        axes = ", ".join(map(format_value, shape)) + ("," if len(shape) == 1 else "")
        raise ArgumentError(
            f"{name} of shape ({axes}) would take {much} bytes, more than half of this machine's {memory:.3g}: {remedy}"
        )


def ensure_affordable(work: str, size: int, seconds: float, megabytes: float, limit: float) -> None:
    """Raise before work of an estimated time and memory that takes longer than `limit` seconds."""
    if seconds > limit:
        raise ArgumentError(
            f"{work} would take about {seconds:.2g} s and {megabytes:.2g} MB (from its measured time for fewer), more "
            f"than limit = {limit:g} s: take fewer agents than these {size} coordinates, or give a larger limit"
        )


def ensure_time_span(t_span: Any) -> tuple[float, float]:
    """Return (t0, t1) with t0 < t1, both finite."""
    try:
        t0, t1 = (float(_real(t)) for t in t_span)
    except (TypeError, ValueError, OverflowError):
        raise ArgumentError(f"t_span = {format_value(t_span)}: expected two numbers (t0, t1)") from None
    if not (np.isfinite(t0) and np.isfinite(t1) and t0 < t1):
        raise ArgumentError(f"t_span = ({t0:g}, {t1:g}): expected finite t0 < t1")
    return t0, t1


def ensure_count(name: str, value: Any) -> int:
    """Return `value` as a whole number >= 1."""
    return _ensure_whole(name, value, 1)


def _ensure_whole(name: str, value: Any, least: int) -> int:
    if isinstance(value, bool) or not isinstance(value, int | np.integer) or value < least:
        raise ArgumentError(f"{name} = {format_value(value)}: expected a whole number >= {least}")
    return int(value)


def ensure_index(what: str, value: Any, count: int, kind: str = "a whole number") -> int:
    """Return `value` as one of the numbers 0 to count − 1."""
    if isinstance(value, bool | np.bool_) or not isinstance(value, int | np.integer) or not 0 <= value < count:
        raise ArgumentError(f"{what} {format_value(value)}: expected {kind}, 0 to {count - 1}")
    return int(value)


def ensure_seed(seed: Any, bits: int | None = None) -> int:
    """Return a seed as a whole number >= 0 that fits into a given number of bits."""
    seed = _ensure_whole("seed", seed, 0)
    if bits is not None and seed >= 2**bits:
        raise ArgumentError(f"seed = {format_value(seed)}: expected a whole number below 2**{bits}")
    return seed


def ensure_flag(name: str, value: Any) -> bool:
    """Return `value` if it is True or False."""
    if not isinstance(value, bool | np.bool_):
        raise ArgumentError(f"{name} = {format_value(value)}: expected True or False")
    return bool(value)


def ensure_known(kind: str, name: Any, known: Collection[str]) -> str:
    """Return `name` if it is one of the known names."""
    if not isinstance(name, str) or name not in known:
        raise UnknownNameError(kind, name, known)
    return name


def ensure_choice(name: str, value: Any, choices: Collection[str]) -> str:
    """Return `value` if it is one of the choices."""
    if not isinstance(value, str) or value not in choices:
        raise ArgumentError(f"{name} = {format_value(value)}: expected one of {', '.join(choices)}")
    return value


def ensure_dimension(m: int) -> int:
    """Return the dimension m if it is 1, 2 or 3."""
    if isinstance(m, bool) or not isinstance(m, int | float | np.number) or m not in (1, 2, 3):
        raise ArgumentError(f"m = {format_value(m)}: expected a dimension of 1, 2 or 3")
    return int(m)


def ensure_returned_array(what: str, value: Any, shape: tuple[int, ...], at: str) -> None:
    """Raise unless the array that a law returned is real and of the flock's shape."""
    if not isinstance(value, np.ndarray) or value.dtype.kind not in "fiu" or value.shape != shape:
        kind = f"{value.dtype} of shape {value.shape}" if isinstance(value, np.ndarray) else type(value).__name__
        raise ArgumentError(f"{what} as {kind} {at}: expected an array of real numbers of shape {shape}")
