"""Errata of the sources: printed and correct statement, with the status of both."""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Literal, get_args

from flockana.base.errors import ArgumentError, UnknownNameError
from flockana.base.module_discovery import source_files

Sort = Literal["wrong", "incomplete", "vacuous", "confirmed"]

SORTS: dict[Sort, str] = {
    "wrong": "false as printed",
    "incomplete": "true with a hypothesis that is missing",
    "vacuous": "true, but of no or hardly any flock",
    "confirmed": "examined, and true as printed",
}
FOREWORD = (
    "E1 to E16 are in lecture slides and student projects on Olfati-Saber's paper of 2006. None is shown to be in the "
    "paper itself; the last column says where the paper was not looked up. All others are in the papers named."
)
_COLUMNS = 9
_MARKS = {"verified": "✓", "refuted": "✗", "": "·"}


@dataclass(frozen=True)
class Erratum:
    """Printed statement of a source, and the correct one.

    Examples
    --------
    >>> print(Erratum("E0", "slides", "p. 1", "1 = 2", ("one", "refuted"), "1 = 1", ("all", "verified"), "wrong", "no"))
    E0 · slides: 1 = 2 ✗ · right: 1 = 1 ✓
    """

    id: str  # id of the theorem that checks it; a misprint has no theorem
    printer: str  # who prints it
    where: str
    printed: str
    claim: tuple[str, str]  # name and status of the claim that is the printed statement; empty of what was only read
    right: str
    right_claim: tuple[str, str]  # the same of the right statement
    sort: Sort
    in_paper: str  # whether the paper that the source presents is known to have it
    references: tuple[str, ...] = ()  # keys of the bibliography: the source, and the paper that it presents

    def __post_init__(self) -> None:
        if self.sort not in get_args(Sort):
            raise ArgumentError(f"erratum {self.id}: sort = {self.sort!r}, expected one of {', '.join(get_args(Sort))}")

    @property
    def mark(self) -> str:
        """Mark of the printed statement: ✗ if false, ✓ if true, · if only read."""
        return _MARKS[self.claim[1]]

    @property
    def right_mark(self) -> str:
        """Mark of the correct statement: ✗ if false, ✓ if true, · if only read."""
        return _MARKS[self.right_claim[1]]

    def __str__(self) -> str:
        return f"{self.id} · {self.printer}: {self.printed} {self.mark} · right: {self.right} {self.right_mark}"


@cache
def errata() -> tuple[Erratum, ...]:
    """Return all errata of the sources, from their tables.

    Examples
    --------
    >>> print(errata()[0])
    E1 · slides: H = V + Σ‖p_i‖² falls ✗ · right: V + ½ Σ‖p_i‖² falls ✓
    >>> {item.id for item in errata() if item.sort == "confirmed"} >= {"J14", "J17", "J18", "L6"}
    True
    """
    items = (item for path in source_files("errata.csv") for item in _read_table(path))
    return tuple(sorted(items, key=_order))


def _read_table(path: Path) -> Iterator[Erratum]:
    """Yield the errata of a source's table: ``# references``, column names, then one erratum per line."""
    references, _, *lines = path.read_text(encoding="utf-8").splitlines()
    for line in lines:
        cells = [cell.strip() for cell in line.split("|")]
        if len(cells) != _COLUMNS:
            raise ArgumentError(f"{cells[0]}: {len(cells)} columns, expected {_COLUMNS}")
        name, printer, where, printed, is_, right, right_is, sort, in_paper = cells
        claims = (printed, _claim(is_), right, _claim(right_is))
        numbers = tuple(references.removeprefix("#").split())
        yield Erratum(name, printer, where, *claims, sort, in_paper, numbers)  # type: ignore[arg-type]  # checked by itself


def _order(item: Erratum) -> tuple[bool, str, int]:
    """Return the sort key of an erratum: E2 before E10, numbered errata first within a source."""
    letters = item.id.rstrip("0123456789")
    return item.id[0].islower(), letters, int(item.id.removeprefix(letters) or 0)


def _claim(text: str) -> tuple[str, str]:
    name, _, status = text.partition(": ")
    return name, status


def erratum_of(theorem: str) -> Erratum | None:
    """Return the erratum checked by a theorem; None without one."""
    return next((item for item in errata() if item.id == theorem), None)


def printed(theorem: str) -> str:
    """Return the printed statement of a source, the title of its theorem."""
    if (item := erratum_of(theorem)) is None:
        raise UnknownNameError("erratum", theorem, [item.id for item in errata()])
    return f"{item.printed[:1].upper()}{item.printed[1:]} (as printed)"
