"""Runs as labelled data and as netCDF-4 files, and back.

A file carries the seal of the run in it, a checksum of each of its fields, and so does the dataset of `to_xarray`: one
without is refused. What was made by hand is marked as a recording, and read as one. After the netCDF comes one line
with the digest of all bytes before it, which HDF5 does not read. That line is looked at first, so that HDF5 never sees
damaged bytes; the seal holds where another program wrote the file anew, too.
"""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Mapping
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, TypeVar, cast

import numpy as np

from flockana._version import __version__
from flockana.base.digests import sha256
from flockana.base.errors import FileError
from flockana.base.files import atomic_write, ensure_path
from flockana.base.integrity_seals import checksum, is_sealed, seal_of, sealed
from flockana.base.serialize import from_data, read_json, to_data, to_data_mapping
from flockana.dynamics.steps_between_samples import Between
from flockana.laws.first_order_law import ensure_any_law

if TYPE_CHECKING:
    import xarray

_Run = TypeVar("_Run")

FORMAT = "flockana-trajectory"
FORMAT_VERSION = 2  # seals of format 1 name the modules of classes
RUN, RECORDING = "simulate", "hand"  # what made it
_LINE = b"\nflockana sha256 %s\n"
_BLOCK = 2**20  # bytes read at once
_MARK, _LENGTH = b"\nflockana sha256", len(_LINE % (b"0" * 64))
_BETWEEN = {"t": ("step",), "slack": ("interval", "agent")} | dict.fromkeys("qpu", ("step", "agent", "axis"))


def to_xarray(run: Any) -> xarray.Dataset:
    """Return a run as an `xarray.Dataset`, as `Trajectory.to_xarray` does."""
    import xarray

    dims = ("time", "agent", "axis")
    data: dict[str, Any] = {"q": (dims, run.q), "p": (dims, run.p), "u": (dims, run.u)}
    data |= {f"extra_{k}": (("time", *(f"{k}_{a}" for a in range(v.ndim - 1))), v) for k, v in run.extra.items()}
    if run.between is not None:
        parts = vars(run.between)
        data |= {f"between_{k}": (_BETWEEN[k], parts[k]) for k in _BETWEEN if parts[k] is not None}
    coords = {"time": run.t, "agent": np.arange(run.n), "axis": list("xyz"[: run.m])}
    attrs = {
        "format": FORMAT,
        "format_version": FORMAT_VERSION,
        "flockana_version": __version__,
        "law": json.dumps(to_data(run.law)),
        "status": run.status,
        "message": run.message,
        "stats": json.dumps(to_data_mapping(run.stats)),
        "made_by": (made_by := RUN if is_sealed(run) else RECORDING),
        "seal": json.dumps(_file_seal(run, made_by)),
    }
    return xarray.Dataset(data, coords, attrs)


def save(dataset: xarray.Dataset, path: str | os.PathLike[str]) -> Path:
    """Write a run to a netCDF-4 file, as `Trajectory.save` does."""
    # in memory first: HDF5 tears itself apart on a disk that fills
    netcdf = dataset.to_netcdf(None, engine="h5netcdf")
    with atomic_write(path, remedy="choose a file name and folder to write to") as partial, partial.open("wb") as file:
        file.write(netcdf)
        file.write(_LINE % sha256([netcdf]).encode())
    return Path(path)


def _ensure_intact(run: Any, attributes: Mapping[str, Any], source: Path) -> Any:
    """Return the loaded run, sealed if the saved run was; raise on any changed field."""
    if "seal" not in attributes:
        raise FileError(
            f"{source} is damaged: it has no seal, which every file of a run is written with; run the simulation again"
        )
    modules = _format_1_modules() if int(attributes["format_version"]) == 1 else {}
    seal, seal_of_file = read_json(attributes["seal"]), _file_seal(run, attributes["made_by"], modules)
    differing = sorted(name for name in {*seal, *seal_of_file} if seal.get(name) != seal_of_file.get(name))
    if differing:
        raise FileError(
            f"{source} is damaged: {', '.join(differing)} not as saved, by the checksums; run the simulation again"
        )
    return sealed(run) if attributes["made_by"] == RUN else run


def _file_seal(run: Any, made_by: str, modules: Mapping[str, str] = MappingProxyType({})) -> dict[str, str]:
    """Return the checksums of a run's fields, and of whether it is a run or a recording."""
    return seal_of(run, modules) | {"made_by": checksum(made_by)}


def _format_1_modules() -> dict[str, str]:
    """Return the module name by class in seals of format-1 files."""
    lines = Path(__file__).with_name("format_1_modules.txt").read_text("utf-8").splitlines()
    return {name: module for module, *names in map(str.split, lines) for name in names}


def _ensure_whole(source: Path) -> None:
    """Raise if a file ends in a digest line, or a part of one, that is not the digest of the bytes before it."""
    byte_count = source.stat().st_size
    with source.open("rb") as file:
        file.seek(max(0, byte_count - 2 * _LENGTH))
        end = file.read()
        if _MARK not in end:
            return  # another program wrote it, or flockana before there was such a line
        file.seek(0)
        data_length = max(0, byte_count - _LENGTH)
        total = sha256(file.read(min(_BLOCK, data_length - k)) for k in range(0, data_length, _BLOCK))
    if end[-_LENGTH:] != _LINE % total.encode():
        raise FileError(
            f"cannot read {source} as netCDF-4: it was cut short or altered, by the digest at its end; "
            "run the simulation again"
        )


def load(run_of: Callable[..., _Run], path: str | os.PathLike[str]) -> _Run:
    """Read a run from a netCDF-4 file, as `Trajectory.load` does."""
    import xarray

    source = ensure_path(path)
    if not os.path.isfile(source):
        raise FileError(f"no file {source}: expected one written by Trajectory.save")
    try:
        _ensure_whole(source)
        with xarray.open_dataset(source, engine="h5netcdf") as dataset:
            data = dataset.load()
    except FileError:
        raise
    except Exception as error:  # h5py raises many kinds on damaged bytes
        raise FileError(f"cannot read {source} as netCDF-4: {error}; was it written by Trajectory.save?") from error
    if data.attrs.get("format") != FORMAT:
        raise FileError(f"{source} holds no flockana run (format {data.attrs.get('format')!r}, expected {FORMAT!r})")
    try:
        version = int(data.attrs["format_version"])
        if version > FORMAT_VERSION:
            raise FileError(f"{source} is of format {version}, newer than {FORMAT_VERSION}: update flockana")
        if version < 1:
            raise FileError(f"{source} is damaged: there is no format {version}; run the simulation again")
        run = run_of(
            t=np.array(data["time"]),
            q=np.array(data["q"]),
            p=np.array(data["p"]),
            u=np.array(data["u"]),
            law=ensure_any_law(from_data(read_json(data.attrs["law"]))),
            extra={str(k)[6:]: np.array(v) for k, v in data.data_vars.items() if str(k).startswith("extra_")},
            status=str(data.attrs["status"]),
            message=str(data.attrs["message"]),
            stats=read_json(data.attrs["stats"]),
            between=_read_between(data),
        )
        return cast(_Run, _ensure_intact(run, data.attrs, source))
    except (KeyError, ValueError, TypeError, RecursionError) as error:
        raise FileError(f"{source} is damaged: {error!r}; run the simulation again") from error


def _read_between(data: xarray.Dataset) -> Between | None:
    """Return the steps between samples from a file's dataset; None without any."""
    if "between_t" not in data:
        return None
    return Between(**{name: np.array(data[f"between_{name}"]) for name in _BETWEEN if f"between_{name}" in data})
