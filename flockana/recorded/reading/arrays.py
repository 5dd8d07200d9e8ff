"""Arrays by name: npz, MATLAB and netCDF files, mappings."""

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np

from flockana.base.errors import ArgumentError, FileError
from flockana.recorded.reading.names import TIMES

_NAMES = {
    "t": TIMES,
    "q": ("q", "positions", "position", "pos", "x", "xy", "xyz"),
    "p": ("p", "velocities", "velocity", "vel", "v"),
    "u": ("u", "accelerations", "acceleration", "acc", "a", "inputs"),
}


def named_arrays(
    arrays: Mapping[str, Any], where: str, *, columns: Mapping[str, Any] | None = None, dt: float | None = None
) -> dict[str, Any]:
    """Return t, q, p and u among arrays by name."""
    given = {} if columns is None else dict(columns)
    lower = {str(name).lower(): name for name in arrays if name not in given.values()}
    found: dict[str, Any] = {}
    for kind, names in _NAMES.items():
        name = given.get(kind, next((lower[each] for each in names if each in lower), None))
        if kind in given and name not in list(arrays):
            raise ArgumentError(f"{where} has no array {name!r}: expected one of {', '.join(map(str, arrays))}")
        if name is not None:
            found[kind] = _array(arrays[name], kind, where)
    shown = ", ".join(f"{name} {np.shape(value)}" for name, value in arrays.items()) or "nothing"
    if "q" not in found:
        raise ArgumentError(
            f'{where} holds {shown}: expected t (T,) and q (T, n, m); name them by columns={{"t": ..., "q": ...}}'
        )
    q = found["q"]
    if q.ndim != 3:
        raise ArgumentError(
            f"{where}: {shown}: expected positions of shape (T, n, m), such as q.reshape(T, n, m) or stack([x, y], 2)"
        )
    if "t" not in found and dt is None:
        raise ArgumentError(f"{where} holds {shown} and no times: expected t, or dt=, the interval between samples")
    t = found["t"].reshape(-1) if "t" in found else (dt or 0.0) * np.arange(len(q))  # MATLAB has no vectors
    if len(t) != len(q):
        turned = [k for k in range(3) if q.shape[k] == len(t)]
        hint = f"; its axis {turned[0]} is that long: give numpy.moveaxis(q, {turned[0]}, 0)" if turned else ""
        raise ArgumentError(f"{where}: {len(t)} times and q of shape {q.shape}: expected (T, n, m){hint}")
    return found | {"t": t}


def _array(value: Any, kind: str, where: str) -> Any:
    """Return an array of real numbers, or raise."""
    try:
        array = np.asarray(value)
    except ValueError:
        raise ArgumentError(f"{where}: {kind} has rows of different lengths: expected an array of numbers") from None
    if array.dtype.kind not in "fiu":
        raise ArgumentError(f"{where}: {kind} is an array of {array.dtype}: expected real numbers")
    return array


@contextmanager
def _readable(path: Path, kind: str, remedy: str) -> Iterator[None]:
    """Turn what readers raise on damaged bytes, errors of many kinds, into one in a line."""
    try:
        yield
    except FileError:
        raise
    except Exception as error:
        reason = " ".join(str(error).split()) or type(error).__name__
        raise FileError(f"cannot read {path} as {kind}: {reason}; {remedy}") from None


def npz_arrays(path: Path) -> dict[str, Any]:
    """Return the arrays of an npz file; objects are refused, as they can run code."""
    with _readable(path, "npz", "write it by numpy.savez"):
        found = np.load(path, allow_pickle=False)
        if isinstance(found, np.ndarray):  # of a file .npy
            return {"q": found}
        with found as file:
            return {name: file[name] for name in file.files}


def mat_arrays(path: Path) -> dict[str, Any]:
    """Return the arrays of a MATLAB file."""
    from scipy.io import loadmat

    with _readable(path, "a MATLAB file", "expected save(..., '-v7')"):
        try:
            found = loadmat(path, squeeze_me=False)
        except NotImplementedError:
            raise FileError(f"{path} is a MATLAB file of version 7.3: expected save(..., '-v7')") from None
    return {name: value for name, value in found.items() if not name.startswith("__")}


def netcdf_arrays(path: Path) -> dict[str, Any]:
    """Return the arrays of a netCDF file, coordinates among them; of a run that flockana saved, too."""
    import xarray

    with (
        _readable(path, "netCDF-4", "expected q over (time, agent, axis)"),
        xarray.open_dataset(path, engine="h5netcdf", decode_times=False) as dataset,
    ):
        data = dataset.load()
    found = {str(name): np.asarray(data[name]) for name in (*data.coords, *data.data_vars)}
    return {name: value for name, value in found.items() if value.dtype.kind in "fiu"}
