"""Docstrings are written to be read in a terminal: marks that reStructuredText would take for its own are escaped."""

from __future__ import annotations

import re
from typing import Any

_LITERAL = re.compile(r"(``.+?``|`[^`]+`|:math:`[^`]+`)")
_ENTRY = re.compile(r"^[\w*, ]+ : ")  # of a Parameters section
_MARKS = re.compile(r"(?<!\\)([|*])|(?<=\w)(_)(?!\w)")


def escaped(line: str) -> str:
    r"""A line with marks escaped outside of literals.

    Examples
    --------
    >>> escaped("|H| of `x*y`, Σ_i")
    '\\|H\\| of `x*y`, Σ_i'
    """
    parts = _LITERAL.split(line)
    return "".join(part if k % 2 else _MARKS.sub(lambda m: "\\" + m[0], part) for k, part in enumerate(parts))


def _process(app: Any, what: str, name: str, item: Any, options: Any, lines: list[str]) -> None:
    code = False
    for k, line in enumerate(lines):
        code = line.lstrip().startswith(">>>") or (code and bool(line.strip()))
        if not code and not _ENTRY.match(line) and not set(line.strip()) <= set("-=~"):
            lines[k] = escaped(line)


def setup(app: Any) -> dict[str, bool]:
    """Before numpydoc, which comes at priority 500."""
    app.connect("autodoc-process-docstring", _process, priority=100)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
