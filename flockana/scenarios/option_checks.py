"""Checks of a scenario's parts and options before any run."""

import inspect
from collections.abc import Callable, Iterable, Mapping
from typing import Any, get_args

from flockana.base import value_checks
from flockana.base.errors import ArgumentError
from flockana.laws.first_order_law import ensure_any_law
from flockana.scenarios.lazy_start import LazyArray
from flockana.theorems import Status, theorems

SOURCE = "source"  # the id under which a source's own report is judged
_SAMPLES = 4  # of q, p and u in three dimensions: the least that a run takes


def ensure_parts(parts: Mapping[str, Any]) -> None:
    """Raise unless a scenario's fields have the right types, without drawing a start."""
    if not isinstance(parts["name"], str) or not parts["name"]:
        raise ArgumentError(f"name = {parts['name']!r}: expected the scenario's name in the catalogue")
    ensure_any_law(parts["law"])
    value_checks.ensure_time_span(parts["t_span"])
    value_checks.ensure_seed(parts["seed"])
    shapes = {
        key: v.shape if isinstance(v := parts[key], LazyArray) else value_checks.ensure_points(key, v).shape
        for key in ("q0", "p0")
    }
    if shapes["q0"] != shapes["p0"]:
        raise ArgumentError(
            f"q0 has shape {shapes['q0']} but p0 has shape {shapes['p0']}: expected equal shapes (n, m)"
        )
    for name in ("expected", "shipped"):
        _ensure_statuses(name, parts[name])
    (low, high), instants = parts["t_span"], parts["instants"]
    if not all(low <= time <= high for time in instants):
        raise ArgumentError(f"instants = {instants!r}: expected times within t_span = {parts['t_span']}")


def _ensure_statuses(name: str, statuses: Any) -> None:
    known_statuses = get_args(Status)
    if not isinstance(statuses, Mapping):
        raise ArgumentError(f"{name} = {statuses!r}: expected a mapping of theorem ids to statuses")
    wrong_statuses = {key: status for key, status in statuses.items() if status not in known_statuses}
    if wrong_statuses:
        raise ArgumentError(f"{name} = {wrong_statuses!r}: expected statuses {', '.join(known_statuses)}")
    unnamed = [key for key in statuses if not isinstance(key, str)]
    if unnamed:
        raise ArgumentError(f"{name} has a key {unnamed[0]!r}: expected the id of a theorem")


def ensure_judged(names: Iterable[str]) -> None:
    """Raise unless all theorem ids exist."""
    for name in names:
        value_checks.ensure_known("theorem", name, theorems())


def ensure_options(name: str, build: Callable[..., Any], options: Mapping[str, Any]) -> None:
    """Raise unless a scenario has the given options, with values of the types of their defaults."""
    defaults = {key: one.default for key, one in inspect.signature(build).parameters.items() if key != "seed"}
    unknown = sorted(set(options) - set(defaults))
    if unknown:
        raise ArgumentError(f"{name} has no option {', '.join(unknown)}; it has {', '.join(defaults) or 'none'}")
    for key, value in options.items():
        _ensure_like(defaults[key], key, value)


def _ensure_like(default: Any, key: str, value: Any) -> None:
    """Raise unless an option has the type of its default."""
    if isinstance(default, bool):
        if not isinstance(value, bool):
            raise ArgumentError(f"{key} = {value!r}: expected True or False")
    elif isinstance(default, float):
        value_checks.ensure_finite_scalar(key, value)
    elif key == "m":
        value_checks.ensure_dimension(value)
    elif isinstance(default, int):
        count = value_checks.ensure_count(key, value)
        if key == "n":
            value_checks.ensure_fits(
                f"a short run of {count} agents,", (3 * _SAMPLES, count, 3), "ask for fewer agents"
            )
