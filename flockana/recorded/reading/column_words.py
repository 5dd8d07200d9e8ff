"""Vocabulary of column names in recordings: kind, axis, owner and unit."""

import csv
import re
from importlib.resources import files
from typing import Any, NamedTuple

AXES = "xyz"
_WORDS = {
    key: set(words.split())
    for key, words in csv.reader(files(__package__).joinpath("words.csv").read_text(encoding="utf-8").splitlines())
}
_TIMES, _FRAMES, _AGENTS, _NUMBERS, _FILLERS = (_WORDS[key] for key in ("time", "frame", "agent", "number", "filler"))
_ROLES = {key: _WORDS[key] for key in ("other", "orientation", "u", "p", "q")}
_PREFIXES = {"q": ("pos", "loc", "t", "c"), "p": ("v", "vel"), "u": ("u", "a", "acc"), "p?": ("p",), "q?": ("q",)}
_SUFFIXES = {"pos": "q", "vel": "p", "acc": "u", "dot": "p"}
_FUSED = {
    first + axis: (kind, axis) for kind, prefixes in _PREFIXES.items() for first in prefixes for axis in "xyzw"
} | {axis + last: (kind, axis) for axis in AXES for last, kind in _SUFFIXES.items()}

_LENGTHS = {"m": 1.0, "mm": 1e-3, "cm": 1e-2, "dm": 0.1, "km": 1e3, "um": 1e-6, "nm": 1e-9, "ft": 0.3048}
_LENGTHS |= {"in": 0.0254, "mi": 1609.344, "px": 0.0, "bl": 0.0}
_DURATIONS = {"s": 1.0, "ms": 1e-3, "us": 1e-6, "ns": 1e-9, "min": 60.0, "h": 3600.0}
_SPELLINGS = {
    spelling: key.removeprefix("unit ") for key in _WORDS if key.startswith("unit ") for spelling in _WORDS[key]
}
_BRACKET = re.compile(r"\s*[\[({]\s*([^\[\](){}]*?)\s*[\])}]\s*$")  # x [m], t (s)
_RATE = re.compile(r"^([a-zµμ]+)(?:\s*(?:/|·|\*|per|\s)\s*([a-zµμ]+)\s*(?:\^|\*\*)?-?([12²])?(?:\s*/\s*([a-zµμ]+))?)?$")
_PIECES = re.compile(r"[A-Z]+(?=[A-Z][a-z])|[A-Z]?[a-zµμ]+|[A-Z]+|\d+")


class Unit(NamedTuple):
    """Unit of a column: text, factor to metres and seconds, power of time, and seconds per time unit."""

    text: str
    length: str
    factor: float
    power: int
    second: float = 1.0


class Word(NamedTuple):
    """Meaning of a column name: kind ("q", "p", "u", ...), axis ("x" to "w"), owner words, and unit.

    `pattern` is the name without its axis: columns of one vector share it.
    """

    kind: str
    axis: str
    owner: tuple[str, ...]
    unit: Unit | None
    pattern: tuple[str, ...]


def unit_of(text: str) -> Unit | None:
    """Return the unit named by a text, such as m, ms or mm/s; None without one.

    Examples
    --------
    >>> unit_of("mm/s")
    Unit(text='mm/s', length='mm', factor=0.001, power=1, second=1.0)
    """
    match = _RATE.match(text.strip().lower())
    if match is None:
        return None
    first_part, *remaining_parts = (_SPELLINGS.get(group, group) if group else "" for group in match.groups())
    unit_name, power = remaining_parts[0], 2 if remaining_parts[1] in ("2", "²") or remaining_parts[2] else 1
    if first_part in _DURATIONS and not unit_name:
        return Unit(text.strip(), "", _DURATIONS[first_part], 0)
    if first_part in _LENGTHS and (not unit_name or unit_name in _DURATIONS):
        factor = (_LENGTHS[first_part] or 1.0) / (_DURATIONS[unit_name] ** power if unit_name else 1.0)
        return Unit(text.strip(), first_part, factor, power if unit_name else 0, _DURATIONS.get(unit_name, 1.0))
    return Unit(text.strip(), first_part, 1.0, 0) if first_part in ("deg", "rad", "au") else None


def words_of(name: Any) -> tuple[list[str], Unit | None]:
    """Return the words of a column's name in lower case, and its unit, from brackets or a last word such as _mm."""
    text, unit = str(name).strip(), None
    if (match := _BRACKET.search(text)) and (not match[1] or (unit := unit_of(match[1]))):
        text = text[: match.start()]
    pieces = _PIECES.findall(text)
    has_mixed_case = text != text.upper()  # the A of robotA is a name, that of AX an acceleration
    words = [x if has_mixed_case and len(x) == 1 and x.isupper() and x not in "XYZWT" else x.lower() for x in pieces]
    last = _SPELLINGS.get(words[-1], words[-1]) if words else ""
    if unit is None and len(words) > 1 and last != "in" and (last in _LENGTHS or last in _DURATIONS or "/" in last):
        unit, words = unit_of(last), words[:-1]
    return words, unit


def _known(word: str, kind: set[str]) -> bool:
    return word in kind or (word.endswith("s") and word[:-1] in kind)


def is_time(words: list[str]) -> bool:
    """Return whether words denote the time of a row."""
    rest = [word for word in words if word not in _FILLERS and word not in _ROLES["q"]]
    return bool({*rest} & _TIMES) and all(word in _TIMES or word in ("frame", "timestep", "start") for word in rest)


def is_frame(words: list[str]) -> bool:
    """Return whether words denote a frame count."""
    content_words = [word for word in words if word not in _NUMBERS | _FILLERS]
    return bool(content_words) and all(_known(word, _FRAMES) for word in content_words)


def is_agent(words: list[str]) -> bool:
    """Return whether words denote the agent of a row."""
    content_words = [word for word in words if word not in _FILLERS]
    return (
        bool(content_words)
        and all(_known(word, _AGENTS) or word in _NUMBERS for word in content_words)
        and content_words[0] not in ("no", "n", "count")
    )


def is_agents_word(word: str) -> bool:
    """Return whether a word denotes agents, such as robot."""
    return _known(word, _AGENTS - {"target"})


def coordinate(words: list[str], unit: Unit | None) -> Word | None:
    """Return the coordinate that the words of a column name denote (kind, axis, owner, unit); None without one."""
    at = [k for k, word in enumerate(words) if word in _FUSED or word in "xyzw"]
    if len(at) != 1:
        return None
    word = words[at[0]]
    kind, axis = _FUSED.get(word, ("", word))
    others = words[: at[0]] + words[at[0] + 1 :]
    roles = [next((role for role, words_of_role in _ROLES.items() if each in words_of_role), "") for each in others]
    rank = next((role for role in ("other", "orientation", "u", "p") if role in roles), kind or "q")
    if others == ["p"] or others == ["q"]:  # p_x: velocities here, positions elsewhere; q_x: of a quaternion, perhaps
        rank = others[0] + "?"
    owner = tuple(
        each for each, role in zip(others, roles, strict=True) if not role and each not in _FILLERS and each not in "pq"
    )
    pattern = tuple(word.replace(axis, "") if k == at[0] else each for k, each in enumerate(words))
    return Word(rank, axis, owner, unit, pattern)
