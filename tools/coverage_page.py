"""Write docs/coverage.md: what in flockana holds each item of each source (`python -m tools.coverage_page`).

It is made of the tables in flockana/sources/*/coverage, and every reference is looked up for the file that it leads to:
names that are none end it with status 2. `--check` writes nothing, and ends with 3 if the page is not what the tables
say.
"""

from __future__ import annotations

import sys
from itertools import groupby
from pathlib import Path
from typing import get_args

from flockana.report.coverage import Reference, Row, Source, coverage
from flockana.report.coverage.coverage_rows import Standing
from tools.coverage_references import faults, locate

PAGE = Path(__file__).resolve().parent.parent / "docs" / "coverage.md"
_OPENING = """\
# Coverage

Written by `make coverage` from the tables in `flockana/sources/*/coverage`; edit those. A row is an item of a source:
where it stands there, what it is in our words, and what holds it: a *function* (or class) of the library, a *plot*, a
*scenario* of the catalogue, a *report* (something that a source says of a run, judged on that scenario), a *theorem*,
a *claim* of one, an *erratum*, an executable *proof*, a *notebook*. That a theorem holds an item means that it is
checked, not that it is true: `flockana verify NAME` tells. Items in part are weaker than the source, absent ones are
not there, and the remark says why. The papers of other authors were not at hand where a table says "in our words".
"""
_STANDING = {"held": "", "weaker": "*in part*", "absent": "*absent*", "prose": "*prose*"}
_HEADER = ("place", "what stands there", "held by", "remark")


def page(sources: tuple[Source, ...]) -> str:
    """The page as Markdown."""
    parts = [_OPENING, _counts(sources), "## In part, or absent", _in_part(sources)]
    for source in sources:
        parts += [f"## {source.title}", markdown_table(_HEADER, [_cells(row) for row in source.rows])]
    return "\n\n".join(part.strip() for part in parts) + "\n"


def _counts(sources: tuple[Source, ...]) -> str:
    rows = [(source.title, *(str(number) for number in (len(source.rows), *_numbers(source)))) for source in sources]
    return markdown_table(("source", "items", "held", "in part", "absent", "prose"), rows)


def _numbers(source: Source) -> tuple[int, ...]:
    return tuple(source.count(standing) for standing in get_args(Standing))


def _in_part(sources: tuple[Source, ...]) -> str:
    rows = [
        (source.title, plain(row.place), plain(row.what), _STANDING[row.standing], plain(row.remark))
        for source in sources
        for row in source.rows
        if row.standing in ("weaker", "absent")
    ]
    return markdown_table(("source", "place", "what stands there", "standing", "why"), rows) if rows else "Nothing."


def _cells(row: Row) -> tuple[str, ...]:
    names = "; ".join(_named(kind, list(some)) for kind, some in groupby(row.held_by, key=lambda one: one.kind))
    standing = _STANDING[row.standing]
    return (
        plain(row.place),
        plain(row.what),
        ": ".join(text for text in (standing, names) if text),
        plain(row.remark),
    )


def _named(kind: str, references: list[Reference]) -> str:
    links = ", ".join(f"[`{one.name.removeprefix('flockana.')}`](../{locate(one)})" for one in references)
    return f"{kind} {links}"


def plain(text: str) -> str:
    """Text that Markdown leaves as it is."""
    for mark in ("\\", "*", "_", "<", "`"):
        text = text.replace(mark, f"\\{mark}")
    return text


def markdown_table(header: tuple[str, ...], rows: list[tuple[str, ...]]) -> str:
    """Return a table as Markdown."""
    lines = [header, ("---",) * len(header), *rows]
    return "\n".join(f"| {' | '.join(line)} |" for line in lines)


def main(arguments: list[str]) -> int:
    """Write the page, or check it; return the exit status."""
    if arguments not in ([], ["--check"]):
        sys.stderr.write(f"{' '.join(arguments)}: expected nothing, or --check\n")
        return 2
    sources = coverage()
    if wrong := faults(sources):
        sys.stderr.write("".join(f"{fault}\n" for fault in wrong))
        return 2
    text = page(sources)
    if not arguments:
        PAGE.write_text(text, encoding="utf-8")
        sys.stdout.write(f"{PAGE}\n")
        return 0
    if PAGE.exists() and PAGE.read_text(encoding="utf-8") == text:
        return 0
    sys.stderr.write(f"{PAGE} is not what the tables say: write it with `make coverage`\n")
    return 3


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
