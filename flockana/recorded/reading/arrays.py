"""Recordings from arrays by name: npz, npy, MATLAB and netCDF files, mappings, datasets of `movement`."""

import pickle
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np

from flockana.base.errors import ArgumentError, FileError
from flockana.recorded.reading.array_axes import (
    AXES,
    is_smoother_along_second,
    order_of,
    possible_orders,
    rank,
    real_array,
    turned,
    with_joined_axes,
)
from flockana.recorded.reading.column_names import is_header
from flockana.recorded.reading.column_words import coordinate, is_agent, is_frame, is_time, words_of
from flockana.recorded.reading.table import table_arrays

_NAMES = {
    "t": ("t", "time", "times", "timestamp", "timestamps", "seconds", "tau"),
    "q": (
        "q",
        "positions",
        "position",
        "pos",
        "x",
        "xy",
        "xyz",
        "trajectories",
        "trajectory",
        "tracks",
        "locations",
        "coords",
    ),
    "p": ("p", "velocities", "velocity", "vel", "v"),
    "u": ("u", "accelerations", "acceleration", "acc", "a", "inputs"),
}
_RATES = ("fps", "frames_per_second", "frame_rate", "framerate")
_SAFE = {"ndarray", "dtype", "_reconstruct", "scalar", "OrderedDict", "_frombuffer", "_codecs", "encode"}


def named_arrays(
    arrays: Mapping[str, Any],
    where: str,
    *,
    columns: Mapping[str, Any] | None = None,
    dt: float | None = None,
    axes: Any = None,
    clock: float | None = None,
    m: int | None = None,
    jitter: float | None = None,
) -> dict[str, Any]:
    """Return t, q, p, u and notes on how they were read, from arrays by name or a long table's columns."""
    arrays = _without_shells(arrays)
    stated_columns = {} if columns is None else dict(columns)
    if (frame := _long_table(arrays, stated_columns, dt)) is not None:
        frame.attrs["where"] = where
        return table_arrays(frame, stated_columns or None, dt, clock, m, jitter)
    order = None if axes is None else order_of(axes)
    arrays, joined_names = with_joined_axes(arrays, stated_columns, order, where)
    stated_columns = {kind: name for kind, name in stated_columns.items() if kind not in joined_names}
    lower = {str(name).lower(): name for name in arrays if name not in stated_columns.values()}
    filed, reading_remarks = dict[str, Any](), []
    for kind, names in _NAMES.items():
        spellings = [lower[item] for item in names if item in lower]
        if kind not in stated_columns and len(spellings) > 1:
            raise ArgumentError(
                f"{where}: {', '.join(map(repr, spellings))} may each be {kind}: expected columns={{{kind!r}: ...}}"
            )
        name = stated_columns.get(kind, spellings[0] if spellings else None)
        if kind in stated_columns and name not in list(arrays):
            raise ArgumentError(f"{where} has no array {name!r}: expected one of {', '.join(map(str, arrays))}")
        if name is not None:
            filed[kind] = real_array(arrays[name], kind, where)
            by_default = " as (time, agent, axis)" if filed[kind].ndim == 3 and order is None else ""
            reading_remarks.append(f"{kind} from {joined_names.get(name, repr(name))} {filed[kind].shape}{by_default}")
    listing = ", ".join(f"{name} {np.shape(value)}" for name, value in arrays.items()) or "nothing"
    if "q" not in filed:
        raise ArgumentError(
            f'{where} holds {listing}: expected t (T,) and q (T, n, m); name them by columns={{"t": ..., "q": ...}}'
        )
    if order is not None:
        filed |= {k: turned(filed[k], order, k, where) for k in "qpu" if k in filed and k not in joined_names}
        reading_remarks.append(f"axes in the order {', '.join(('time', 'agent', 'axis')[k] for k in order)}")
    q = filed["q"]
    if q.ndim != 3:
        raise ArgumentError(
            f"{where}: {listing}: expected positions of shape (T, n, m); say which axis is which by axes=, such as "
            'axes=("time", "axis") of one agent, or ("time", "agent") on a line'
        )
    step, rate = _interval(lower, arrays, dt, where)
    if "t" not in filed and step is None:
        raise ArgumentError(f"{where} holds {listing} and no times: expected t, or dt=, the interval between samples")
    if "t" in filed and dt is not None:
        raise ArgumentError(f"{where} has times, and dt = {dt:g} is given: expected one of them; leave dt= out")
    counts = {x: np.size(array) if rank(array) else 0 for x, array in arrays.items()}
    frame = next((x for x in arrays if is_frame(words_of(x)[0]) and counts[x] == len(q)), None)
    count = np.arange(len(q)) if frame is None else real_array(arrays[frame], "frame", where)
    t = (filed["t"] if "t" in filed else (step or 0.0) * count).reshape(-1)  # MATLAB has no vectors
    if "t" not in filed:
        reading_remarks.append(f"t from {'the samples' if frame is None else repr(frame)} {rate or 'times dt'}")
    if len(t) != len(q):
        orders = [] if joined_names else possible_orders(q, [k for k in (1, 2) if q.shape[k] == len(t)])
        hint = f"; expected (T, n, m), or axes={' or axes='.join(orders or ['...'])}, which decides"
        hint = '; expected one row for each time, or axes="agent time"' if joined_names and order is None else hint
        raise ArgumentError(f"{where}: {len(t)} times and q of shape {q.shape}{hint}")
    if q.shape[2] > 3:
        raise ArgumentError(
            f"{where}: q of shape {q.shape} has {q.shape[2]} axes if read as (T, n, m): expected 1 to 3; name them by "
            'axes=, such as axes=("time", "axis", "agent")'
        )
    if order is None and ("t" not in filed or q.shape[0] == q.shape[1]) and is_smoother_along_second(q):
        choice = '"agent time"' if joined_names else " or axes=".join(possible_orders(q, [1, 0]))
        raise ArgumentError(
            f"{where}: q of shape {q.shape} changes little along its second axis, and much along the first, which may "
            f"be the time or the agent: expected axes={choice}, which decides"
        )
    read = {stated_columns.get(kind, next((x for x in _NAMES[kind] if x in lower), "")) for kind in filed} | {frame}
    unused_names = [repr(x) for x in arrays if x not in read and str(x).lower() not in read and counts[x] > 1]
    reading_remarks += [f"not read: {', '.join(unused_names)}"] if unused_names else []
    if m is not None and (np.ndim(m) or m not in range(1, q.shape[2] + 1)):
        raise ArgumentError(f"m = {m!r}: expected 1 to {q.shape[2]}, of which {where} has positions")
    if m is not None:
        filed |= {kind: filed[kind][..., :m] for kind in "qpu" if kind in filed}
        reading_remarks.append(f"the first {m} of {q.shape[2]} axes, as m = {m}")
    return filed | {"t": t, "read_as": tuple(reading_remarks)}


def _interval(lower: Mapping[str, Any], arrays: Mapping[str, Any], dt: float | None, where: str) -> tuple[Any, str]:
    """Return the sampling interval, given or from a frame rate beside the arrays."""
    name = next((lower[item] for item in _RATES if item in lower), None)
    rate = np.asarray(arrays[name]).reshape(-1) if name is not None else np.empty(0)
    if rate.size != 1 or rate.dtype.kind not in "fiu" or not rate[0] > 0:
        return dt, ""
    if dt is not None and abs(dt * float(rate[0]) - 1.0) > 1e-6:
        raise ArgumentError(f"{where} has {name} = {rate[0]:g}, and dt = {dt:g} is given: expected one of them")
    return 1.0 / float(rate[0]), f"over {name} = {rate[0]:g}"


def _without_shells(arrays: Mapping[str, Any]) -> Mapping[str, Any]:
    """Return arrays by name from nested dictionaries and structures, possibly one for each agent."""
    for value in list(arrays.values()):
        inner = _dictionaries(value)
        if inner and len(arrays) <= 1 + sum(_dictionaries(x) == [] for x in arrays.values()):
            if len(inner) == 1:
                other_arrays = {k: x for k, x in arrays.items() if x is not value}
                return _without_shells({**other_arrays, **inner[0]})
            return _joined_agents(inner)
    return arrays


def _dictionaries(value: Any) -> list[Mapping[str, Any]]:
    """Return the dictionaries inside a list, an array of objects or a MATLAB structure; none otherwise."""
    if isinstance(value, Mapping):
        return [value]
    if isinstance(value, np.ndarray) and value.dtype.names:
        return [{name: np.squeeze(dictionary[name]) for name in value.dtype.names} for dictionary in value.reshape(-1)]
    items = list(value.reshape(-1)) if isinstance(value, np.ndarray) and value.dtype.hasobject else value
    if isinstance(items, list) and items and all(isinstance(x, np.ndarray) and x.dtype.names for x in items):
        return [dictionary for x in items for dictionary in _dictionaries(x)]
    if isinstance(items, list | tuple) and items and all(isinstance(x, Mapping) for x in items):
        return list(items)
    return []


def _joined_agents(agents: Sequence[Mapping[str, Any]]) -> dict[str, Any]:
    """Return the dictionaries of all agents as one long table, columns by name."""
    table: dict[str, list[Any]] = {}
    for k, agent in enumerate(agents):
        columns = dict[str, Any]()
        for name, value in agent.items():
            array = np.asarray(value)
            array = array.reshape(-1) if array.ndim > 1 and 1 in array.shape else array
            if array.ndim == 2 and 1 <= array.shape[1] <= 3:
                columns |= {f"{name}_{'xyz'[j]}": array[:, j] for j in range(array.shape[1])}
            elif array.ndim == 1 and array.size > 1:
                columns[str(name)] = array
            elif is_agent(words_of(name)[0]) and array.size == 1:
                columns[str(name)] = array.reshape(-1)
        rows = max((len(x) for x in columns.values()), default=0)
        columns = {name: x for name, x in columns.items() if len(x) in (1, rows) or is_header(name)}
        names = [name for name in columns if is_agent(words_of(name)[0])] or ["id"]
        columns.setdefault(names[0], np.array([k]))
        columns = {name: np.repeat(x, rows) if len(x) == 1 else x for name, x in columns.items()}
        if (bad_name := next((name for name, x in columns.items() if len(x) != rows), None)) is not None:
            raise ArgumentError(
                f"agent {k}: {bad_name!r} has {len(columns[bad_name])} values: expected {rows}, one for each sample"
            )
        for name, x in columns.items():
            table.setdefault(name, []).append(x)
    if (bad_name := next((name for name, parts in table.items() if len(parts) != len(agents)), None)) is not None:
        raise ArgumentError(f"{len(agents)} agents, and {bad_name!r} is not of each: expected the same names for all")
    return {name: np.concatenate(parts) for name, parts in table.items()}


def _long_table(arrays: Mapping[str, Any], given: Mapping[str, Any], dt: float | None) -> Any:
    """Return arrays of one length as columns of a long table; None otherwise."""
    import pandas as pd

    try:
        plain_arrays = {str(name): np.asarray(x) for name, x in arrays.items()}
    except ValueError:  # rows of different lengths
        return None
    columns = {name: x.reshape(-1) for name, x in plain_arrays.items() if x.size == max(x.shape, default=0)}
    columns = {name: x for name, x in columns.items() if x.size > 1 or len(columns) == len(arrays)}
    if len({x.size for x in columns.values()}) != 1:
        return None
    agents = "id" in given or any(is_agent(words_of(name)[0]) for name in columns)
    position_names = [name for name in plain_arrays if coordinate(*words_of(name)) is not None]
    is_one_agent = bool(position_names) and {*position_names} <= {*columns}  # all numbers are of one agent
    times = any(is_time(words_of(name)[0]) or is_frame(words_of(name)[0]) for name in columns)
    times = times or bool({"t", "frame"} & given.keys()) or (is_one_agent and dt is not None)
    if not ((agents or is_one_agent) and times) or any(x.ndim > 2 for x in plain_arrays.values()):
        return None
    return pd.DataFrame(columns)


@contextmanager
def _readable(path: Path, kind: str, remedy: str) -> Iterator[None]:
    """Convert any error of a reader on damaged bytes into a one-line error."""
    try:
        yield
    except FileError:
        raise
    except Exception as error:
        reason = " ".join(str(error).split()) or type(error).__name__
        raise FileError(f"cannot read {path} as {kind}: {reason}; {remedy}") from None


class _PlainUnpickler(pickle.Unpickler):
    """Safe unpickler of dictionaries, lists, numbers and numpy arrays; all else is rejected, as it could run code."""

    def find_class(self, module: str, name: str) -> Any:
        if module.split(".")[0] in ("numpy", "collections", "_codecs") and name in _SAFE:
            return super().find_class(module, name)
        raise pickle.UnpicklingError(f"it holds {module}.{name}, which is neither a number nor an array")


def npz_arrays(path: Path) -> dict[str, Any]:
    """Return the arrays of an npz or npy file; object arrays may hold dictionaries of arrays only."""
    with _readable(path, "npz", "write it by numpy.savez"):
        with path.open("rb") as file:
            if file.read(6) == b"\x93NUMPY":
                return _npy_array(file)
        with np.load(path, allow_pickle=False) as arrays:
            return {name: arrays[name] for name in arrays.files}


def _npy_array(file: Any) -> dict[str, Any]:
    """Return the array of an npy file; dictionaries in an array of objects are unpickled without running code."""
    file.seek(0)
    version = np.lib.format.read_magic(file)
    reader = np.lib.format.read_array_header_1_0 if version == (1, 0) else np.lib.format.read_array_header_2_0
    if not reader(file)[2].hasobject:
        file.seek(0)
        return {"q": np.load(file, allow_pickle=False)}
    content = np.asarray(_PlainUnpickler(file).load(), dtype=object)
    if not _dictionaries(content):
        raise ValueError("it holds objects that are no dictionaries of arrays by name")
    return {"objects": content}


def mat_arrays(path: Path) -> dict[str, Any]:
    """Return the arrays of a MATLAB file."""
    from scipy.io import loadmat

    with _readable(path, "a MATLAB file", "expected save(..., '-v7')"):
        try:
            arrays = loadmat(path, squeeze_me=False)
        except NotImplementedError:
            raise FileError(f"{path} is a MATLAB file of version 7.3: expected save(..., '-v7')") from None
    return {name: value for name, value in arrays.items() if not name.startswith("__")}


def netcdf_arrays(path: Path) -> Any:
    """Return the dataset of a netCDF file, including saved runs."""
    import xarray

    with (
        _readable(path, "netCDF-4", "expected q over (time, agent, axis)"),
        xarray.open_dataset(path, engine="h5netcdf", decode_times=False) as dataset,
    ):
        return dataset.load()


def dataset_arrays(dataset: Any, where: str) -> dict[str, Any]:
    """Return the arrays of an xarray.Dataset, with axes identified by dimension names as in `movement`.

    Positions are over time, space and individual(s), and keypoint(s) of each; of several keypoints one must be chosen.
    """
    keys = next((name for name in ("keypoints", "keypoint") if name in dataset.sizes), None)
    if keys is not None and "position" in dataset:
        names = [str(x) for x in dataset[keys].values]
        if len(names) > 1:
            raise ArgumentError(
                f"{where} has {len(names)} {keys} of each individual, {', '.join(names[:4])}: expected one; give "
                f"ds.sel({keys}={names[0]!r}), or ds.mean({keys!r}), the mean of all"
            )
        dataset = dataset.isel({keys: 0})
    if "space" in dataset.coords and {*dataset["space"].values.tolist()} <= {*"xyz"}:
        dataset = dataset.sortby("space")
    arrays: dict[str, Any] = {}
    for name in (*dataset.coords, *dataset.data_vars):
        array = dataset[name]
        order = [AXES.get(str(dim).lower(), -1) for dim in array.dims]
        known_axes = [str(dim) for dim in array.dims if str(dim).lower() in AXES]
        if str(name).lower() in (*_NAMES["q"], *_NAMES["p"], *_NAMES["u"]) and -1 in order and known_axes:
            raise ArgumentError(
                f"{where}: {name} is over {', '.join(map(str, array.dims))}: expected time, agent and space (Cartesian "
                "coordinates) alone; ds.rename(...) names a dimension, ds.sel(...) takes a part"
            )
        if -1 not in order and 0 in order and array.ndim in (2, 3):
            x = turned(np.asarray(array), order, str(name), where)
            arrays[str(name)] = x[..., 0] if 2 not in order and coordinate(*words_of(name)) is not None else x
        elif array.dtype.kind in "fiu" and not {"space"} & {*array.dims}:
            arrays[str(name)] = np.asarray(array)
    if "space" not in dataset.sizes:
        return arrays
    parts = {name: x for name, x in arrays.items() if name in ("time", "position", "velocity", "acceleration")}
    fps = dataset.attrs.get("fps")
    if dataset.attrs.get("time_unit") == "frames":
        parts.pop("time", None)
    if "time" not in parts and fps is not None:
        parts["fps"] = np.asarray(fps)
    people = next((name for name in ("individuals", "individual") if name in dataset.coords), None)
    ids = None if people is None else tuple(str(x) for x in np.atleast_1d(dataset[people].values))
    return parts | ({} if ids is None else {"ids": ids})
