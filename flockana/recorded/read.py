"""`read_recording`: files, arrays and tables of many kinds as a `Recording`."""

import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from flockana.base.checks import ensure_positive
from flockana.base.errors import ArgumentError, FileError, format_value
from flockana.base.files import ensure_path
from flockana.recorded.reading.arrays import mat_arrays, named_arrays, netcdf_arrays, npz_arrays
from flockana.recorded.reading.lammps import read_dump
from flockana.recorded.reading.names import Columns
from flockana.recorded.reading.table import table_arrays
from flockana.recorded.reading.text import read_text
from flockana.recorded.recording import Recording

_ARRAYS = {".npz": npz_arrays, ".npy": npz_arrays, ".mat": mat_arrays, ".nc": netcdf_arrays}
_ACCURACY = ("bound", "sd", "p_bound", "p_sd", "estimated")
_DUMPS = (".dump", ".lammpstrj", ".lammps")
_ITEM = b"ITEM:"


def read_recording(
    source: Any,
    *,
    columns: Columns = None,
    dt: float | None = None,
    clock: float | None = None,
    m: int | None = None,
    bound: Any = None,
    sd: Any = None,
    p_bound: Any = None,
    p_sd: Any = None,
) -> Recording:
    """Return a recording from a file, a table or arrays.

    Files are CSV or TSV tables (long: time, id, x, y, vx, vy; wide: time, x1, y1, x2, y2), npz, MATLAB (.mat), netCDF
    (a run of flockana, too) and text dumps of LAMMPS, whose places are unwrapped. A row without an agent's position is
    a gap.

    Parameters
    ----------
    source : path, pandas.DataFrame or mapping of str to array_like
        The file, the table, or arrays t (T,) and q (T, n, m), and p and u if there are any.
    columns : mapping or sequence of str, optional
        Names in the file, by "t", "frame", "id", "q", "p", "u" (lists of columns for the last three); or the names of
        the columns of a table without a header.
    dt : float, optional
        Time of a frame or a step, where there are no times.
    clock : float, optional
        Seconds in one time unit of the law, where times are dates.
    m : int, optional
        Dimension, of a dump; by default that of its positions.
    bound, sd, p_bound, p_sd : float or array_like, optional
        Accuracy, as in `Recording`; by default what a file of `Recording.save` states.

    Raises
    ------
    FileError
        If the file cannot be read or is damaged; the message names row and column.
    ArgumentError
        If columns, times or the accuracy are missing or wrong.

    Examples
    --------
    >>> read_recording({"t": [0.0, 0.1], "q": [[[0.0], [7.0]], [[0.1], [7.0]]]}, bound=1e-3).n
    2
    """
    accuracy = {"bound": bound, "sd": sd, "p_bound": p_bound, "p_sd": p_sd}
    dt = None if dt is None else ensure_positive("dt", dt)
    if isinstance(source, Mapping):
        by_name = columns if isinstance(columns, Mapping) else None
        return Recording(**named_arrays(source, "the mapping", columns=by_name, dt=dt), **accuracy)
    if hasattr(source, "columns") and hasattr(source, "iloc"):
        if any(name is not None and name not in source.columns for name in source.index.names):
            source = source.reset_index()  # times or agents are the index
        if columns is not None and not isinstance(columns, Mapping):
            if len(columns) != len(source.columns):
                raise ArgumentError(
                    f"columns has {len(columns)} names: expected {len(source.columns)}, as the frame has"
                )
            source = source.set_axis(list(columns), axis=1)
        return Recording(**table_arrays(source, columns, dt, clock), source="a frame", **accuracy)
    if not isinstance(source, str | os.PathLike):
        raise ArgumentError(
            f"source = {format_value(type(source).__name__)}: expected a file, a pandas frame, or arrays by name"
        )
    path = ensure_path(source)
    if not path.exists():
        raise FileError(f"no file {path}: expected CSV, TSV, npz, mat, netCDF or a dump of LAMMPS")
    try:
        given = {name: value for name, value in accuracy.items() if value is not None}
        contents = _contents(path, columns, dt, clock, m)
        kept = {name: value for name, value in contents.items() if not given or name not in _ACCURACY}
        return Recording(**({"source": path.name} | kept | given))
    except FileError:
        raise
    except ArgumentError as error:
        text = str(error)
        raise error if str(path) in text else ArgumentError(f"{path}: {text}") from None


def _contents(path: Path, columns: Columns, dt: float | None, clock: float | None, m: int | None) -> dict[str, Any]:
    suffix = path.suffix.lower()
    if suffix in _ARRAYS:
        by_name, arrays = columns if isinstance(columns, Mapping) else None, _ARRAYS[suffix](path)
        return _read_metadata(arrays) | named_arrays(arrays, str(path), columns=by_name, dt=dt)
    if suffix in _DUMPS or _starts_with_item(path):
        dump = read_dump(path, dt, m)
        return {name: dump[name] for name in "tqpu" if name in dump} | {"ids": [f"{i:g}" for i in dump["ids"]]}
    names = None if columns is None or isinstance(columns, Mapping) else list(columns)
    return table_arrays(read_text(path, names), columns, dt, clock)


def _read_metadata(arrays: Mapping[str, Any]) -> dict[str, Any]:
    """Return names, source and accuracy from the file that `Recording.save` wrote beside the samples."""
    if not {"ids", "source", "estimated"} <= arrays.keys():
        return {}
    found = {name: arrays[name][()] for name in _ACCURACY if name in arrays}
    return found | {"ids": arrays["ids"].tolist(), "source": str(arrays["source"])}


def _starts_with_item(path: Path) -> bool:
    try:
        with path.open("rb") as file:
            return file.read(len(_ITEM)) == _ITEM
    except OSError:
        return False  # the reader of tables says why
