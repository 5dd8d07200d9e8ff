"""Write docs/errata.md and the errata of README.md from the table of errata (`python -m tools.errata_page`).

`--check` writes nothing, and ends with 3 if one of the two is not what the table says.
"""

from __future__ import annotations

import sys
from collections.abc import Iterable
from pathlib import Path

from flockana.theorems.errata import FOREWORD, SORTS, Erratum, errata
from tools.coverage_page import markdown_table, plain

ROOT = Path(__file__).resolve().parent.parent
PAGE, README = ROOT / "docs" / "errata.md", ROOT / "README.md"
_BEGIN, _END = "<!-- errata: written by `make coverage` -->", "<!-- end of the errata -->"
_SIGNS = "✗ is refuted, ✓ verified, by the claim of `flockana verify ID`; · was read and not computed."


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


def readme(items: Iterable[Erratum], text: str) -> str:
    """Return the text of a README with its errata: those of slides and projects, and how many others there are."""
    items = tuple(items)
    before, _, rest = text.partition(_BEGIN)
    _, _, after = rest.partition(_END)
    own = [item for item in items if item.id[0] == "E"]
    counts = ", ".join(f"{sum(item.sort == sort for item in items)} {sort} ({SORTS[sort]})" for sort in SORTS)
    rows = [(item.id, plain(item.printer), *_cells(item)[2:4], item.sort) for item in own]
    table = markdown_table(("", "printed by", "printed", "right", "sort"), rows)
    told = f"{FOREWORD}\n\n{table}\n\n{_SIGNS} All {len(items)}, with their places: [errata](docs/errata.md): {counts}."
    return f"{before}{_BEGIN}\n\n{told}\n\n{_END}{after}"


def main(arguments: list[str]) -> int:
    """Write both, or check them; return the exit status."""
    if arguments not in ([], ["--check"]):
        sys.stderr.write(f"{' '.join(arguments)}: expected nothing, or --check\n")
        return 2
    texts = {PAGE: page(errata()), README: readme(errata(), README.read_text(encoding="utf-8"))}
    for path, text in texts.items():
        if not arguments:
            path.write_text(text, encoding="utf-8")
        elif not path.exists() or path.read_text(encoding="utf-8") != text:
            sys.stderr.write(f"{path} is not what the table of errata says: write it with `make coverage`\n")
            return 3
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
