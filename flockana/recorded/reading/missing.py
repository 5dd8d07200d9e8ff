"""Marker numbers for unseen agents, such as -9999: read as gaps if stated, rejected if only suspected."""

from collections.abc import Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

from flockana.base.errors import ArgumentError
from flockana.base.value_checks import FloatArray, ensure_numbers
from flockana.recorded.reading.column_names import MEANINGS

_Mask = npt.NDArray[np.bool_]
_SMALL = (0.0, -1.0)  # ordinary coordinates, too: agents must leap there and back
_PLAIN = (32767.0, -32768.0, *(sign * (10.0**k - 1.0) for k in range(2, 8) for sign in (1.0, -1.0)))
_HUGE = 1e9
_FAR = 10.0  # spans of all other numbers, beyond which any number that returns looks so
_APART = 0.1  # spans of all other numbers, beyond which a small number along one axis alone may be a lost coordinate
_LEAP, _LEAP_OUT = 5.0, 2.0  # of a fast step: to a number, and to one outside the region of all others
_FAST, _SHORT, _FEW = 0.98, 0.25, 10  # quantiles: fast steps, short leaps; steps below which two leaps are needed


def without_missing(arrays: Mapping[str, Any], missing: Any, where: str) -> dict[str, Any]:
    """Return t, q, p, u with stated markers of unseen agents as gaps; raise if a value looks like a marker."""
    shape = np.shape(arrays["q"])
    vectors = {k: np.array(arrays[k], dtype=np.float64) for k in "qpu" if k in arrays and np.shape(arrays[k]) == shape}
    markers = ensure_numbers("missing", [] if missing is None else missing, "numbers that stand for 'not seen'")
    notes = []
    for value in markers.reshape(-1).tolist():
        gone = _places(vectors["q"], value, "q")
        for kind, x in vectors.items():
            x[gone | _places(x, value, kind)] = np.nan
        notes.append(f"{gone.sum()} positions that are {value:g} are gaps")
    for kind, x in vectors.items() if markers.size or missing is None else ():
        known = x[~np.isnan(x).any(axis=2)]
        endpoints = [*known.min(axis=0, initial=0.0).tolist(), *known.max(axis=0, initial=0.0).tolist()]
        for value in (number for number in dict.fromkeys((*_SMALL, *_PLAIN, *endpoints)) if (x == number).any()):
            if _looks_missing(x, gone := _places(x, value, kind), value, kind):
                k, i = (int(j) for j in np.argwhere(gone)[0])
                first_text = f"agent {(arrays.get('ids') or range(shape[1]))[i]} at t = {np.ravel(arrays['t'])[k]:g}"
                others, text = x[~gone & ~np.isnan(x).any(axis=2)], repr(value).removesuffix(".0")
                range_text = f"from {others.min():.4g} to {others.max():.4g}" if others.size else "nothing"
                raise ArgumentError(
                    f"{where}: {kind} is {text} at {gone.sum()} places ({first_text} first), and {range_text} "
                    f"elsewhere: this may stand for agents that were not seen, or be a {MEANINGS[kind]}: "
                    f"expected missing={text}, or missing=() if nothing is missing, which decides"
                )
    return {**arrays, **vectors, "read_as": (*arrays.get("read_as", ()), *notes)}


def _beyond(x: FloatArray, value: float, spans: float) -> _Mask:
    """Return on which axes a value lies outside the range of all other numbers, by a multiple of that range."""
    others = np.where(x == value, np.nan, x)
    low, high = np.nan_to_num(others, nan=np.inf).min((0, 1)), np.nan_to_num(others, nan=-np.inf).max((0, 1))
    margin = spans * np.where(low < high, high - low, 0.0)
    result: _Mask = (low < high) & ((value < low - margin) | (value > high + margin))
    return result


def _varying(x: FloatArray) -> _Mask:
    """Return on which axes the known numbers of an array differ."""
    known = x[~np.isnan(x).any(axis=2)]
    result: _Mask = (known != known[:1]).any(axis=0)
    return result


def _places(x: FloatArray, value: float, kind: str) -> _Mask:
    """Return which vectors are a marker value: on all axes that vary, or on one where the value is far off."""
    is_value, is_variable, small = x == value, _varying(x), value in _SMALL
    far: _Mask = is_value & _beyond(x, value, _APART if small else 1.0)
    if small:  # of positions, of agents that are elsewhere, too
        far &= (kind == "q") & ~(is_value | np.isnan(x)).all(axis=0)
    in_all_axes = is_value[:, :, is_variable | ~is_variable.any()].all(axis=2) & (kind == "q")
    result: _Mask = far.any(axis=2) | in_all_axes
    return result


def _looks_missing(x: FloatArray, gone: _Mask, value: float, kind: str) -> bool:
    """Return whether the vectors that equal a value look like markers of unseen agents."""
    count, is_variable, left = gone.sum(), _varying(x), gone[1:] != gone[:-1]
    plain = value in _PLAIN or abs(value) >= _HUGE
    if value not in _SMALL and (far := _beyond(x, value, 1.0 if plain else _FAR)).any():
        is_decisive = len(x) > 1 and plain and far[is_variable].all() and is_variable.sum() > 1
        return bool((count > 1 or is_decisive) and (plain or left.sum() > 1))
    if kind != "q" or not (plain or value in _SMALL):
        return False
    out = bool(_beyond(x, value, 0.0)[is_variable].all())
    steps = np.sqrt(np.sum(np.diff(x, axis=0) ** 2, axis=2))
    leaps, others = steps[left & ~np.isnan(steps)], steps[~gone[1:] & ~gone[:-1] & (steps > 0.0)]
    stays = ((x == value).all(axis=2) | np.isnan(x[:, :, 0])).all(axis=0).any()  # an agent that is nowhere else
    if stays and len(x) > 1 and (not is_variable.any() if plain else value == -1.0 and (others.size or gone.all())):
        return True
    if len(leaps) < 2 and not (len(leaps) and len(others) >= _FEW):
        return False
    fast = float(np.quantile(others, _FAST)) if others.size else 0.0
    return float(np.quantile(leaps, _SHORT)) > (_LEAP_OUT if out and count > 1 else _LEAP) * fast
