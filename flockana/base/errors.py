"""Exceptions that flockana raises on purpose, and how messages write values.

Every message names the value it got, what was expected, and the remedy. Anything else that escapes is a bug.
"""

import math
import re
from collections.abc import Iterable
from dataclasses import is_dataclass
from typing import Any, Self

_LINE_END = re.compile(r"\s*\n\s*")
_NEAREST = 3  # names that are suggested
_FEW = 16  # names that are all listed
_LONG = 120  # letters of a law or the like, beyond which its parameters are left out
DIGITS = 40  # of a whole number; a longer one is described by its size: Python itself refuses to write some


def format_value(value: Any) -> str:
    """Return a value as messages write it: on one line, very long whole numbers by their size, long laws by name.

    Parameters
    ----------
    value : object
        What was given.

    Examples
    --------
    >>> format_value("x"), format_value([1, 2]), format_value(-(10**400))
    ("'x'", '[1, 2]', 'about -1e+400')
    """
    if isinstance(value, int) and abs(value) >= 10**DIGITS:
        exponent = math.floor(math.log10(abs(value)))
        return f"about {'-' if value < 0 else ''}1e+{exponent}"
    if isinstance(value, str):
        return repr(value)  # its own spaces stay
    try:
        text = " ".join(repr(value).split())
        return f"{type(value).__name__}(...)" if len(text) > _LONG and is_dataclass(value) else text
    except ValueError:  # such a number in a list
        return f"a {type(value).__name__} that cannot be written"


class FlockanaError(Exception):
    """Base class of flockana's exceptions, with one-line messages."""

    def __init__(self, *args: object) -> None:
        super().__init__(*(_LINE_END.sub(" ", arg) if isinstance(arg, str) else arg for arg in args))


class ArgumentError(FlockanaError, ValueError):
    """Exception for an argument of wrong value, shape or type."""


class UnknownNameError(ArgumentError):
    """Exception for an unknown name of a theorem, scenario, method or the like.

    Parameters
    ----------
    kind : str
        What was looked for, such as ``"scenario"``.
    known : iterable of str
        The names that exist; the closest is suggested, whatever the case. Of many only the three nearest are listed.

    Examples
    --------
    >>> str(UnknownNameError("scenario", "Colapse", ["collapse", "msn-case1"]))
    "unknown scenario 'Colapse'; did you mean 'collapse'? Known: collapse, msn-case1"
    """

    def __init__(self, kind: str, name: object, known: object) -> None:
        from difflib import get_close_matches

        names = sorted(map(str, known)) if isinstance(known, Iterable) else [str(known)]
        names_by_fold = {known_name.casefold(): known_name for known_name in names}
        text = name if isinstance(name, str) else format_value(name)
        known_text = f"known: {', '.join(names) or 'none'}"
        if len(names) > _FEW:
            nearest = get_close_matches(text.casefold(), names_by_fold, n=_NEAREST, cutoff=0.0)
            known_text = f"the nearest of {len(names)}: {', '.join(names_by_fold[item] for item in nearest)}"
        for close_name in get_close_matches(text.casefold(), names_by_fold, n=1):
            known_text = f"did you mean {names_by_fold[close_name]!r}? {known_text[0].upper()}{known_text[1:]}"
        super().__init__(f"unknown {kind} {format_value(name)}; {known_text}")
        self._arguments = (str(kind), text, names)

    def __reduce__(self) -> tuple[type[Self], tuple[str, str, list[str]]]:
        return type(self), self._arguments  # so that it travels between processes


class FileError(FlockanaError, OSError):
    """Exception for a file that cannot be read or written, is damaged, or is of another program."""


class SolverError(FlockanaError, RuntimeError):
    """Exception for a numerical method that did not converge; the message says where and why."""
