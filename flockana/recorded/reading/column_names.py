"""Meaning of table columns by their names; ambiguous names are rejected."""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

from flockana.base.errors import ArgumentError, format_value
from flockana.recorded.reading.column_words import (
    AXES,
    Unit,
    Word,
    coordinate,
    is_agent,
    is_agents_word,
    is_frame,
    is_time,
    words_of,
)

Columns = Mapping[str, Any] | Sequence[str] | None  # names that a user gives

MEANINGS = {"q": "position", "p": "velocity", "u": "acceleration"}
_KNOWN = ("t", "frame", "id", "agents", "q", "p", "u")
_WHOLE = ("sec", "secs", "seconds")  # beside a column of nanoseconds
_NANO = ("nsec", "nsecs", "nanosec", "nanosecs", "nanoseconds")
_EITHER = 'columns={"q": [...]} or columns={"agents": [...]}'
_NAMED = 'name them by columns={"t": ..., "id": ..., "q": [...], "p": [...]}'

Kinds = dict[str, dict[str, str]]  # column by kind and axis


@dataclass(frozen=True)
class Layout:
    """Meaning of columns: time or frame, agent, and coordinates by kind ("q", "p", "u").

    In a wide table the coordinates are those of each agent, by its name. `rivals` may be the agent's column too: their
    numbers decide.
    """

    time: Any  # a column, or those of seconds and nanoseconds
    frame: str | None
    agent: str | None
    long: Mapping[str, Sequence[str]]
    wide: Mapping[str, Mapping[str, Sequence[str]]]
    rivals: tuple[str, ...] = ()
    units: Mapping[str, Unit] | None = None
    notes: tuple[str, ...] = ()


def is_header(name: Any) -> bool:
    """Return whether a name is that of a coordinate, an agent or a time."""
    words, unit = words_of(name)
    return is_time(words) or is_agent(words) or coordinate(words, unit) is not None


def renaming_note(header: Sequence[Any], names: Sequence[str], where: str) -> str:
    """Return a note on names that replace a table's header; raise on a wrong count or a contradiction."""
    if len(names) != len(header):
        text = f"{len(header)} columns, {', '.join(map(repr, header[:12]))}, and columns= has {len(names)} names"
        raise ArgumentError(f"{where} has {text}: expected one for each; or {_NAMED}")
    for old, new in zip(header, names, strict=True):
        if None not in (meanings := [_meaning(x) for x in (old, new)]) and meanings[0] != meanings[1]:
            raise ArgumentError(
                f"{where}: the header says {old!r} where columns= says {new!r}: expected names in the order of the "
                f"header; to choose among its columns, {_NAMED}; to replace it, drop its line"
            )
    pairs = [f"{old!r} is {new!r}" for old, new in zip(header, names, strict=True) if str(old) != str(new)]
    return f"columns= replaces the header: {', '.join(pairs)}" if pairs else ""


def _meaning(name: Any) -> tuple[str, ...] | None:
    words, unit = words_of(name)
    word = coordinate(words, unit)
    if is_time(words) or is_frame(words) or is_agent(words):
        return ("id",) if is_agent(words) else ("t",)
    return None if word is None or "?" in word.kind else (word.kind, word.axis)


def layout_of(names: Sequence[Any], where: str, columns: Mapping[str, Any] | None = None) -> Layout:
    """Return the layout of a table from its header and the user's names.

    Raises
    ------
    ArgumentError
        If a column is not there, or what is not stated may be read in two ways; the message has both.
    """
    stated = _ensure_given(columns or {}, names, where)
    taken_columns = {x for k, v in stated.items() if k != "agents" for x in (v if isinstance(v, list | tuple) else [v])}
    texts = [name for name in names if name not in taken_columns]
    described = {name: words_of(name) for name in texts}
    time, passed = _time_of(texts, described, where) if not {"t", "frame"} & stated.keys() else (stated.get("t"), [])
    frame = stated.get(
        "frame", next((x for x in texts if is_frame(described[x][0])), None) if "t" not in stated else None
    )
    spent = {*passed, *(time if isinstance(time, tuple) else [time]), frame}
    agents = [stated["id"]] if "id" in stated else [x for x in texts if x not in spent and is_agent(described[x][0])]
    words = {x: word for x in texts if x not in spent and x not in agents and (word := coordinate(*described[x]))}
    units = {x: unit for x in names if (unit := words_of(x)[1]) is not None}
    listing = ", ".join(map(str, list(names)[:12])) + (", ..." if len(names) > 12 else "")
    groups = by_owner(words, where)
    if "q" in stated:
        layout = Layout(time, frame, None, _stated(stated), {})
    else:
        layout = _arranged(groups, stated.get("agents"), agents, texts, where, listing)
        layout = replace(layout, long={**layout.long, **{k: v for k, v in _stated(stated).items() if layout.long}})
    first = None if layout.wide or not agents else agents[0]
    columns_read = {*_flat(layout), *spent, *agents}
    idle = [f"{x!r}" for x in names if x not in columns_read]
    notes = layout.notes + ((f"not read: {', '.join(idle[:12])}{', ...' if len(idle) > 12 else ''}",) if idle else ())
    notes += (f"not read: {', '.join(repr(x) for x in passed)}, the time of receipt",) if passed else ()
    twist = next((x for x in names if x in columns_read and "twist" in words_of(x)[0]), None)
    if twist is not None and any(word.kind == "orientation" for word in words.values()):
        notes += (f"{twist!r} is taken along the axes of positions; where it is along a robot's own, name q alone",)
    return replace(
        layout, time=time, frame=frame, agent=first, rivals=tuple(agents[1:]) if first else (), units=units, notes=notes
    )


def _flat(layout: Layout) -> set[str]:
    return {x for kinds in (layout.long, *layout.wide.values()) for columns in kinds.values() for x in columns}


def _stated(given: Mapping[str, Any]) -> dict[str, list[str]]:
    kinds = {k: given[k] for k in "qpu" if k in given}
    return {k: list(x) if isinstance(x, list | tuple) else [x] for k, x in kinds.items()}


def _ensure_given(columns: Mapping[str, Any], names: Sequence[Any], where: str) -> Mapping[str, Any]:
    """Return the user's column names; raise on a name that is no column."""
    if unknown := set(columns) - {*_KNOWN}:
        raise ArgumentError(f"columns has {format_value(sorted(unknown))}: expected {', '.join(_KNOWN)}")
    kinds = _stated(columns)
    requests = [*(columns[k] for k in ("t", "frame", "id") if k in columns), *(x for v in kinds.values() for x in v)]
    missing_names = [x for x in requests if x not in list(names)]
    if missing_names:
        raise ArgumentError(f"{where} has no column {missing_names[0]!r}: expected one of {', '.join(map(str, names))}")
    if "q" in kinds and (any(len(v) != len(kinds["q"]) for v in kinds.values()) or not 1 <= len(kinds["q"]) <= 3):
        value_text = format_value(dict(columns))
        raise ArgumentError(f"columns = {value_text}: expected 1 to 3 columns for q, and as many for p and u")
    return columns


def _two_readings(where: str, names: Sequence[Any], one: str, other: str, remedy: str) -> ArgumentError:
    listing = ", ".join(repr(x) for x in list(names)[:6])
    return ArgumentError(f"{where}: {listing} may be {one}, or {other}: expected {remedy}, which decides")


def _time_of(names: Sequence[str], described: Mapping[str, Any], where: str) -> tuple[Any, list[str]]:
    """Return the time column, or columns of seconds and nanoseconds, and ignored receipt times."""
    last_words = {name: re.sub(r"[^a-z]", " ", str(name).lower()).split()[-1:] for name in names}
    nanosecond_names = [name for name in names if last_words[name] and last_words[name][0] in _NANO]
    whole_names = [name for name in names if last_words[name] and last_words[name][0] in _WHOLE]
    if len(nanosecond_names) == len(whole_names) == 1:
        return (whole_names[0], nanosecond_names[0]), []
    times = [x for x in names if is_time(described[x][0])]
    received = [x for x in times if str(x).startswith(("%", "__")) or "rosbag" in str(x).lower()]
    if received and len(received) < len(times):
        times = [x for x in times if x not in received]
    else:
        received = []
    if len(times) > 1:
        raise _two_readings(where, times, "the times", "one of them another clock", f'columns={{"t": {times[0]!r}}}')
    return (times[0] if times else None), received


def by_owner(known: Mapping[str, Word], where: str) -> dict[tuple[str, ...], Kinds]:
    """Return table columns by agent, kind and axis; orientations and other vectors have kinds of their own."""
    patterns: dict[tuple[str, ...], dict[str, str]] = {}
    for name, word in known.items():
        patterns.setdefault(word.pattern, {}).setdefault(word.axis, name)
    quaternions = {pattern for pattern, axes in patterns.items() if {*axes} >= {*"xyzw"}}
    has_other_positions = any(word.kind == "q" and word.pattern not in quaternions for word in known.values())
    groups: dict[tuple[str, ...], Kinds] = {}
    for name, word in known.items():
        kind = word.kind
        if word.pattern in quaternions:
            if kind == "q" and not has_other_positions and word.pattern in ((), ("",)):
                remedy = f'columns={{"q": [{", ".join(repr(patterns[word.pattern][x]) for x in AXES)}]}}'
                first_wording, second_wording = "positions and a weight", "a quaternion without positions"
                raise _two_readings(where, [*patterns[word.pattern].values()], first_wording, second_wording, remedy)
            kind = "orientation"
        if word.axis == "w":
            continue
        group = groups.setdefault(word.owner, {})
        if (rival_column := group.get(kind, {}).get(word.axis)) is not None and kind in MEANINGS:
            raise _rivals(where, rival_column, name, kind, word.axis)
        group.setdefault(kind, {})[word.axis] = name
    for kinds in groups.values():
        _settle(kinds, where)
    return groups


def _rivals(where: str, one: str, other: str, kind: str, axis: str) -> ArgumentError:
    return ArgumentError(
        f"{where}: {one!r} and {other!r} may both be the {MEANINGS[kind]} along {axis}: expected columns={{"
        f'"{kind}": [{one!r}, ...]}}, which decides'
    )


def _settle(kinds: Kinds, where: str) -> None:
    """Resolve columns px and qx: positions if there are no others; else px is a velocity, qx rejected."""
    for letter in "pq":
        columns = kinds.pop(letter + "?", None)
        if columns is None:
            continue
        axis, name = next(iter(columns.items()))
        if "q" not in kinds:
            kinds["q"] = columns
        elif letter == "q" or "p" in kinds:
            raise _rivals(where, kinds["q"].get(axis, name), name, "q", axis)
        else:
            kinds["p"] = columns


def _arranged(
    groups: dict[tuple[str, ...], Kinds],
    stated: Any,
    agents: Sequence[str],
    names: Sequence[Any],
    where: str,
    shown: str,
) -> Layout:
    """Return the layout of table columns: long (one vector per row) or wide (one vector for each agent)."""
    placed = {owner: kinds for owner, kinds in groups.items() if "q" in kinds}
    if stated is not None:
        wanted_words = {str(name): tuple(words_of(name)[0]) for name in stated}
        missing_names = [name for name, owner in wanted_words.items() if owner not in placed]
        if missing_names:
            raise ArgumentError(f"{where}: no positions of {missing_names[0]!r} are among the columns {shown}")
        return Layout(
            None, None, None, {}, _alike({name: placed[owner] for name, owner in wanted_words.items()}, where, shown)
        )
    if not placed:
        raise _no_positions(names, groups, where, shown)
    numbered_owners = [owner for owner in placed if owner and all(word.isdigit() for word in owner)]
    x_columns = [kinds["q"]["x"] for kinds in placed.values() if "x" in kinds["q"]] or names
    if () in placed:
        if numbered_owners:
            raise _two_readings(where, x_columns, "one agent", "several", _EITHER)
        return Layout(None, None, None, ordered_axes(placed[()], where, shown), {})
    if len(placed) == 1 and (agents or not numbered_owners):
        owner, kinds = next(iter(placed.items()))
        note = f"all are of {' '.join(owner)!r}, one agent" if not agents else f"all are of {' '.join(owner)!r}"
        return Layout(None, None, None, ordered_axes({**groups.get((), {}), **kinds}, where, shown), {}, notes=(note,))
    if agents:
        remedy = 'columns={"q": [...]} of the one that is meant, or columns={"agents": [...]}'
        raise _two_readings(where, x_columns, f"vectors of the agent of {agents[0]!r}", "agents of their own", remedy)
    if ownerless_kinds := {*groups.get((), {})} & {*MEANINGS}:
        raise _two_readings(where, names, f"of agents and a common {MEANINGS[min(ownerless_kinds)]}", "of one", _EITHER)
    if not _are_agents(list(placed)):
        owners = [_joined(owner) for owner in placed]
        remedy = f'columns={{"agents": {owners}}} or columns={{"q": [...]}}'
        raise _two_readings(where, x_columns, "agents", "vectors of one agent, such as a goal", remedy)
    if _are_pairs(placed):
        remedy = f'columns={{"agents": {["_".join(owner) for owner in placed]}}}, or names such as x1, y1'
        raise _two_readings(where, x_columns, "agents on a line", "axes of agents, both by number", remedy)
    return Layout(None, None, None, {}, _alike({_joined(x): kinds for x, kinds in placed.items()}, where, shown))


def _joined(owner: Sequence[str]) -> str:
    return "".join(owner) if all(word.isdigit() for word in owner[1:]) else "_".join(owner)


def _are_agents(owners: list[tuple[str, ...]]) -> bool:
    """Return whether names look like agents: differing only in a number or letter, or led by an agent word."""
    stems = {tuple(word for word in owner if not word.isdigit() and len(word) > 1) for owner in owners}
    return len(stems) == 1 or all(is_agents_word(owner[0]) and len(owner) > 1 for owner in owners)


def _are_pairs(placed: Mapping[tuple[str, ...], Kinds]) -> bool:
    """Return whether names of agents on a line are all pairs of a first character and one of 2 or 3 digits."""
    names, last = {"".join(owner) for owner in placed}, {"".join(owner)[1:] for owner in placed}
    pairs = {name[:1] + digit for name in names for digit in last}
    on_a_line = all({*kinds["q"]} == {"x"} for kinds in placed.values())
    return (
        on_a_line and names == pairs and len(names) > len(last) and "".join(sorted(last)) in ("01", "12", "012", "123")
    )


def _alike(agents: Mapping[str, Kinds], where: str, shown: str) -> dict[str, dict[str, list[str]]]:
    """Return the columns of each agent in the order of axes; raise on differing columns."""
    agent_columns = {name: ordered_axes(kinds, where, shown) for name, kinds in agents.items()}
    counts = {name: {kind: len(columns) for kind, columns in kinds.items()} for name, kinds in agent_columns.items()}
    first_name = next(iter(counts))
    if (other_name := next((name for name in counts if counts[name] != counts[first_name]), None)) is not None:
        raise ArgumentError(f"{where} has other columns for agent {other_name} than for {first_name}: expected alike")
    return agent_columns


def _no_positions(names: Sequence[Any], groups: Mapping[Any, Kinds], where: str, shown: str) -> ArgumentError:
    """Return the error explaining that no column is a position."""
    listed = [x for x in names if (w := words_of(x)[0])[-1:] and w[-1].isdigit() and coordinate([*w[:-1], "x"], None)]
    if 1 < len(listed) <= 3:
        remedy = f'columns={{"q": {list(map(str, listed))}}}, or names such as x1, x2'
        return _two_readings(where, listed, "the axes of one agent", "agents on a line", remedy)
    if any({*kinds} & {"orientation", "other"} for kinds in groups.values()):
        return ArgumentError(
            f"{where} has the columns {shown}: expected positions x, y, z among them; an orientation or a goal "
            f"is none; {_NAMED}"
        )
    if groups:
        return ArgumentError(f"{where} has the columns {shown}: expected positions x, y, z among them; {_NAMED}")
    if any({"lat", "latitude"} & {*words_of(x)[0]} for x in names):
        return ArgumentError(
            f"{where} has the columns {shown}: latitudes and longitudes are angles: expected positions in a length; "
            "project them (pyproj), and give the frame"
        )
    return ArgumentError(
        f"{where} has the columns {shown}: expected time, id, x, y (long) or time, x1, y1, x2, y2 (wide); where "
        f"lines above a table describe it, pandas.read_csv(file, skiprows=..., header=[...]) makes a frame; {_NAMED}"
    )


def ordered_axes(kinds: Kinds, where: str, shown: str) -> dict[str, list[str]]:
    """Return the columns of each kind in the order of axes; raise on a missing axis."""
    size = 1 + max(AXES.index(axis) for axis in kinds["q"])
    for kind in (k for k in MEANINGS if k in kinds):
        axis_count = max(size, 1 + max(AXES.index(axis) for axis in kinds[kind]))
        letter = {"q": "", "p": "v", "u": "a"}[kind]
        if lacking := [letter + axis for axis in AXES[:axis_count] if axis not in kinds[kind]]:
            raise ArgumentError(f"{where} has the columns {shown}: expected {', '.join(lacking)} too, or fewer axes")
    return {kind: [kinds[kind][axis] for axis in AXES[:size]] for kind in MEANINGS if kind in kinds}
