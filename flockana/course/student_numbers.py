"""Each student's own numbers: variants of exercises, from numbers.toml beside the lectures, drawn by name.

A row of the table lists what stands in the lecture and what may stand there instead; the rows of an exercise vary
together, in its question, solution and check.
"""

import re
import tomllib
from itertools import pairwise
from pathlib import Path
from typing import Any

from flockana.base.digests import sha256

_VARY = {"exercise", "solution", "check"}


def variants(folder: Path) -> dict[str, dict[str, list[list[str]]]]:
    """Return the alternative numbers of each exercise, by lecture and by the variable of the answer."""
    return tomllib.loads((folder / "numbers.toml").read_text(encoding="utf-8"))


def replace_numbers(text: str, rows: list[list[str]], column: int) -> str:
    """Return a text with listed numbers replaced by their alternatives in one column of a table.

    Examples
    --------
    >>> replace_numbers("0.8 or 10.8 of 1.6", [["0.8", "0.6"], ["1.6", "1.2"]], 1)
    '0.6 or 10.8 of 1.2'
    """
    own_column = {row[0]: row[column] for row in rows}
    number_pattern = "|".join(re.escape(pattern_item) for pattern_item in sorted(own_column, key=len, reverse=True))
    return re.sub(rf"(?<![\w.])(?:{number_pattern})(?!\d|\.\d)", lambda found: own_column[found[0]], text)


def draw_column(student: str, exercise: str, columns: int) -> int:
    """Return the index of the set of numbers that a student gets in an exercise, from the student's name."""
    name = " ".join(student.casefold().split())
    return int(sha256([f"{name}/{exercise}"]), 16) % columns


def give_own_numbers(cells: list[Any], number: str, rows_of: dict[str, list[list[str]]], student: str) -> None:
    """Put a student's numbers into the cells of a lecture, exercise by exercise."""
    tags = [set(cell.metadata.get("tags", ())) for cell in cells]
    starts = [k for k, tagged in enumerate(tags) if "exercise" in tagged]
    for a, b in pairwise([*starts, len(cells)]):
        name = next(cells[k].source.partition(" = ")[0] for k in range(a, b) if "answer" in tags[k])
        if name in rows_of:
            column = draw_column(student, f"{number}.{name}", len(rows_of[name][0]))
            for k in range(a, b):
                if tags[k] & _VARY:
                    cells[k].source = replace_numbers(cells[k].source, rows_of[name], column)
