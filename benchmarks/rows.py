"""A row of the table, what is asked of it, and the table in Markdown and JSON."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass, field
from math import isfinite
from typing import Any, Literal


@dataclass(frozen=True)
class Asked:
    """A bound on a row's ratio to its baseline, or on its own value; and what is in the way where it is not kept."""

    sense: Literal["<=", ">="]
    bound: float
    of: Literal["ratio", "value"] = "ratio"
    why: str = ""

    def met(self, row: Row) -> bool:
        """Whether the row keeps it; a number that is missing does not."""
        number = row.ratio if self.of == "ratio" else row.value
        if number is None or not isfinite(number):
            return False
        return number <= self.bound if self.sense == "<=" else number >= self.bound


@dataclass(frozen=True)
class Row:
    """One measured number.

    Attributes
    ----------
    study : str
        Where it belongs.
    name : str
        What was measured.
    n : int or None
        Agents.
    value : float
        Median, in `unit`.
    unit : str
        "µs", "s", "ns per pair", "MB" ...
    baseline : str
        What it is compared with; empty if with nothing.
    ratio : float or None
        What the name and the baseline say: time over the baseline's ("over"), or the baseline's over ours ("faster").
    asked : Asked or None
        The bound that it is to keep.
    note : str
        What the reader must know.
    """

    study: str
    name: str
    n: int | None
    value: float
    unit: str
    baseline: str = ""
    ratio: float | None = None
    asked: Asked | None = None
    note: str = ""

    @property
    def verdict(self) -> str:
        """ "yes" or "no", or empty where nothing is asked."""
        return "" if self.asked is None else "yes" if self.asked.met(self) else "no"


@dataclass(frozen=True)
class Found:
    """What a study found: rows, notices of what it left out, and series to draw."""

    rows: Sequence[Row] = ()
    notices: Sequence[str] = ()
    series: Mapping[str, Sequence[Mapping[str, Any]]] = field(default_factory=dict)


def to_json(rows: Iterable[Row]) -> list[dict[str, Any]]:
    """Rows as plain dictionaries, with what they keep."""
    return [{**asdict(row), "met": row.verdict} for row in rows]


def from_json(rows: Iterable[Mapping[str, Any]]) -> list[Row]:
    """The rows that `to_json` wrote."""
    plain = [{name: value for name, value in row.items() if name != "met"} for row in rows]
    return [Row(**{**row, "asked": row["asked"] and Asked(**row["asked"])}) for row in plain]


def number(x: float | None) -> str:
    """Three digits, as one reads them.

    >>> number(0.01234), number(1234.0), number(None)
    ('0.0123', '1230', '')
    """
    if x is None:
        return ""
    if not isfinite(x):
        return str(x)
    if x == 0.0:
        return "0"
    digits = f"{x:.3g}"
    return digits if "e" not in digits or abs(x) < 1e-4 else f"{float(digits):.0f}"


def table(rows: Sequence[Row]) -> str:
    """Rows as a Markdown table."""
    head = "| what | n | median | against | ratio | asked | met |\n|---|---|---|---|---|---|---|\n"
    return head + "".join(_line(row) for row in rows)


def missed(rows: Iterable[Row]) -> str:
    """The rows that do not keep what is asked of them, and why, as a Markdown list; empty if there are none.

    >>> asked = Asked("<=", 0.5, "value", "Python alone takes half of it.")
    >>> missed([Row("Command line", "scenarios", None, 0.6, "s", asked=asked)])
    '- Command line, scenarios: 0.6 s, asked median <= 0.5. Python alone takes half of it.\\n'
    """
    lines = []
    for row in rows:
        if row.asked is not None and row.verdict == "no":
            of_value, share = row.asked.of == "value", number(row.ratio) or "missing"
            found = f"{number(row.value)} {row.unit}" if of_value else f"ratio {share}"
            against = f" (against {row.baseline})" if row.baseline and not of_value else ""
            name = ", ".join((row.study, row.name, *(() if row.n is None else (f"n = {_count(row.n)}",))))
            lines.append(f"- {name}: {found}{against}, asked {_asked(row.asked)}. {row.asked.why}".rstrip() + "\n")
    return "".join(lines)


def _asked(asked: Asked) -> str:
    return f"{'' if asked.of == 'ratio' else 'median '}{asked.sense} {number(asked.bound)}"


def _count(n: int) -> str:
    return f"{n:,}".replace(",", " ")


def _line(row: Row) -> str:
    cells = (
        row.name + (f" ({row.note})" if row.note else ""),
        "" if row.n is None else _count(row.n),
        f"{number(row.value)} {row.unit}",
        row.baseline,
        number(row.ratio),
        "" if row.asked is None else _asked(row.asked),
        row.verdict,
    )
    return "| " + " | ".join(cells) + " |\n"
