"""Write docs/errata.md from the table of errata (`python -m tools.errata_page`).

`--check` writes nothing, and ends with 3 if the page is not what the table says.
"""

from __future__ import annotations

import sys
from collections.abc import Iterable
from pathlib import Path

from flockana.theorems.errata import FOREWORD, SORTS, Erratum, errata
from tools.coverage_page import markdown_table, plain

ROOT = Path(__file__).resolve().parent.parent
PAGE = ROOT / "docs" / "errata.md"
_SIGNS = "✗: refuted, ✓: verified, by `flockana verify ID`; ·: read, not computed."


def page(items: Iterable[Erratum]) -> str:
    """Return the page as Markdown, one table for each sort."""
    items = tuple(items)
    parts = ["# Errata", f"{FOREWORD} {_SIGNS}"]
    for sort, meaning in SORTS.items():
        rows = [_cells(item) for item in items if item.sort == sort]
        parts += [f"## {sort.capitalize()}: {meaning}", markdown_table(_HEADER, rows)]
    return "\n\n".join(parts) + "\n"


_HEADER = ("", "printed by, where", "printed", "right", "in the paper?")


def _cells(item: Erratum) -> tuple[str, ...]:
    return (
        item.id,
        plain(f"{item.printer}, {item.where}"),
        f"{item.mark} {plain(item.printed)}",
        f"{item.right_mark} {plain(item.right)}",
        item.in_paper,
    )


def main(arguments: list[str]) -> int:
    """Write the page, or check it; return the exit status."""
    if arguments not in ([], ["--check"]):
        sys.stderr.write(f"{' '.join(arguments)}: expected nothing, or --check\n")
        return 2
    texts = {PAGE: page(errata())}
    for path, text in texts.items():
        if not arguments:
            path.write_text(text, encoding="utf-8")
        elif not path.exists() or path.read_text(encoding="utf-8") != text:
            sys.stderr.write(f"{path} is not what the table of errata says: write it with `make coverage`\n")
            return 3
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
