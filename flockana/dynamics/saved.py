"""Runs as labelled data and as netCDF-4 files, and back."""

from __future__ import annotations

import json
import os
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np

from flockana._version import __version__
from flockana.base.errors import FileError
from flockana.base.files import replacing
from flockana.base.serialize import from_data, to_data, to_data_mapping
from flockana.dynamics.between import Between
from flockana.laws.discrete import ensure_law

if TYPE_CHECKING:
    import xarray

_Run = TypeVar("_Run")

FORMAT = "flockana-trajectory"
FORMAT_VERSION = 1
_BETWEEN = {"t": ("step",), "slack": ("interval", "agent")} | dict.fromkeys("qpu", ("step", "agent", "axis"))


def to_xarray(run: Any) -> xarray.Dataset:
    """See `Trajectory.to_xarray`."""
    import xarray

    dims = ("time", "agent", "axis")
    data: dict[str, Any] = {"q": (dims, run.q), "p": (dims, run.p), "u": (dims, run.u)}
    data |= {f"extra_{k}": (("time", *(f"{k}_{a}" for a in range(v.ndim - 1))), v) for k, v in run.extra.items()}
    if run.between is not None:
        kept = vars(run.between)
        data |= {f"between_{k}": (_BETWEEN[k], kept[k]) for k in _BETWEEN if kept[k] is not None}
    coords = {"time": run.t, "agent": np.arange(run.n), "axis": list("xyz"[: run.m])}
    attrs = {
        "format": FORMAT,
        "format_version": FORMAT_VERSION,
        "flockana_version": __version__,
        "law": json.dumps(to_data(run.law)),
        "status": run.status,
        "message": run.message,
        "stats": json.dumps(to_data_mapping(run.stats)),
    }
    return xarray.Dataset(data, coords, attrs)


def save(dataset: xarray.Dataset, path: str | os.PathLike[str]) -> Path:
    """See `Trajectory.save`."""
    target = Path(path)
    if "\0" in str(target):  # HDF5 would write to what precedes it
        raise FileError(f"cannot write {str(target)!r}: null byte; choose a file name and folder to write to")
    with replacing(target, remedy="choose a file name and folder to write to") as partial:
        dataset.to_netcdf(partial, engine="h5netcdf")
    return target


def load(run_of: Callable[..., _Run], path: str | os.PathLike[str]) -> _Run:
    """See `Trajectory.load`."""
    import xarray

    source = Path(path)
    if not source.is_file():
        raise FileError(f"no file {source}: expected one written by Trajectory.save")
    try:
        with xarray.open_dataset(source, engine="h5netcdf") as dataset:
            data = dataset.load()
    except Exception as error:  # h5py raises many kinds on damaged bytes
        raise FileError(f"cannot read {source} as netCDF-4: {error}; was it written by Trajectory.save?") from error
    if data.attrs.get("format") != FORMAT:
        raise FileError(f"{source} holds no flockana run (format {data.attrs.get('format')!r}, expected {FORMAT!r})")
    try:
        version = int(data.attrs["format_version"])
        if version > FORMAT_VERSION:
            raise FileError(f"{source} is of format {version}, newer than {FORMAT_VERSION}: update flockana")
        return run_of(
            t=np.array(data["time"]),
            q=np.array(data["q"]),
            p=np.array(data["p"]),
            u=np.array(data["u"]),
            law=ensure_law(from_data(json.loads(data.attrs["law"]))),
            extra={str(k)[6:]: np.array(v) for k, v in data.data_vars.items() if str(k).startswith("extra_")},
            status=str(data.attrs["status"]),
            message=str(data.attrs["message"]),
            stats=json.loads(data.attrs["stats"]),
            between=_read_between(data),
        )
    except (KeyError, ValueError, TypeError, RecursionError) as error:
        raise FileError(f"{source} is damaged: {error!r}; run the simulation again") from error


def _read_between(data: xarray.Dataset) -> Between | None:
    """The steps between the samples in what was read from a file."""
    if "between_t" not in data:
        return None
    return Between(**{name: np.array(data[f"between_{name}"]) for name in _BETWEEN if f"between_{name}" in data})
