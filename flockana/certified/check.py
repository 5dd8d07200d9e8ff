"""Certificates read by who did not make them: a digest against accidents, and a checker for each kind against errors.

A kind is checked by the module ``check_<kind>`` beside this one, which shares with the code that proves only the scalar
functions in balls (`intervals`). A change of any number is seen by the digest; of one that was sealed again, what it
claims is decided by the mathematics, to the last digit that is stated. One that was sealed again with another premise,
such as a gain a thousandth larger, of which every claim is still proved, is a certificate of another law, and holds.
"""

from __future__ import annotations

import hashlib
import importlib
import json
import re
from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path
from typing import Any

from flockana.base.errors import FileError, FlockanaError
from flockana.base.files import read_whole
from flockana.base.serialize import read_json
from flockana.certified.statements import FORMAT, STATEMENTS

_LONGEST = 500  # characters of a number
_AGENTS = 100
_HUGE = re.compile(r"p[+-]?[\d_]{4,}|^[+-]?[\d._]*e[+-]?[\d_]{4,}$", re.IGNORECASE)  # an exponent that would never end


class RejectedError(FlockanaError):
    """A certificate that does not prove what it says."""


@dataclass(frozen=True)
class Checked:
    """A certificate that holds.

    Parameters
    ----------
    kind : str
        Such as ``"basin"``.
    statement : str
        What is proved.
    steps : tuple of str
        What was verified, in order.
    prose : tuple of str
        What no machine checks.
    """

    kind: str
    statement: str
    steps: tuple[str, ...]
    prose: tuple[str, ...]


def check_certificate(path: str | Path) -> Checked:
    """Verify a certificate's file.

    Parameters
    ----------
    path : str or Path
        JSON, as written by `write_certificate`.

    Returns
    -------
    Checked

    Raises
    ------
    FileError
        If the file is no certificate.
    RejectedError
        If it does not prove what it says.
    """
    try:
        data = read_json(read_whole(path))
    except ValueError as error:
        raise FileError(f"{path} is no certificate: {error}") from error
    if not isinstance(data, dict) or data.get("format") != FORMAT:
        raise FileError(f"{path} is no certificate: expected JSON of the format {FORMAT!r}")
    return check_data(data)


def check_data(data: Mapping[str, Any]) -> Checked:
    """Verify a certificate that was read; `RejectedError` if it does not hold."""
    rest = {key: value for key, value in data.items() if key != "digest"}
    found = hashlib.sha256(json.dumps(rest, sort_keys=True).encode()).hexdigest()
    ensure(data.get("digest") == found, "its digest is not that of its contents: something in it was changed")
    kind = str(data.get("kind"))
    ensure(kind in STATEMENTS, f"its kind {kind!r} is unknown")
    ensure(data.get("format") == FORMAT, f"its format {data.get('format')!r} is unknown")
    statement, prose = STATEMENTS[kind]
    ensure(data.get("statement") == statement, f"it states something else than a certificate of kind {kind!r} proves")
    ensure(data.get("prose") == list(prose), "it lists something else as not checked by machine")
    try:
        _ensure_modest({key: value for key, value in rest.items() if key not in ("statement", "prose", "basin")})
        steps = tuple(importlib.import_module(f"{__package__}.check_{kind}").check(rest))
        return Checked(kind, statement, steps, prose)
    except (KeyError, ValueError, TypeError, AttributeError, IndexError, ArithmeticError) as error:
        raise RejectedError(f"it is incomplete or out of form: {type(error).__name__}: {error}") from error


def _ensure_modest(data: Any) -> None:
    """Raise `RejectedError` on what a checker could not read to the end: endless numbers, or huge flocks."""
    if isinstance(data, str):
        ensure(len(data) <= _LONGEST and not _HUGE.search(data), f"{data[:30]!r}: expected a shorter number")
    elif isinstance(data, Mapping):
        for name in ("positions", "q0"):
            ensure(len(data.get(name, ())) <= _AGENTS, f"expected at most {_AGENTS} agents")
        for value in data.values():
            _ensure_modest(value)
    elif isinstance(data, list):
        for value in data:
            _ensure_modest(value)


def ensure(holds: bool, otherwise: str) -> None:
    """Raise `RejectedError` unless something holds."""
    if not holds:
        raise RejectedError(otherwise)


def whole(value: Any) -> int:
    """The whole number that is stated, which 1.5, "1" and true are not."""
    ensure(type(value) is int, f"{value!r}: expected a whole number")
    number: int = value
    return number


def unit(stated: Fraction, digits: int) -> Fraction:
    """One in the last of so many significant digits of a stated number."""
    exponent = 0
    while stated and abs(stated) >= Fraction(10) ** (exponent + 1):
        exponent += 1
    while stated and abs(stated) < Fraction(10) ** exponent:
        exponent -= 1
    return Fraction(10) ** (exponent + 1 - digits)
