"""Seals: digests that detect changes to computed evidence and saved files.

An object that is evidence (a run, a tube, a basin, an equilibrium, a counterexample) carries a digest of each of its
fields, set by the function that computes it (`sealed`). Whatever rests on such an object asks for them first
(`ensure_sealed`): one made or changed by hand has none, or others. A file carries the digest of its contents
(`with_digest`), or the seal of the object in it. Both guard against accidents, not against an adversary.
"""

import json
from collections.abc import Collection, Iterator, Mapping, Set
from dataclasses import fields, is_dataclass, replace
from enum import Enum
from functools import cached_property, partial
from numbers import Number
from types import FunctionType, MappingProxyType, MethodType
from typing import Any, TypeVar

import numpy as np
import numpy.typing as npt

from flockana.base.digests import sha256
from flockana.base.errors import ArgumentError, FileError

SEAL = "digest"  # the key of a file's digest
_ATTRIBUTE = "_seal"  # no field: `dataclasses.replace` leaves it out
_NUMBERS = {"b": "|b1", "i": "<i8", "u": "<u8", "f": "<f8"}  # however wide they are, and wherever

_Evidence = TypeVar("_Evidence")


def digest(data: Any) -> str:
    """Return the SHA-256 of plain data, independent of the order of keys."""
    return sha256([json.dumps(data, sort_keys=True)])


def with_digest(data: Mapping[str, Any]) -> dict[str, Any]:
    """Return plain data with its SHA-256 digest added as a further entry, as files store it."""
    return {**data, SEAL: digest(dict(data))}


def without_digest(data: Mapping[str, Any], *, keys: Collection[str] | None = None) -> dict[str, Any]:
    """Return a file's data without its digest; raise if the digest is missing or wrong, or a key is unknown."""
    other_data = {key: value for key, value in data.items() if key != SEAL}
    unknown = sorted({*other_data} - {*keys}) if keys is not None else []
    if unknown:
        raise FileError(f"it holds {', '.join(unknown)}: expected {', '.join(keys or ())} and {SEAL}, nothing else")
    if SEAL not in data:
        raise FileError(f"it has no {SEAL}, which every file is written with: something was taken out")
    if data[SEAL] != digest(other_data):
        raise FileError("its digest is not that of its contents: something in it was changed")
    return other_data


def checksum(value: Any, modules: Mapping[str, str] = MappingProxyType({})) -> str:
    """Return the SHA-256 of a value: of numbers bit by bit, of objects field by field, of functions by their name.

    `modules` names, by class, modules that count as part of a class's name, as in seals of older files.
    """
    # Sequences of numbers count as the array of them, so that an object that went through a file keeps its checksum; a
    # field that takes no part in comparisons counts for nothing.
    return sha256(_parts_of(value, (), modules))


def public_name(item: Any, modules: Mapping[str, str] = MappingProxyType({})) -> str:
    """Return the name of a class or function in digests and files; without module for flockana's own."""
    module, name = item.__module__, item.__qualname__
    if module.partition(".")[0] == "flockana":
        module = modules.get(name, "flockana")
    return f"{module}:{name}"


def sealed(evidence: _Evidence) -> _Evidence:
    """Attach a seal, the checksums of all its fields, to a frozen dataclass and return the same object."""
    object.__setattr__(evidence, _ATTRIBUTE, seal_of(evidence))
    return evidence


def seal_of(evidence: Any, modules: Mapping[str, str] = MappingProxyType({})) -> dict[str, str]:
    """Return the seal of a dataclass: the checksum of each field, by the field's name."""
    return {field.name: checksum(getattr(evidence, field.name), modules) for field in fields(evidence)}


def is_sealed(evidence: Any) -> bool:
    """Return whether a dataclass has a seal that agrees with its fields."""
    return bool(vars(evidence).get(_ATTRIBUTE) == seal_of(evidence))


def replace_sealed(evidence: _Evidence, **changes: Any) -> _Evidence:
    """Return a dataclass with some fields replaced, sealed again if it was sealed before."""
    copy = replace(evidence, **changes)  # type: ignore[type-var]
    return sealed(copy) if is_sealed(evidence) else copy


def ensure_sealed(name: str, evidence: Any, source: str, remedy: str) -> None:
    """Raise unless a dataclass has a valid seal; the message names the changed fields."""
    seal = vars(evidence).get(_ATTRIBUTE)
    if seal is None:
        fault = "was made or changed by hand"
    else:
        other = [key for key, value in seal_of(evidence).items() if seal.get(key) != value]
        if not other:
            return
        fault = f"was changed by hand since ({', '.join(other)})"
    raise ArgumentError(f"{name}: this {type(evidence).__name__} {fault}: expected {source}; {remedy}")


def _parts_of(value: Any, within: tuple[int, ...], modules: Mapping[str, str]) -> Iterator[Any]:
    """Yield the texts and buffers of bytes over which the digest of a value is taken."""
    if isinstance(value, np.generic):
        value = value.item()
    if isinstance(value, np.ndarray | list | tuple):
        values = _numbers(value)
        if values is not None:
            yield f"array {values.shape if values.size else 0} {values.dtype.str}"
            yield values.data  # without a copy
            return
        items = value.tolist() if isinstance(value, np.ndarray) else value
        yield f"sequence {len(items)}"
        for item in items:
            yield from _parts_of(item, within, modules)
        return
    parts: Mapping[Any, Any] | None = None
    spelling = None if isinstance(value, type) else getattr(value, "spelling", None)  # of what files hold otherwise
    kind, spelled_value = spelling or (type(value), None)
    text = public_name(kind, modules)
    if value is None or isinstance(value, Number | str | bytes | Enum):
        text += f" {value!r}"
    elif isinstance(value, type | FunctionType):
        text += f" {public_name(value, modules)}"
    elif isinstance(value, MethodType):
        parts = {"self": value.__self__, "function": value.__func__}
    elif isinstance(value, partial):
        parts = {"function": value.func, "arguments": value.args, "keywords": value.keywords}
    elif kind.__module__.partition(".")[0] == "flint":
        parts = {"entries": value.entries()} if hasattr(value, "entries") else None
        ball = hasattr(value, "rad") and value.is_finite()  # to the bit
        text += str((value.mid().man_exp(), value.rad().man_exp())) if ball else "" if parts else value.repr()
    elif isinstance(value, Mapping):
        parts = value
    elif isinstance(value, Set):
        text += " ".join(sorted(checksum(item, modules) for item in value))
    elif spelled_value is not None:
        parts = spelled_value
    elif is_dataclass(value):
        parts = {field.name: getattr(value, field.name) for field in fields(value) if field.init and field.compare}
    else:
        text += getattr(value, "__name__", "")
        parts = _public(value)
    yield f"{len(text)} {text}"
    if parts is not None and id(value) not in within:
        for key in sorted(parts, key=str):
            yield f"{key!s} ="
            yield from _parts_of(parts[key], (*within, id(value)), modules)


def _numbers(value: Any) -> npt.NDArray[Any] | None:
    """Return a sequence of numbers as an array; None for any other value."""
    try:
        array = np.asarray(value)
    except (ValueError, TypeError, OverflowError):
        return None
    if array.dtype.kind not in _NUMBERS:
        return None
    return np.ascontiguousarray(array, dtype=_NUMBERS[array.dtype.kind])


def _public(value: Any) -> dict[str, Any]:
    """Return an object's attributes without private ones and cached results."""
    attributes = getattr(value, "__dict__", {})
    cached = {key for key in attributes if isinstance(getattr(type(value), key, None), cached_property)}
    return {key: item for key, item in attributes.items() if key[:1] != "_" and key not in cached}
