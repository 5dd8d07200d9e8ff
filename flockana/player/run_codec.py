"""Compact encoding of runs for a page: 32-bit numbers, differences in time, deflated.

``b"FLK1"``, then one zlib stream: the length of a JSON header (4 bytes, little-endian), the header, and the arrays one
after the other. An array of shape (T, …) is T rows of k whole numbers of 32 bits: the bits of float32, or
round((x − origin)/step). Each row but the first is less the one before it (modulo 2³²), and the numbers lie transposed
(all times of one agent together) and split (first the low bytes of all, …), which is what deflate compresses best.
"""

import json
import zlib
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from flockana.base.errors import ArgumentError
from flockana.base.value_checks import FloatArray

_MAGIC = b"FLK1"
_STEPS = 2.0**30  # more of them in one array than this would not fit 32 bits


@dataclass(frozen=True)
class Packed:
    """Array to be encoded for a page: numbers with time as their first axis, and the resolution to keep."""

    values: Any  # shape (T, …): numbers; the first axis is time
    step: float = 0.0  # resolution to which they are kept, > 0; or 0 for that of float32


def encode(header: Mapping[str, Any], arrays: Mapping[str, Packed]) -> bytes:
    """Return a header and named arrays encoded as compressed bytes for the player's page."""
    entries, bodies = [], []
    for name, packed_array in arrays.items():
        values = np.asarray(packed_array.values, dtype=np.float64)
        quantised, origin = _quantise(name, values, packed_array.step)
        entries.append({"name": name, "shape": values.shape, "step": packed_array.step, "origin": origin})
        value_rows = quantised.reshape(len(values), int(np.prod(values.shape[1:])))
        change = np.diff(value_rows, axis=0, prepend=np.zeros((1, value_rows.shape[1]), dtype="<u4"))
        bodies.append(np.ascontiguousarray(change.T).view(np.uint8).reshape(-1, 4).T.tobytes())
    text = json.dumps(dict(header) | {"arrays": entries}, ensure_ascii=False, allow_nan=False).encode("utf-8")
    return _MAGIC + zlib.compress(b"".join([len(text).to_bytes(4, "little"), text, *bodies]), 9)


def decode(data: bytes) -> tuple[dict[str, Any], dict[str, FloatArray]]:
    """Return (header, arrays by name) from the bytes of `encode`, as decode.js does in the page."""
    try:
        if data[:4] != _MAGIC:
            raise ValueError("its first bytes are not FLK1")
        raw_bytes = zlib.decompress(data[4:])
        start = 4 + int.from_bytes(raw_bytes[:4], "little")
        header = json.loads(raw_bytes[4:start].decode("utf-8"))
        arrays = {}
        for entry in header.pop("arrays"):
            rows, value_count = entry["shape"][0], int(np.prod(entry["shape"]))
            planes = np.frombuffer(raw_bytes, np.uint8, 4 * value_count, start).reshape(4, value_count)
            start += 4 * value_count
            words = np.ascontiguousarray(planes.T).view("<u4").reshape(value_count // max(rows, 1), rows).T
            words = np.cumsum(words, axis=0, dtype=np.uint32)
            if entry["step"] == 0.0:
                values = np.ascontiguousarray(words).view("<f4").astype(np.float64)
            else:
                values = entry["origin"] + entry["step"] * words.astype(np.float64)
            arrays[entry["name"]] = values.reshape(entry["shape"])
    except (ValueError, KeyError, TypeError, IndexError, zlib.error) as error:
        raise ArgumentError(f"{len(data)} bytes: expected those of a run for the player ({error})") from None
    return header, arrays


def _quantise(name: str, values: FloatArray, step: float) -> tuple[Any, float]:
    """Return an array encoded as 32-bit integers, and the origin subtracted from its values."""
    with np.errstate(over="ignore"):
        single_precision = values.astype("<f4")
    if not np.isfinite(single_precision).all():
        raise ArgumentError(f"{name}: expected finite numbers that float32 holds")
    if step == 0.0:
        return single_precision.view("<u4"), 0.0
    origin = float(values.min()) if values.size else 0.0
    steps = np.rint((values - origin) / step)
    if steps.size and steps.max() > _STEPS:
        raise ArgumentError(f"{name}: step = {step:g} for a span of {np.ptp(values):g}: expected a longer step")
    return steps.astype("<u4"), origin
