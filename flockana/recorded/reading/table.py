"""Long and wide tables as arrays: times, positions, velocities, names of agents."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from flockana.base.checks import FloatArray, ensure_positive
from flockana.base.errors import ArgumentError, FileError
from flockana.recorded.reading.names import Columns, Layout, given_layout, layout_of
from flockana.recorded.reading.text import numbers, row_name

_SPARSE = 20  # positions for each row of a table, beyond which agents were sampled at different times


def table_arrays(frame: Any, columns: Columns, dt: float | None, clock: float | None) -> dict[str, Any]:
    """Return t, q, p, u and ids of a table, as `Recording` takes them."""
    where = str(frame.attrs.get("where", "the frame"))
    if not len(frame):
        raise ArgumentError(f"{where} has no rows: expected one for each sample of an agent")
    if not frame.columns.is_unique:
        twice = frame.columns[frame.columns.duplicated()][0]
        raise ArgumentError(f"{where}: the column {twice!r} is given twice; expected each once")
    names = list(frame)
    layout = given_layout(columns, names, where) if isinstance(columns, Mapping) else layout_of(names, where)
    if layout.wide:
        return _wide(frame, layout.wide, _times(frame, layout, dt, clock, where))
    if layout.time is None and layout.frame is None:
        return _one_instant(frame, layout, where)
    t = _times(frame, layout, dt, clock, where)
    if layout.agent is not None:
        return _long(frame, layout, t, where)
    if len(np.unique(t)) < len(t):
        raise ArgumentError(f"{where} has several rows at one time and no column id: expected the agent of each row")
    return _wide(frame, {"0": layout.long}, t)


def _times(frame: Any, layout: Layout, dt: float | None, clock: float | None, where: str) -> FloatArray:
    """Time of each row."""
    if layout.time is not None:
        series = frame[layout.time]
        if series.dtype.kind == "M" or (series.dtype.kind not in "fiu" and _is_date(series.iloc[0])):
            t = _read_dates(series, clock, where, layout.time)
        else:
            t = numbers(frame, layout.time)
        if np.isnan(t).any():
            k = int(np.argmax(np.isnan(t)))
            raise FileError(f"{row_name(frame, k)}, column {layout.time!r}: no time; expected one in every row")
        return t
    if layout.frame is None:
        raise ArgumentError(f'{where} has no times: expected a column time or frame; name it by columns={{"t": ...}}')
    if dt is None:
        raise ArgumentError(f"{where} counts by {layout.frame!r} and has no times: expected dt=, the time of a frame")
    steps = numbers(frame, layout.frame)
    if np.isnan(steps).any() or (steps != np.rint(steps)).any():
        k = int(np.argmax(~(steps == np.rint(steps))))
        raise FileError(f"{row_name(frame, k)}, column {layout.frame!r}: expected a whole number")
    return steps * dt


def _is_date(value: Any) -> bool:
    import pandas as pd

    if not isinstance(value, str) or not any(mark in value for mark in "-:/"):
        return False
    return not pd.isna(pd.to_datetime(value, errors="coerce"))


def _read_dates(series: Any, clock: float | None, where: str, name: str) -> FloatArray:
    import pandas as pd

    if clock is None:
        raise ArgumentError(
            f"{where}, column {name!r}: {series.iloc[0]} is a date: expected clock=, the seconds in one time unit of "
            "the law (1 for seconds); times then count from the first"
        )
    try:
        stamps = pd.to_datetime(series, format="ISO8601", utc=True)
    except (ValueError, TypeError) as error:
        raise FileError(f"{where}, column {name!r}: {error}; expected dates such as 2024-05-01T12:00:00") from None
    seconds: FloatArray = (stamps - stamps.min()).dt.total_seconds().to_numpy(dtype=np.float64)
    return seconds / ensure_positive("clock", clock)


def _values(frame: Any, names: Sequence[str]) -> FloatArray:
    return np.stack([numbers(frame, name) for name in names], axis=1)


def _long(frame: Any, layout: Layout, t: FloatArray, where: str) -> dict[str, Any]:
    """A row for each agent at each time."""
    import pandas as pd

    column = frame[layout.agent]
    if column.isna().any():
        k = int(np.argmax(column.isna().to_numpy()))
        raise FileError(f"{row_name(frame, k)}, column {layout.agent!r}: no name; expected the agent of every row")
    agent, ids = pd.factorize(column, sort=True)
    sample, instants = pd.factorize(t, sort=True)
    if len(ids) * len(instants) > _SPARSE * len(frame):
        raise FileError(
            f"{where}: {len(frame)} rows of {len(ids)} agents at {len(instants)} times; expected agents that are "
            "sampled at common times; resample or round them"
        )
    place = sample.astype(np.int64) * len(ids) + agent
    if np.bincount(place).max() > 1:
        order = np.argsort(place, kind="stable")
        k = int(order[1:][np.diff(place[order]) == 0].min())
        raise FileError(
            f"{row_name(frame, k)}: agent {column.iloc[k]} at t = {t[k]:g} a second time; expected it once; were two "
            "agents given one name?"
        )
    found: dict[str, Any] = {"t": np.asarray(instants, dtype=np.float64), "ids": [str(i) for i in ids]}
    for kind, names in layout.long.items():
        array = np.full((len(instants) * len(ids), len(names)), np.nan)
        array[place] = _values(frame, names)
        found[kind] = array.reshape(len(instants), len(ids), len(names))
    return found


def _wide(frame: Any, columns: Mapping[str, Mapping[str, Sequence[str]]], t: FloatArray) -> dict[str, Any]:
    """A row for each time, with columns for each agent."""
    order = np.argsort(t, kind="stable")
    if (np.diff(t[order]) == 0.0).any():
        k = int(order[1:][np.diff(t[order]) == 0.0].min())
        raise FileError(f"{row_name(frame, k)}: t = {t[k]:g} a second time; expected rising times, a row for each")
    arrays = {
        kind: np.stack([_values(frame, names[kind])[order] for names in columns.values()], axis=1)
        for kind in next(iter(columns.values()))
    }
    return {"t": t[order], "ids": list(columns)} | arrays


def _one_instant(frame: Any, layout: Layout, where: str) -> dict[str, Any]:
    """Agents without times: a flock at one instant."""
    found: dict[str, Any] = {"t": [0.0]} | {kind: _values(frame, names)[None] for kind, names in layout.long.items()}
    if layout.agent is not None:
        found["ids"] = ids = [str(i) for i in frame[layout.agent]]
        if len(set(ids)) < len(ids):
            raise ArgumentError(f"{where} has agents several times and no times: expected a column time")
    return found
