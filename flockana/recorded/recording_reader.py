"""`read_recording`: files, arrays and tables of many kinds as a `Recording`."""

import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any, NamedTuple

from flockana.base.errors import ArgumentError, FileError, format_value
from flockana.base.files import ensure_path
from flockana.base.value_checks import ensure_positive
from flockana.recorded.periodic_boxes import unwrapped
from flockana.recorded.reading.arrays import dataset_arrays, mat_arrays, named_arrays, netcdf_arrays, npz_arrays
from flockana.recorded.reading.column_names import Columns, renaming_note
from flockana.recorded.reading.lammps_dumps import read_dump
from flockana.recorded.reading.missing import without_missing
from flockana.recorded.reading.table import AGENTS, table_arrays
from flockana.recorded.reading.text_tables import read_text
from flockana.recorded.recording import Recording
from flockana.recorded.sampling_clocks import ensure_one_clock, interpolated

_ARRAYS = {".npz": npz_arrays, ".npy": npz_arrays, ".mat": mat_arrays}
_ACCURACY = ("bound", "sd", "p_bound", "p_sd", "estimated", "smoothed")
_DUMPS = (".dump", ".lammpstrj", ".lammps")
_ITEM = b"ITEM:"


def read_recording(
    source: Any,
    *,
    columns: Columns = None,
    dt: float | None = None,
    clock: float | None = None,
    m: int | None = None,
    axes: Any = None,
    jitter: float | None = None,
    box: Any = None,
    interpolate: float | bool | None = None,
    missing: Any = None,
    bound: Any = None,
    sd: Any = None,
    p_bound: Any = None,
    p_sd: Any = None,
) -> Recording:
    """Return a recording from a file, a table or arrays.

    Files are tables, separated by commas, semicolons, tabs or blanks (long: time, id, x, y, vx, vy; wide: time, x1, y1,
    x2, y2), npz, npy, MATLAB (.mat), netCDF (a run of flockana, or a dataset of `movement`) and text dumps of LAMMPS,
    whose places are unwrapped. A row without an agent's position is a gap. `Recording.read_as` says which column became
    what; what can be read in two ways is refused with both.

    Parameters
    ----------
    source : path, pandas.DataFrame, xarray.Dataset or mapping of str to array_like
        The file, the table, the dataset, or arrays t (T,) and q (T, n, m), and p and u if there are any; or the columns
        of a long table.
    columns : mapping or sequence of str, optional
        Names in the file, by "t", "frame", "id", "q", "p", "u" (lists of columns for the last three), and "agents", the
        names of those in a wide table; or the names of the columns of a table without a header.
    dt : float, optional
        Time of a frame, a row or a step, where there are no times.
    clock : float, optional
        Seconds in one time unit of the law, where times are dates.
    m : int, optional
        Dimension, of a dump or a table; by default that of its positions.
    axes : str or sequence of str, optional
        Which axis of an array is which, such as "time axis agent"; by default (T, n, m), time, agent and axis.
    jitter : float, optional
        Stamps of a table within this of each other are one instant; by default those that differ by rounding.
    box : float or sequence of float, optional
        Periods of the positions along each axis, inf where there is none; positions are unwrapped.
    interpolate : float or False, optional
        Largest acceleration of an agent, by which agents of a table that were sampled at other times are interpolated
        to common instants, each position with an error that covers every such motion; False leaves gaps instead. By
        default such a table is refused.
    missing : float or sequence of float, optional
        Numbers that stand for a position not seen, such as -9999, and become gaps; () if none does. By default numbers
        that look so are refused: returning ones far from all others, or to which agents leap.
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
    if isinstance(columns, str):
        raise ArgumentError(f'columns = {columns!r}: expected names in order, or by meaning, such as {{"t": "when"}}')
    accuracy = {"bound": bound, "sd": sd, "p_bound": p_bound, "p_sd": p_sd}
    dt = None if dt is None else ensure_positive("dt", dt)
    read_options = _How(columns, dt, clock, m, axes, jitter, missing, box is not None)
    if isinstance(source, str | os.PathLike):
        rec = _of_file(ensure_path(source), read_options, accuracy)
    elif hasattr(source, "data_vars"):
        arrays = _of_arrays(dataset_arrays(source, "the dataset"), "the dataset", read_options)
        rec = Recording(**without_missing(arrays, missing, "the dataset"), **accuracy)
    elif isinstance(source, Mapping):
        arrays = _of_arrays(source, "the mapping", read_options)
        rec = Recording(**without_missing(arrays, missing, "the mapping"), **accuracy)
    elif hasattr(source, "columns") and hasattr(source, "iloc"):
        arrays = without_missing(_of_frame(source, read_options), missing, "the frame")
        rec = Recording(**arrays, source="a frame", **accuracy)
    else:
        raise ArgumentError(
            f"source = {format_value(type(source).__name__)}: expected a file, a pandas frame, an xarray "
            "dataset, or arrays by name"
        )
    for name, value, text in (("axes", axes, "arrays"), ("clock", clock, "times that are dates")):
        if value is not None and not any(note.startswith(("axes in", "dates count")) for note in rec.read_as):
            raise ArgumentError(f"{name} = {value!r} is for {text}, and there are none: expected no {name}=")
    rec = rec if box is None else unwrapped(rec, box)
    if interpolate is not None and interpolate is not False:
        return interpolated(rec, ensure_positive("interpolate", interpolate))
    if interpolate is None and any(text.startswith(AGENTS) for text in rec.read_as):
        ensure_one_clock(rec)
    return rec


class _How(NamedTuple):
    """The user's options for reading a recording, such as columns, time step and axes."""

    columns: Columns
    dt: float | None
    clock: float | None
    m: int | None
    axes: Any
    jitter: float | None
    missing: Any
    wrapped: bool


def _of_arrays(arrays: Mapping[str, Any], where: str, how: _How) -> dict[str, Any]:
    if how.columns is not None and not isinstance(how.columns, Mapping):
        raise ArgumentError(f'columns = {how.columns!r}: {where} has arrays by name: expected {{"t": ..., "q": ...}}')
    options = {key: value for key, value in how._asdict().items() if key not in ("missing", "wrapped")}
    named = named_arrays(arrays, where, **options)
    ids = arrays.get("ids") if isinstance(arrays.get("ids"), tuple) else None
    return named if ids is None else named | {"ids": ids}


def _of_frame(frame: Any, how: _How) -> dict[str, Any]:
    columns = how.columns
    if any(name is not None and name not in frame.columns for name in frame.index.names):
        frame = frame.reset_index()  # times or agents are the index
    if columns is not None and not isinstance(columns, Mapping):
        note = renaming_note(list(frame.columns), columns, "the frame")
        frame = frame.set_axis(list(columns), axis=1)
        frame.attrs["notes"] = (note,) if note else ()
    return table_arrays(frame, columns, how.dt, how.clock, how.m, how.jitter)


def _of_file(path: Path, how: _How, accuracy: Mapping[str, Any]) -> Recording:
    if not path.exists():
        raise FileError(f"no file {path}: expected CSV, TSV, npz, mat, netCDF or a dump of LAMMPS")
    try:
        stated_values = {name: value for name, value in accuracy.items() if value is not None}
        contents = _contents(path, how)
        if how.missing is not None or "estimated" not in contents:  # Recording.save has written NaN
            contents = without_missing(contents, how.missing, str(path))
        arrays = {name: value for name, value in contents.items() if not stated_values or name not in _ACCURACY}
        return Recording(**({"source": path.name} | arrays | stated_values))
    except FileError:
        raise
    except ArgumentError as error:
        text = str(error)
        raise error if str(path) in text else ArgumentError(f"{path}: {text}") from None


def _contents(path: Path, how: _How) -> dict[str, Any]:
    suffix = path.suffix.lower()
    if suffix == ".nc":
        return _of_arrays(dataset_arrays(netcdf_arrays(path), str(path)), str(path), how)
    if suffix in _ARRAYS:
        arrays = _ARRAYS[suffix](path)
        return _of_arrays(arrays, str(path), how) | _read_metadata(arrays)
    if suffix in _DUMPS or _starts_with_item(path):
        dump = read_dump(path, how.dt, how.m, wrapped=how.wrapped)
        stored = [name for name in "qpu" if name in dump]
        texts = ("t from TIME" if how.dt is None else "t from TIMESTEP times dt", f"{', '.join(stored)} from the dump")
        return {name: dump[name] for name in ["t", *stored]} | {
            "ids": [f"{i:g}" for i in dump["ids"]],
            "read_as": texts,
        }
    names = None if how.columns is None or isinstance(how.columns, Mapping) else list(how.columns)
    return table_arrays(read_text(path, names), how.columns, how.dt, how.clock, how.m, how.jitter)


def _read_metadata(arrays: Mapping[str, Any]) -> dict[str, Any]:
    """Return names, source and accuracy from the file written by `Recording.save` beside the samples."""
    if not {"ids", "source", "estimated"} <= arrays.keys():
        return {}
    stated_values = {name: arrays[name][()] for name in _ACCURACY if name in arrays}
    return stated_values | {"ids": arrays["ids"].tolist(), "source": str(arrays["source"])}


def _starts_with_item(path: Path) -> bool:
    try:
        with path.open("rb") as file:
            return file.read(len(_ITEM)) == _ITEM
    except OSError:
        return False  # the reader of tables says why
