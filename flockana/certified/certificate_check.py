"""Independent certificate checking: a digest against accidents, a checker of each kind against errors.

A kind is checked by the module ``check_<kind>`` beside this one, which shares with the code that proves only the scalar
functions in balls (`intervals`). Its `form` names every key that it checks: another one, or one given twice, is
refused. A change of any number is seen by the digest; of one that was sealed again, what it claims is decided by the
mathematics, to the last digit that is stated. One that was sealed again with another premise, such as a gain a
thousandth larger, of which every claim is still proved, is a certificate of another law, and holds.

A form is a dict of forms by key, a list of one form for all entries, or one of the words below. What a checker does not
read has no place in a certificate, or it would be believed unseen.
"""

import importlib
import re
from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path
from typing import Any

from flint import arb

from flockana.base.errors import FileError, FlockanaError, format_value
from flockana.base.files import read_text_file
from flockana.base.integrity_seals import without_digest
from flockana.base.serialize import read_json
from flockana.certified.certificate_statements import FORMAT, STATEMENTS

_AGENTS = 100
_HEAD = ("format", "kind", "statement")
NUMBER, BINARY, WHOLE, TRUTH, TEXT, ANY = "number", "binary", "whole", "truth", "text", "any"
MADE_WITH = {"flockana": TEXT, "python-flint": TEXT}
PAIR_LAW = dict.fromkeys(
    ("algorithm", "d", "r", "eps", "h", "a", "b", "c1_alpha", "c2_alpha", "c1_gamma", "c2_gamma"), NUMBER
) | {"algorithm": TEXT}
_LONGEST = 500  # characters of a number
_SHOWN = 40
_WRITTEN = {
    NUMBER: (r"-?[0-9]+(/[0-9]+|(\.[0-9]+)?(e[+-]?[0-9]{1,3})?)", "a decimal in text, such as '-1.5e-3'"),
    BINARY: (r"-?0x[0-9a-f]+(\.[0-9a-f]+)?p[+-]?[0-9]{1,3}", "a number in hexadecimal, such as '-0x3p-1'"),
}
_TYPES = {
    WHOLE: (int, "a whole number"),
    TRUTH: (bool, "true or false"),
    TEXT: (str, "a text"),
    None: (type(None), "null"),
}


@dataclass(frozen=True)
class Checked:
    """Verified certificate: kind, statement and verified steps."""

    kind: str
    statement: str
    steps: tuple[str, ...]
    prose: tuple[str, ...]


def check_certificate(path: str | Path) -> Checked:
    """Verify a certificate's file.

    Raises
    ------
    FileError
        If the file is no certificate.
    RejectedError
        If it does not prove what it says.
    """
    try:
        data = read_json(read_text_file(path))
    except ValueError as error:
        raise FileError(f"{path} is no certificate: {error}") from error
    if not isinstance(data, dict) or data.get("format") != FORMAT:
        raise FileError(f"{path} is no certificate: expected JSON of the format {FORMAT!r}")
    return check_data(data)


def check_data(data: Mapping[str, Any]) -> Checked:
    """Verify a certificate's data; raise `RejectedError` if it does not hold."""
    try:
        rest = without_digest(data)
        kind = str(rest.get("kind"))
        ensure(kind in STATEMENTS, f"its kind {kind!r} is unknown")
        ensure(rest.get("format") == FORMAT, f"its format {rest.get('format')!r} is unknown")
        statement, prose = STATEMENTS[kind]
        ensure(rest.get("statement") == statement, f"it states something else than the kind {kind!r} proves")
        ensure(rest.get("prose") == list(prose), "it lists something else as not checked by machine")
        checker = importlib.import_module(f"{__package__}.check_{kind}")
        ensure_form(rest, dict.fromkeys(_HEAD, TEXT) | {"prose": [TEXT], "made_with": MADE_WITH} | checker.form(rest))
        ensure(len(rest.get("positions", rest.get("q0", ()))) <= _AGENTS, f"expected at most {_AGENTS} agents")
        return Checked(kind, statement, tuple(checker.check(rest)), prose)
    except FileError as error:
        raise RejectedError(str(error)) from error
    except (KeyError, ValueError, TypeError, AttributeError, IndexError, ArithmeticError, RecursionError) as error:
        raise RejectedError(f"it is incomplete or out of form: {type(error).__name__}: {error}") from error


def ensure(holds: bool, otherwise: str) -> None:
    """Raise `RejectedError` unless a condition of the check holds."""
    if not holds:
        raise RejectedError(otherwise)


def unit(stated: Fraction, digits: int) -> Fraction:
    """Return one unit in the last of a stated number's significant digits."""
    exponent = 0
    while stated and abs(stated) >= Fraction(10) ** (exponent + 1):
        exponent += 1
    while stated and abs(stated) < Fraction(10) ** exponent:
        exponent -= 1
    return Fraction(10) ** (exponent + 1 - digits)


def positive(rows: list[list[arb]], shift: Any = 0) -> bool:
    """Return whether every symmetric matrix in the balls, less shift·1, is certainly positive definite."""
    rows = [[entry - shift if i == j else entry for j, entry in enumerate(row)] for i, row in enumerate(rows)]
    for k, pivot in enumerate(rows):
        if not pivot[k] > 0:
            return False
        for row in rows[k + 1 :]:
            factor = row[k] / pivot[k]
            for j in range(k + 1, len(rows)):
                row[j] -= factor * pivot[j]
    return True


class RejectedError(FlockanaError):
    """Exception for a certificate that does not prove its statement."""


def ensure_form(data: Any, form: Any, where: str = "it") -> None:
    """Raise `RejectedError` unless JSON data have the expected form in every key and entry."""
    if isinstance(form, dict):
        _ensure_as(isinstance(data, Mapping), data, where, "names with their values")
        missing_names, unknown = sorted({*form} - {*data}), sorted(map(str, {*data} - {*form}))
        if missing_names or unknown:
            parts = [f"lacks {key!r}" for key in missing_names] + [f"holds {key[:_SHOWN]!r}" for key in unknown]
            raise RejectedError(f"{where} {', '.join(parts)}: expected {', '.join(form)}; nothing else is checked")
        for key, inner in form.items():
            ensure_form(data[key], inner, key if where == "it" else f"{where}.{key}")
    elif isinstance(form, list):
        _ensure_as(isinstance(data, list), data, where, "a list")
        for k, entry in enumerate(data):
            ensure_form(entry, form[0], f"{where}[{k}]")
    elif form in _WRITTEN:
        pattern, expected = _WRITTEN[form]
        fits = isinstance(data, str) and len(data) <= _LONGEST and re.fullmatch(pattern, data, re.ASCII)
        _ensure_as(bool(fits), data, where, f"{expected}, of at most {_LONGEST} characters and 3 digits of an exponent")
    elif form != ANY:
        kind, expected = _TYPES[form]
        _ensure_as(type(data) is kind, data, where, expected)


def _ensure_as(holds: bool, data: Any, where: str, expected: str) -> None:
    if not holds:
        raise RejectedError(f"{where} = {format_value(data)[:_SHOWN]}: expected {expected}")
