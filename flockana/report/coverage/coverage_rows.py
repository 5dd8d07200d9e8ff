"""Coverage tables: one row for each item of a source, with the covering names in flockana."""

import os
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Literal, get_args

from flockana.base.bibtex_entries import bibliography
from flockana.base.errors import ArgumentError
from flockana.base.module_discovery import source_files

Standing = Literal["held", "weaker", "absent", "prose"]

KINDS = ("function", "plot", "scenario", "report", "theorem", "claim", "erratum", "proof", "notebook")
OURS = "flockana"  # the key of what is in no source
_COLUMNS = ("place", "what", "standing", "held by", "remark")
_MARK = "|"  # between columns; texts write a norm as ‖


@dataclass(frozen=True)
class Reference:
    """Reference to a name in flockana, such as a theorem or a scenario, with its kind."""

    kind: str  # one of `KINDS`
    name: str  # such as ``"flockana.Algorithm2"``, ``"os-1"``, ``"os-3/iv-barrier"`` or ``"01"``

    def __post_init__(self) -> None:
        if self.kind not in KINDS or not self.name:
            raise ArgumentError(
                f"reference '{self}': expected kind:name, such as theorem:os-1; the kinds are {', '.join(KINDS)}"
            )

    def __str__(self) -> str:
        return f"{self.kind}:{self.name}"


@dataclass(frozen=True)
class Row:
    """Row of a coverage table: an item of a source, and the references to what covers the item in flockana."""

    place: str  # where it stands in the source: section, slide, equation, figure, theorem
    what: str  # what it is, in our words
    standing: Standing  # whether it is held, held in part or not at all, or a text that says nothing which could be
    held_by: tuple[Reference, ...] = ()  # what holds it; of prose, what has to do with it
    remark: str = ""  # of what is weaker, absent or prose, why; else empty, or what a reader should know

    def __post_init__(self) -> None:
        if not self.place or not self.what:
            raise ArgumentError(f"a row says {self.place!r}, {self.what!r}: expected a place and what stands there")
        if self.standing not in get_args(Standing):
            standings = ", ".join(get_args(Standing))
            raise ArgumentError(f"{self.place}: {self.what}: standing = {self.standing!r}, expected one of {standings}")
        if self.standing == "absent" and self.held_by:
            raise ArgumentError(f"{self.place}: {self.what}: absent, and held by {self.held_by[0]}; call it weaker")
        if self.standing == "held" and not self.held_by:
            raise ArgumentError(f"{self.place}: {self.what}: held by nothing; name what holds it, or call it weaker")
        if self.standing != "held" and not self.remark:
            raise ArgumentError(f"{self.place}: {self.what}: {self.standing}, without a remark that says why")
        if len(set(self.held_by)) < len(self.held_by):
            raise ArgumentError(f"{self.place}: {self.what}: a reference is given twice; leave one out")


@dataclass(frozen=True)
class Source:
    """Source with its coverage rows, in the source's order."""

    key: str
    title: str  # what it is
    rows: tuple[Row, ...]

    def count(self, standing: Standing) -> int:
        """Return the number of the source's coverage rows with the given standing."""
        return sum(row.standing == standing for row in self.rows)


def coverage() -> tuple[Source, ...]:
    """Return all coverage tables, the longest first, the table without a source last."""
    tables = [read_table(path) for path in source_files("coverage/*.csv")]
    return tuple(sorted(tables, key=lambda source: (source.key == OURS, -len(source.rows))))


def read_table(path: str | os.PathLike[str]) -> Source:
    """Return one table from text: ``# title``, column names, then one row per line, columns separated by |."""
    path = Path(path)
    if path.stem not in bibliography():
        raise ArgumentError(f"{path.name}: expected a key of the bibliography: {', '.join(bibliography())}")
    title, *lines = path.read_text(encoding="utf-8").splitlines() or [""]
    if not title.startswith("# ") or not lines or _cells(lines[0]) != _COLUMNS:
        raise ArgumentError(f"{path.name}: expected '# title' and '{f' {_MARK} '.join(_COLUMNS)}' to begin with")
    return Source(path.stem, title.removeprefix("# "), tuple(_rows(path.name, lines[1:])))


def _rows(name: str, lines: list[str]) -> Iterator[Row]:
    row_numbers: dict[tuple[str, str], int] = {}
    for number, line in enumerate(lines, 3):
        try:
            row = _row(line)
        except ArgumentError as error:
            raise ArgumentError(f"{name}, line {number}: {error}") from None
        if (first_row := row_numbers.setdefault((row.place, row.what), number)) != number:
            raise ArgumentError(f"{name}, line {number}: the same as line {first_row}; leave one out")
        yield row


def _row(line: str) -> Row:
    cells = _cells(line)
    if len(cells) != len(_COLUMNS):
        raise ArgumentError(f"{len(cells)} columns, expected {len(_COLUMNS)}: {', '.join(_COLUMNS)}")
    place, what, standing, test_names, remark = cells
    split_texts = (text.partition(":") for text in test_names.split())
    references = tuple(Reference(kind, name) for kind, _, name in split_texts)
    return Row(place, what, standing, references, remark)  # type: ignore[arg-type]  # checked by the row itself


def _cells(line: str) -> tuple[str, ...]:
    return tuple(cell.strip() for cell in line.split(_MARK))
