"""Conversion of laws, runs and scenarios to other units of length and time."""

from collections.abc import Callable, Mapping
from dataclasses import fields, is_dataclass
from typing import Any, TypeVar

import numpy as np

from flockana.base.errors import ArgumentError
from flockana.base.value_checks import ensure_positive

Powers = tuple[int, int]
"""Powers of length and time: (1, -1) is a velocity."""

_Any = TypeVar("_Any")


def rescale(item: _Any, *, length: float = 1.0, time: float = 1.0) -> _Any:
    """Return a law, target, obstacle, interaction, run or scenario in other units.

    A length ℓ becomes ``length * ℓ``, a time t becomes ``time * t``, a speed v becomes ``length / time * v``, and so
    on: metres to millimetres is ``length=1000``. Nothing that is measured in its own scales changes.

    Parameters
    ----------
    item : object
        A frozen parameter object, a run or a scenario; each class names the powers of its parameters in ``units``.
    length, time : float
        Units before, in units after; > 0.

    Returns
    -------
    object
        Of the same type.

    Raises
    ------
    ArgumentError
        If a factor is not positive, or the thing is none that has units, or has a number in its formula that cannot
        change with the unit.

    Examples
    --------
    >>> from flockana.environment.targets import LinearTarget
    >>> rescale(LinearTarget(q=(1.0, 2.0), p=(3.0, 0.0)), length=1000.0, time=60.0)
    LinearTarget(q=(1000.0, 2000.0), p=(50.0, 0.0))
    """
    length, time = ensure_positive("length", length), ensure_positive("time", time)
    if isinstance(item, type):
        raise ArgumentError(f"{item.__name__} is a class: expected an instance; did you forget the parentheses?")
    if not isinstance(item, tuple) and not is_dataclass(item) and not hasattr(item, "in_units"):
        raise ArgumentError(
            f"{item!r} has no units: expected a law, target, obstacle, interaction, run or scenario; for bare numbers "
            "use their product with the factor"
        )
    return _rescaled(item, length, time)


def _rescaled(item: Any, length: float, time: float) -> Any:
    how: Callable[[float, float], Any] | None = getattr(item, "in_units", None)  # for what no table of powers can say
    if how is not None:
        return how(length, time)
    if isinstance(item, tuple):
        return tuple(_rescaled(entry, length, time) for entry in item)
    if not is_dataclass(item) or isinstance(item, type):
        return item
    return type(item)(**scaled_fields(item, length, time))


def scaled_fields(item: Any, length: float, time: float) -> dict[str, Any]:
    """Return the constructor arguments of a parameter object in other units."""
    powers: Mapping[str, Powers] = getattr(item, "units", {})
    values = {field.name: getattr(item, field.name) for field in fields(item) if field.init}
    factors = {name: length**length_power * time**time_power for name, (length_power, time_power) in powers.items()}
    return {
        name: times(value, factors[name]) if name in powers else _rescaled(value, length, time)
        for name, value in values.items()
    }


def times(value: Any, factor: float) -> Any:
    """Return a number, or all numbers in tuples and arrays, multiplied by a factor; None stays None."""
    if value is None:
        return None
    if isinstance(value, tuple | list):
        return tuple(times(item, factor) for item in value)
    return value * factor if isinstance(value, np.ndarray) else float(value) * factor
