"""Axes of arrays: time, agent and space axis identified by name, joined, or recognised by smoothness."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from flockana.base.errors import ArgumentError
from flockana.recorded.reading.column_names import by_owner, ordered_axes
from flockana.recorded.reading.column_words import coordinate, words_of

AXES = {
    **dict.fromkeys(("t", "time", "times", "frame", "frames", "sample", "samples"), 0),
    **dict.fromkeys(("n", "agent", "agents", "individual", "individuals", "id", "robot", "particle", "animal"), 1),
    **dict.fromkeys(
        ("m", "axis", "axes", "space", "xy", "xyz", "coord", "coords", "coordinate", "coordinates", "dim"), 2
    ),
}
_SMOOTHER = 4.0  # times smaller steps along the second axis than along the first: then that may be the time


def order_of(axes: Any) -> list[int]:
    """Return the meaning of each axis of an array: time, agent or space axis."""
    words = axes.replace(",", " ").split() if isinstance(axes, str) else list(axes) if np.iterable(axes) else []
    words = list(words[0]) if len(words) == 1 and str(words[0]) not in AXES and len(str(words[0])) in (2, 3) else words
    order = [AXES.get(str(word).lower(), -1) for word in words]
    if -1 in order or len(set(order)) < len(order) or 0 not in order or len(order) not in (2, 3):
        raise ArgumentError(
            f'axes = {axes!r}: expected time, agent and axis in the order of the array, such as "time axis agent"'
        )
    return order


def turned(x: Any, order: Sequence[int], kind: str, where: str) -> Any:
    """Return an array with axes in the order (T, n, m); a missing axis has length 1."""
    if x.ndim != len(order):
        raise ArgumentError(
            f"{where}: {kind} has shape {x.shape} and axes= names {len(order)}: expected one name for each"
        )
    missing = [k for k in range(3) if k not in order]
    full_array = x.reshape(*x.shape, *(1 for _ in missing))
    return np.transpose(full_array, [[*order, *missing].index(k) for k in range(3)])


def with_joined_axes(
    arrays: Mapping[str, Any], given: Mapping[str, Any], order: Sequence[int] | None, where: str
) -> tuple[Mapping[str, Any], dict[str, str]]:
    """Return arrays with single coordinates such as x and y joined to (T, n, m), and the joined names."""
    words = {name: coordinate(*words_of(name)) for name in arrays if name not in given.values()}
    known_axes = {name: word for name, word in words.items() if word is not None and rank(arrays[name]) == 2}
    kinds = {kind: dict(zip("xyz", x, strict=False)) for kind, x in given.items() if isinstance(x, list | tuple)}
    kinds = kinds if "q" in given else by_owner(known_axes, where).get((), {})
    if len(kinds.get("q", ())) < 2:
        return arrays, {}
    joined, texts, order = dict(arrays), dict[str, str](), order or (0, 1)
    for kind, names in ordered_axes(kinds, where, ", ".join(map(str, arrays))).items():
        if lacking := [name for name in names if name not in joined]:
            raise ArgumentError(f"{where} has no array {lacking[0]!r}: expected one of {', '.join(map(str, arrays))}")
        parts = [real_array(joined.pop(name), kind, where) for name in names]
        if len({part.shape for part in parts}) > 1:
            raise ArgumentError(f"{where}: {', '.join(names)} have other shapes than each other: expected one")
        joined[kind] = np.concatenate(
            [turned(part, order, name, where) for part, name in zip(parts, names, strict=True)], axis=2
        )
        texts[kind] = ", ".join(map(repr, names))
    return joined, texts


def rank(x: Any) -> int:
    """Return the number of dimensions of an array; 0 for rows of different lengths."""
    try:
        return np.ndim(x)
    except ValueError:
        return 0


def possible_orders(q: Any, times: Sequence[int]) -> list[str]:
    """Return the possible values of the axes= argument: one axis as time, a short one as space."""
    spaces = [(k, j) for k in times for j in range(3) if j != k and q.shape[j] <= 3]
    return [f'"{" ".join("time" if i == k else "axis" if i == j else "agent" for i in range(3))}"' for k, j in spaces]


def is_smoother_along_second(q: Any) -> bool:
    """Return whether steps and shape changes along the second axis are much smaller than along the first."""
    if min(q.shape[:2]) < 2:
        return False
    x = np.ma.masked_invalid(q)
    rounding = 1e-9 * np.ma.abs(x).max()
    shape = x - x.mean(axis=0) - x.mean(axis=1)[:, None]
    variations = [[np.ma.abs(y[1:] - y[:-1]).mean(), np.ma.abs(y[:, 1:] - y[:, :-1]).mean()] for y in (x, shape)]
    return all(_SMOOTHER * second_variation < first > rounding for first, second_variation in variations)


def real_array(value: Any, kind: str, where: str) -> Any:
    """Return an array of real numbers, or raise."""
    try:
        array = np.asarray(np.ma.filled(value.astype(np.float64), np.nan) if np.ma.isMaskedArray(value) else value)
    except ValueError:
        raise ArgumentError(f"{where}: {kind} has rows of different lengths: expected an array of numbers") from None
    if array.dtype.kind not in "fiu":
        raise ArgumentError(f"{where}: {kind} is an array of {array.dtype}: expected real numbers")
    return array
