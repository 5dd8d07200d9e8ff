"""Expected form of a certificate: its keys at every depth, and how numbers are written.

A form is a dict of forms by key, a list of one form for all entries, or one of the words below. What a checker does not
read has no place in a certificate, or it would be believed unseen.
"""

import re
from collections.abc import Mapping
from typing import Any

from flockana.base.errors import FlockanaError, format_value

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


class RejectedError(FlockanaError):
    """Exception for a certificate that does not prove its statement."""


def ensure_form(data: Any, form: Any, where: str = "it") -> None:
    """Raise `RejectedError` unless JSON data have the expected form in every key and entry."""
    if isinstance(form, dict):
        _ensure(isinstance(data, Mapping), data, where, "names with their values")
        lacking, unknown = sorted({*form} - {*data}), sorted(map(str, {*data} - {*form}))
        if lacking or unknown:
            parts = [f"lacks {key!r}" for key in lacking] + [f"holds {key[:_SHOWN]!r}" for key in unknown]
            raise RejectedError(f"{where} {', '.join(parts)}: expected {', '.join(form)}; nothing else is checked")
        for key, inner in form.items():
            ensure_form(data[key], inner, key if where == "it" else f"{where}.{key}")
    elif isinstance(form, list):
        _ensure(isinstance(data, list), data, where, "a list")
        for k, entry in enumerate(data):
            ensure_form(entry, form[0], f"{where}[{k}]")
    elif form in _WRITTEN:
        pattern, expected = _WRITTEN[form]
        fits = isinstance(data, str) and len(data) <= _LONGEST and re.fullmatch(pattern, data, re.ASCII)
        _ensure(bool(fits), data, where, f"{expected}, of at most {_LONGEST} characters and 3 digits of an exponent")
    elif form != ANY:
        kind, expected = _TYPES[form]
        _ensure(type(data) is kind, data, where, expected)


def _ensure(holds: bool, data: Any, where: str, expected: str) -> None:
    if not holds:
        raise RejectedError(f"{where} = {format_value(data)[:_SHOWN]}: expected {expected}")
