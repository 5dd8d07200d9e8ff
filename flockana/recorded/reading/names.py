"""Names of columns and arrays in files of recordings, and what they mean."""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from flockana.base.errors import ArgumentError, format_value

Columns = Mapping[str, Any] | Sequence[str] | None  # names that a user gives

AXES = "xyz"
TIMES = ("t", "time", "times", "timestamp", "seconds", "tau")
FRAMES = ("frame", "frames", "step", "sample")
AGENTS = (
    *("id", "agent", "agent_id", "track", "track_id", "trackid"),
    *("particle", "robot", "bird", "fish", "name", "label"),
)
KINDS = {
    "q": ("{}", "q{}", "q_{}", "pos_{}", "position_{}"),
    "p": ("v{}", "p{}", "v_{}", "p_{}", "vel_{}"),
    "u": ("u{}", "a{}", "u_{}", "a_{}", "acc_{}"),
}
COORDINATES = {
    form.format(letter): (kind, axis)
    for kind, forms in KINDS.items()
    for axis, letter in enumerate(AXES)
    for form in forms
}
_UNIT = re.compile(r"\s*[\[(].*[\])]\s*$")  # x [m], t (s)
_NUMBERED = re.compile(r"^([a-z]+_?)[_ .-]?(\d+)$")  # x1, vx_2
_AGENT_FIRST = re.compile(r"^(.+?)[_ .-]([a-z]+)$")  # robot7_x


@dataclass(frozen=True)
class Layout:
    """Which columns hold what: time or frame, agent, and coordinates by kind ("q", "p", "u").

    In a wide table the coordinates are those of each agent, by its name.
    """

    time: str | None
    frame: str | None
    agent: str | None
    long: Mapping[str, Sequence[str]]
    wide: Mapping[str, Mapping[str, Sequence[str]]]


def plain(name: Any) -> str:
    """Return a column's name without unit, capitals, and blanks or # at its ends."""
    return _UNIT.sub("", str(name).lstrip("# ")).strip().lower()


def _agent_and_coordinate(name: str) -> tuple[str, str, int] | None:
    """Return agent, kind and axis that a plain name stands for; the agent is empty in a long table."""
    ways = [("", name)]
    if match := _NUMBERED.match(name):
        ways.append((match[2], match[1].rstrip("_")))
    if match := _AGENT_FIRST.match(name):
        ways.append((match[1], match[2]))
    return next(((agent, *COORDINATES[each]) for agent, each in ways if each in COORDINATES), None)


def layout_of(names: Sequence[Any], where: str) -> Layout:
    """Return the layout of a table by its header."""
    by_name = {plain(name): str(name) for name in names}
    time, frame, agent = (
        next((by_name[each] for each in known if each in by_name), None) for known in (TIMES, FRAMES, AGENTS)
    )
    wide: dict[str, dict[str, dict[int, str]]] = {}
    for name, column in by_name.items():
        if column not in (time, frame, agent) and (found := _agent_and_coordinate(name)) is not None:
            owner, kind, axis = found
            wide.setdefault(owner, {}).setdefault(kind, {})[axis] = column
    long = wide.pop("", {})
    shown = ", ".join(map(str, list(names)[:12])) + (", ..." if len(names) > 12 else "")
    if not long and not wide:
        raise ArgumentError(
            f"{where} has the columns {shown}: expected time, id, x, y (long) or time, x1, y1, x2, y2 (wide); name "
            'them by columns={"t": ..., "id": ..., "q": [...], "p": [...]}'
        )
    if "q" in long or not wide:
        return Layout(time, frame, agent, _axes(long, where, shown), {})
    each = {agent_: _axes(kinds, where, shown) for agent_, kinds in wide.items()}
    sizes = {agent_: {kind: len(columns) for kind, columns in kinds.items()} for agent_, kinds in each.items()}
    first = next(iter(wide))
    if (other := next((agent_ for agent_ in sizes if sizes[agent_] != sizes[first]), None)) is not None:
        raise ArgumentError(f"{where} has other columns for agent {other} than for {first}: expected alike")
    return Layout(time, frame, None, {}, each)


def given_layout(columns: Mapping[str, Any], names: Sequence[Any], where: str) -> Layout:
    """Return the layout that a user states: "t", "id", and lists of columns for "q", "p", "u"."""
    unknown = set(columns) - {"t", "frame", "id", "q", "p", "u"}
    if unknown:
        raise ArgumentError(f"columns has {format_value(sorted(unknown))}: expected t, frame, id, q, p, u")
    given = {k: columns[k] for k in "qpu" if k in columns}
    kinds = {k: [x] if isinstance(x, str) else list(x) if isinstance(x, Sequence) else [x] for k, x in given.items()}
    asked = [*(columns[k] for k in ("t", "frame", "id") if k in columns), *(x for v in kinds.values() for x in v)]
    lacking = [x for x in asked if x not in list(names)]
    if lacking:
        raise ArgumentError(f"{where} has no column {lacking[0]!r}: expected one of {', '.join(map(str, names))}")
    if "q" not in kinds or any(len(v) != len(kinds["q"]) for v in kinds.values()) or not 1 <= len(kinds["q"]) <= 3:
        got = format_value(dict(columns))
        raise ArgumentError(f"columns = {got}: expected 1 to 3 columns for q, and as many for p and u")
    return Layout(columns.get("t"), columns.get("frame"), columns.get("id"), kinds, {})


def _axes(kinds: Mapping[str, Mapping[int, str]], where: str, shown: str) -> dict[str, list[str]]:
    """Columns of each kind in the order of their axes; raise where one is missing."""
    if "q" not in kinds:
        raise ArgumentError(f"{where} has the columns {shown}: expected positions x, y, z among them")
    m = max(kinds["q"]) + 1
    for kind, columns in kinds.items():
        size = max(m, max(columns) + 1)
        lacking = [KINDS[kind][0].format(AXES[k]) for k in range(size) if k not in columns]
        if lacking:
            raise ArgumentError(f"{where} has the columns {shown}: expected {', '.join(lacking)} too, or fewer axes")
        if len(columns) > m:
            extra = KINDS[kind][0].format(AXES[m])
            raise ArgumentError(f"{where} has {extra} and no {AXES[m]}: expected both or none")
    return {kind: [columns[k] for k in range(m)] for kind, columns in kinds.items()}
