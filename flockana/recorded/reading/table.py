"""Conversion of long and wide tables to arrays: times, positions, velocities, names of agents, notes."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from flockana.base.errors import ArgumentError, FileError
from flockana.base.value_checks import FloatArray, ensure_nonnegative, ensure_positive
from flockana.recorded.reading.column_names import MEANINGS, Columns, Layout, layout_of
from flockana.recorded.reading.column_words import AXES, Unit
from flockana.recorded.reading.text_tables import numbers, row_name

AGENTS = "agents from "  # begins what is said of a column of agents
_LARGEST = 2e8  # numbers that a recording holds at most, gaps among them
_ROUNDINGS = 16.0  # of the largest stamp, by which stamps of one instant may differ
_EPOCHS = ((1e17, 1e-9, "nanoseconds"), (1e14, 1e-6, "microseconds"), (1e11, 1e-3, "milliseconds"))  # since 1970


def table_arrays(
    frame: Any,
    columns: Columns,
    dt: float | None,
    clock: float | None,
    m: int | None = None,
    jitter: float | None = None,
) -> dict[str, Any]:
    """Return t, q, p, u, agents' ids and notes on how a table was read, in the form of `Recording`."""
    where = str(frame.attrs.get("where", "the frame"))
    if not len(frame):
        raise ArgumentError(f"{where} has no rows: expected one for each sample of an agent")
    if not frame.columns.is_unique:
        repeated_name = frame.columns[frame.columns.duplicated()][0]
        raise ArgumentError(f"{where}: the column {repeated_name!r} is given twice; expected each once")
    layout = layout_of(list(frame), where, columns if isinstance(columns, Mapping) else None)
    if layout.time is not None and dt is not None:
        raise ArgumentError(
            f"{where} has times in {layout.time!r} and dt = {dt:g} is given: expected one; leave dt= out, or count "
            f'by frames with columns={{"frame": {layout.frame or "..."!r}}}'
        )
    layout = _of_dimension(layout, m, where)
    t, remark = _times(frame, layout, dt, clock, where)
    layout = _with_agents(frame, layout, t, where)
    factors, texts = _factors(layout, where)
    notes = [*remark, *frame.attrs.get("notes", ()), *texts]
    if t is not None:
        owners = np.zeros(len(t)) if layout.agent is None else frame[layout.agent].factorize()[0]
        order = np.argsort(owners, kind="stable")
        falls = int(((np.diff(t[order]) < 0.0) & (np.diff(owners[order]) == 0)).sum())
        notes += [f"rows are sorted by time, which falls {falls} times"] if falls else []
    if layout.wide:
        arrays = _wide(frame, layout.wide, _counted(frame, t, dt, layout, where))
    elif layout.agent is not None and t is not None:
        t, shift = _instants(t, jitter)
        notes += [shift] if shift else []
        arrays = _long(frame, layout, t, where)
    elif layout.agent is not None:
        arrays = _one_instant(frame, layout)
    else:
        if t is None and not (isinstance(columns, Mapping) and "q" in columns):
            _ensure_one_agent(frame, layout, where)
        t = _counted(frame, t, dt, layout, where)
        if len(np.unique(t)) < len(t):
            columns_text = ", ".join(repr(str(x)) for x in frame.columns if x not in (layout.time, layout.frame))
            raise ArgumentError(
                f"{where} has several rows at one time and no column id: expected the agent of each row; name it by "
                f'columns={{"id": ...}}, one of {columns_text}'
            )
        arrays = _wide(frame, {"0": layout.long}, t)
    for kind, factor in factors.items():
        arrays[kind] = arrays[kind] * factor
    return arrays | {"read_as": (*_described(layout, dt), *notes, *layout.notes, *_flat_axis(arrays))}


def _ensure_one_agent(frame: Any, layout: Layout, where: str) -> None:
    """Raise if a column that is not read may name the agents of rows without times."""
    read = {x for names in layout.long.values() for x in names}
    for name in (x for x in frame.columns if x not in read and frame[x].dtype.kind not in "fbc"):
        if 1 < frame[name].nunique() <= len(frame) // 2:
            column_text = f'columns={{"id": {name!r}}}, or columns={{"q": {list(layout.long["q"])}}}'
            raise ArgumentError(
                f"{where} has no times, and {name!r} repeats: it may name the agent of each row, or all rows are of "
                f"one agent: expected {column_text}, which decides"
            )


def _counted(frame: Any, t: FloatArray | None, dt: float | None, layout: Layout, where: str) -> FloatArray:
    """Return the time of each row: the given times, or dt times the row number."""
    if t is not None:
        return t
    if dt is None:
        rest = (
            "a row for each instant" if layout.wide else "rows that are samples of one agent, or agents at one instant"
        )
        raise ArgumentError(
            f"{where} has no times, and {rest}: expected dt=, the time from row to row, a column time, columns="
            '{"t": ...}, or, of one instant, a column id'
        )
    return dt * np.arange(len(frame), dtype=np.float64)


def _of_dimension(layout: Layout, m: int | None, where: str) -> Layout:
    """Return the layout of table columns restricted to the first m coordinate axes."""
    kinds = layout.long or next(iter(layout.wide.values()))
    if m is None or m == len(kinds["q"]):
        return layout
    if m not in range(1, len(kinds["q"]) + 1):
        raise ArgumentError(f"m = {m!r}: expected 1 to {len(kinds['q'])}, of which {where} has positions")

    def cut(kinds: Mapping[str, Sequence[str]]) -> dict[str, Sequence[str]]:
        return {kind: columns[:m] for kind, columns in kinds.items()}

    left = ", ".join(repr(str(x)) for item in (layout.long, *layout.wide.values()) for x in item.get("q", ())[m:])
    notes = (*layout.notes, f"not read, as m = {m}: {left}")
    return replace(
        layout, notes=notes, long=cut(layout.long), wide={name: cut(kinds) for name, kinds in layout.wide.items()}
    )


def _described(layout: Layout, dt: float | None) -> list[str]:
    """Return notes on the meaning and unit assigned to each table column."""

    def named(columns: Sequence[str]) -> str:
        unit = (layout.units or {}).get(columns[0])
        return ", ".join(repr(str(x)) for x in columns) + (f" in {unit.text}" if unit else "")

    texts = []
    if layout.time is not None:
        texts.append(f"t from {named(layout.time if isinstance(layout.time, tuple) else [layout.time])}")
    elif layout.frame is not None:
        texts.append(f"t from {layout.frame!r} times dt")
    else:
        texts.append("t from the rows times dt" if dt is not None else "one instant")
    if layout.agent is not None:
        texts.append(f"{AGENTS}{layout.agent!r}")
    elif not layout.wide:
        texts.append("one agent")
    if layout.wide:
        first_agent, kinds = next(iter(layout.wide.items()))
        description = " and ".join(f"{kind} from {named(columns)}" for kind, columns in kinds.items())
        texts.append(f"{len(layout.wide)} agents, each with columns: {description} of agent {first_agent}")
    return texts + [f"{kind} from {named(columns)}" for kind, columns in layout.long.items()]


def _factors(layout: Layout, where: str) -> tuple[dict[str, float], list[str]]:
    """Return conversion factors of velocities and accelerations to the units of positions and times, and a note."""
    units, kinds = layout.units or {}, [layout.long] if layout.long else [*layout.wide.values()]
    by_name: dict[str, Unit] = {}
    for kind in MEANINGS:
        columns = [x for item in kinds for x in item.get(kind, ())]
        spelt = {(units[x].length, units[x].factor, units[x].power): units[x] for x in columns if x in units}
        if len(spelt) > 1 or (spelt and any(x not in units for x in columns)):
            raise ArgumentError(
                f"{where}: {MEANINGS[kind]}s are in {', '.join(x.text for x in spelt.values())}, or others: expected "
                "one unit; convert them, or drop the units from the header"
            )
        if spelt:
            by_name[kind] = next(iter(spelt.values()))
    time = units.get(layout.time) if isinstance(layout.time, str) else None
    factors, texts = {}, []
    for kind, power in (("p", 1), ("u", 2)):
        if kind in by_name and "q" in by_name and by_name[kind].power == power:
            text = by_name[kind].text
            if (by_name[kind].length == "px") != (by_name["q"].length == "px"):
                raise ArgumentError(
                    f"{where}: positions are in {by_name['q'].text}, and {kind} in {text}: expected one "
                    f'unit of length; convert them, or read positions alone by columns={{"q": {[*kinds[0]["q"]]}}}'
                )
            clock = Unit(f"the time of {text}", "", by_name[kind].second, 0) if time is None else time
            factor = by_name[kind].factor / by_name["q"].factor * clock.factor**power
            if abs(factor - 1.0) > 1e-9:
                factors[kind] = factor
                texts.append(f"{kind} times {factor:.4g}, from {text} to {by_name['q'].text} and {clock.text}")
    return factors, texts


def _flat_axis(arrays: Mapping[str, Any]) -> list[str]:
    """Return a note if the last coordinate of all positions is constant, else an empty list."""
    q = np.asarray(arrays["q"])
    last_axis = q[..., -1]
    if q.shape[-1] < 2 or q.shape[0] < 2 or np.nanmax(last_axis) != np.nanmin(last_axis):
        return []
    axis = AXES[q.shape[-1] - 1]
    return [f"{axis} is {np.nanmin(last_axis):g} throughout, and kept: m={q.shape[-1] - 1} leaves it out"]


def _with_agents(frame: Any, layout: Layout, t: FloatArray | None, where: str) -> Layout:
    """Return the layout with the agent column chosen among several candidates: agent names recur over time."""
    import pandas as pd

    if not layout.rivals or layout.agent is None or t is None:
        return layout
    every, fit = [layout.agent, *layout.rivals], list[str]()
    for name in every:
        pairs = pd.DataFrame({"t": t, "id": frame[name].to_numpy()})
        if not pairs.duplicated().any() and frame[name].nunique() < len(frame) and not frame[name].isna().any():
            fit.append(name)
    codes = {tuple(pd.factorize(frame[name])[0]) for name in fit}
    if len(codes) != 1:
        got = ", ".join(repr(str(x)) for x in (fit or every))
        raise ArgumentError(
            f"{where}: {got} may each be the agent of a row, or a count: expected the one whose values come once at a "
            f'time, and return; columns={{"id": {fit[0] if fit else every[0]!r}}} decides'
        )
    idle = ", ".join(repr(str(x)) for x in every if x != fit[0])
    return replace(layout, agent=fit[0], notes=(*layout.notes, f"not read: {idle}, whose values do not name an agent"))


def _times(
    frame: Any, layout: Layout, dt: float | None, clock: float | None, where: str
) -> tuple[FloatArray | None, list[str]]:
    """Return the time of each row (None if only rows count), and a note on the conversion."""
    if isinstance(layout.time, tuple):
        whole, parts = (numbers(frame, name) for name in layout.time)
        return (whole - whole[0]) + 1e-9 * parts, ["seconds and nanoseconds are added, from the first second on"]
    if layout.time is not None:
        series = frame[layout.time]
        if series.dtype.kind in "mM" or (series.dtype.kind not in "fiu" and _is_date(series.iloc[0])):
            t = _read_dates(series, clock, where, layout.time)
            notes = [f"dates count from the first, in units of {clock} s"]
        else:
            t, notes = numbers(frame, layout.time), []
        if np.isnan(t).any():
            k = int(np.argmax(np.isnan(t)))
            raise FileError(f"{row_name(frame, k)}, column {layout.time!r}: no time; expected one in every row")
        unit = (layout.units or {}).get(layout.time)
        for smallest, factor, text in _EPOCHS if unit is None else ():
            if smallest <= t.min() <= t.max() < 1e3 * smallest and series.dtype.kind in "iuf":
                exact = series.to_numpy()
                return (exact - exact.min()) * factor, [f"t counts {text} since 1970: in seconds from the first"]
        return t, notes
    if layout.frame is None:
        return None, []
    if dt is None:
        raise ArgumentError(f"{where} counts by {layout.frame!r} and has no times: expected dt=, the time of a frame")
    steps = numbers(frame, layout.frame)
    if np.isnan(steps).any() or (steps != np.rint(steps)).any():
        k = int(np.argmax(~(steps == np.rint(steps))))
        raise FileError(f"{row_name(frame, k)}, column {layout.frame!r}: expected a whole number")
    return steps * dt, []


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
        stamps = series if series.dtype.kind == "m" else pd.to_datetime(series, format="ISO8601", utc=True)
    except (ValueError, TypeError) as error:
        raise FileError(f"{where}, column {name!r}: {error}; expected dates such as 2024-05-01T12:00:00") from None
    seconds: FloatArray = (stamps - stamps.min()).dt.total_seconds().to_numpy(dtype=np.float64)
    return seconds / ensure_positive("clock", clock)


def _instants(t: FloatArray, jitter: float | None) -> tuple[FloatArray, str]:
    """Return the times with nearly equal stamps made equal, and a note; by default within rounding."""
    stamps = np.unique(t)
    rounding = _ROUNDINGS * np.finfo(float).eps * float(np.abs(stamps).max())
    reach = rounding if jitter is None else ensure_nonnegative("jitter", jitter)
    group = np.cumsum(np.diff(stamps, prepend=stamps[0]) > reach)
    if group[-1] == len(stamps) - 1:
        return t, ""
    start = np.searchsorted(group, np.arange(group[-1] + 1))
    end = np.append(start[1:], len(stamps)) - 1
    if jitter is not None and (is_too_long := stamps[end] - stamps[start] > reach).any():
        k = int(np.argmax(is_too_long))
        raise ArgumentError(
            f"jitter = {reach:g}: stamps from {stamps[start[k]]:g} to {stamps[end[k]]:g} follow each other within it, "
            "so nothing says which of them are one instant; expected as much as stamps of one instant spread, and "
            "less than the breaks between instants; or interpolate="
        )
    mean_stamps = np.where(start == end, stamps[start], 0.5 * (stamps[start] + stamps[end]))
    widest = float((stamps[end] - stamps[start]).max())
    text = f"stamps up to {widest:.3g} apart are one instant: {len(stamps)} are {len(mean_stamps)}"
    return mean_stamps[group[np.searchsorted(stamps, t)]], text


def _name(agent: Any) -> str:
    return f"{agent:.0f}" if isinstance(agent, float) and agent.is_integer() else str(agent)


def _values(frame: Any, names: Sequence[str]) -> FloatArray:
    return np.stack([numbers(frame, name) for name in names], axis=1)


def _long(frame: Any, layout: Layout, t: FloatArray, where: str) -> dict[str, Any]:
    """Return arrays from a table with a row for each agent at each time."""
    import pandas as pd

    column = frame[layout.agent]
    if column.isna().any():
        k = int(np.argmax(column.isna().to_numpy()))
        raise FileError(f"{row_name(frame, k)}, column {layout.agent!r}: no name; expected the agent of every row")
    agent, ids = pd.factorize(column, sort=True)
    sample, instants = pd.factorize(t, sort=True)
    if len(ids) * len(instants) * len(layout.long["q"]) > _LARGEST:
        raise FileError(
            f"{where}: {len(frame)} rows of {len(ids)} agents at {len(instants)} times; expected agents that "
            "share their times; give jitter=, within which stamps are one instant"
        )
    row_index = sample.astype(np.int64) * len(ids) + agent
    if np.bincount(row_index).max() > 1:
        order = np.argsort(row_index, kind="stable")
        k = int(order[1:][np.diff(row_index[order]) == 0].min())
        raise FileError(
            f"{row_name(frame, k)}: agent {column.iloc[k]} at t = {t[k]:g} a second time; expected it once; were two "
            "agents given one name?"
        )
    arrays: dict[str, Any] = {"t": np.asarray(instants, dtype=np.float64), "ids": [_name(i) for i in ids]}
    for kind, names in layout.long.items():
        array = np.full((len(instants) * len(ids), len(names)), np.nan)
        array[row_index] = _values(frame, names)
        arrays[kind] = array.reshape(len(instants), len(ids), len(names))
    return arrays


def _wide(frame: Any, columns: Mapping[str, Mapping[str, Sequence[str]]], t: FloatArray) -> dict[str, Any]:
    """Return arrays from a table with a row for each time and columns for each agent."""
    order = np.argsort(t, kind="stable")
    if (np.diff(t[order]) == 0.0).any():
        k = int(order[1:][np.diff(t[order]) == 0.0].min())
        raise FileError(f"{row_name(frame, k)}: t = {t[k]:g} a second time; expected rising times, a row for each")
    arrays = {
        kind: np.stack([_values(frame, names[kind])[order] for names in columns.values()], axis=1)
        for kind in next(iter(columns.values()))
    }
    return {"t": t[order], "ids": list(columns)} | arrays


def _one_instant(frame: Any, layout: Layout) -> dict[str, Any]:
    """Return arrays from a table without times: a flock at one instant."""
    place_text = str(frame.attrs.get("where", "the frame"))
    arrays: dict[str, Any] = {"t": [0.0]} | {kind: _values(frame, names)[None] for kind, names in layout.long.items()}
    if layout.agent is not None:
        arrays["ids"] = ids = [_name(i) for i in frame[layout.agent]]
        if len(set(ids)) < len(ids):
            raise ArgumentError(
                f'{place_text} has agents several times and no times: expected a column time, or columns={{"t": ...}}'
            )
    return arrays
