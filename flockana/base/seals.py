"""Digests that saved data carry, by which one flipped bit is seen when they are read again.

They guard against accidents, not against an adversary, who could write another digest.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

from flockana.base.errors import FileError

SEAL = "digest"


def digest(data: Any) -> str:
    """SHA-256 of plain data, in which the order of names does not matter.

    Examples
    --------
    >>> digest({"a": 1, "b": [2.0]}) == digest({"b": (2.0,), "a": 1}), digest(1) == digest(1.0)
    (True, False)
    """
    return hashlib.sha256(json.dumps(data, sort_keys=True).encode()).hexdigest()


def checksum(values: npt.NDArray[Any]) -> str:
    """SHA-256 of an array: its shape, its kind and every number to the bit.

    Examples
    --------
    >>> checksum(np.array([0.0])) == checksum(np.array([-0.0]))
    False
    """
    if values.dtype.kind not in "biuf":
        return digest([values.shape, [str(value) for value in values.ravel()]])
    numbers = np.ascontiguousarray(values, dtype=values.dtype.newbyteorder("<"))
    total = hashlib.sha256(repr((numbers.shape, numbers.dtype.str)).encode())
    total.update(numbers.data)  # without a copy
    return total.hexdigest()


def sealed(data: Mapping[str, Any]) -> dict[str, Any]:
    """The same plain data with their digest.

    Examples
    --------
    >>> opened(sealed({"x": 1.5}))
    {'x': 1.5}
    """
    return {**data, SEAL: digest(dict(data))}


def opened(data: Mapping[str, Any]) -> dict[str, Any]:
    """The data without their digest; raise unless they are those that were sealed.

    Examples
    --------
    >>> opened({**sealed({"x": 1.5}), "x": 2.5})
    Traceback (most recent call last):
    flockana.base.errors.FileError: its digest is not that of its contents (after a change on purpose, take it out)
    """
    rest = {key: value for key, value in data.items() if key != SEAL}
    if data.get(SEAL) != digest(rest):
        raise FileError("its digest is not that of its contents (after a change on purpose, take it out)")
    return rest
