"""Checks that arguments are of the classes that their annotations name, where a public function begins."""

import functools
import inspect
from collections.abc import Callable, Iterable, Mapping, Sequence
from numbers import Real
from typing import Any, ParamSpec, TypeVar

import numpy as np

from flockana.base.errors import ArgumentError, format_value
from flockana.base.value_checks import ensure_kind, ensure_numbers

_P = ParamSpec("_P")
_R = TypeVar("_R")

# what messages ask for, by the class in an annotation; classes that are not listed are not checked
_EXAMPLES = {
    "AlphaInteraction": "the pair interaction of a law, as Algorithm2().alpha",
    "CollapseDiagram": "what equilibria.collapse_diagram(...) gives",
    "DataArray": "an xarray.DataArray, as phases(...) gives it",
    "Dataset": "an xarray.Dataset, as ensemble(...) gives it",
    "DeadZoneInteraction": "the pair interaction of DeadZoneFlocking",
    "DistanceFunction": "a function of the distance, such as pair_law(...)",
    "Falsification": "what falsify(...) gives",
    "Iterable": "a sequence",
    "LinearFlock": "what linearise(...) gives",
    "Linearisation": "what linearise(...) gives",
    "Mapping": "a mapping, such as a dict of values by label",
    "Mode": "one of the modes of linearise(...)",
    "Obstacle": "an obstacle, such as Sphere(centre, radius)",
    "Outcome": "one of what scenarios.one_start.compare() gives",
    "Numbers": "a sequence",
    "NormTable": "what stability.norms_against_size(...) gives",
    "Reynolds": "what reynolds.reynolds(...) gives",
    "SampledBasin": "what sample_basin(...) gives",
    "Sequence": "a sequence",
    "StateSpace": "a control.StateSpace, as disturbance_system(...) gives it",
    "Sweep": "what stability.gain_sweep(...) gives",
    "Trajectory": "a run, as simulate(...) gives it",
}
_ARRAYS = ("ArrayLike", "FloatArray")
_SYMBOLIC = ("Expr", "Matrix", "IndexedBase")  # of sympy; numbers will do
_SERIES = (Sequence, np.ndarray)
_PROTOCOLS: dict[str, Any] = {"Iterable": Iterable, "Mapping": Mapping, "Numbers": _SERIES, "Sequence": _SERIES}


def check_kinds(function: Callable[_P, _R]) -> Callable[_P, _R]:
    """Decorate a function so that it refuses, by name, an argument of another class than its annotation."""
    # Annotations are read as text, so that no library is imported for a check. Items of a sequence are checked too.
    signature = inspect.signature(function)
    if any(not isinstance(p.annotation, str) for p in signature.parameters.values()):
        raise TypeError(f"{function.__module__}: expected annotations as text, from __future__ import annotations")
    texts = {name: p.annotation.strip("'\"") for name, p in signature.parameters.items()}
    kinds = {name: text.partition("[")[0].rpartition(".")[2] for name, text in texts.items()}
    kinds = {name: kind for name, kind in kinds.items() if kind in (*_EXAMPLES, *_ARRAYS, *_SYMBOLIC)}
    items = {name: texts[name].partition("[")[2].rstrip("]").rpartition(".")[2] for name in kinds}

    @functools.wraps(function)
    def checked(*args: _P.args, **kwargs: _P.kwargs) -> _R:
        values: dict[str, Any] = signature.bind(*args, **kwargs).arguments
        for name, kind in kinds.items():
            if name in values and kind in _ARRAYS:
                ensure_numbers(name, values[name], "an array of real numbers")
            elif name in values and kind in _SYMBOLIC:
                _ensure_symbolic(name, values[name])
            elif name in values:
                ensure_kind(name, values[name], _PROTOCOLS.get(kind, kind), _EXAMPLES[kind])
                if items[name] in _EXAMPLES and isinstance(values[name], Sequence):  # an iterator can be read only once
                    for k, item in enumerate(values[name]):
                        ensure_kind(f"{name}[{k}]", item, items[name], _EXAMPLES[items[name]])
        return function(*args, **kwargs)

    return checked


def _ensure_symbolic(name: str, value: Any) -> None:
    """Raise unless a value is a sympy expression or matrix, or a number."""
    classes = {item.__name__ for item in type(value).__mro__}
    if not (isinstance(value, Real) or classes & {"Expr", "MatrixBase"}):
        raise ArgumentError(f"{name} = {format_value(value)}: expected a sympy expression, such as sympy.Symbol('z')")
