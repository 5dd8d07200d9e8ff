"""Write the table of how hypotheses are decided into docs/verdicts.md (`python -m tools.decided_page`).

It collects what the verdicts on the catalogue's short runs say, theorem by theorem: some two minutes.
"""

from __future__ import annotations

import re
import sys
from collections import defaultdict
from pathlib import Path

from flockana.scenarios import scenario, scenarios
from flockana.theorems import theorem
from tools.coverage_page import markdown_table, plain

PAGE = Path(__file__).resolve().parent.parent / "docs" / "verdicts.md"
BEGIN, END = "<!-- decided: begin -->", "<!-- decided: end -->"
_ORDER = ("exact", "proved", "enclosed", "assumed")
_LONGEST = 130  # agents: larger scenarios ask nothing that smaller ones do not


def table() -> str:
    """Return the table: each theorem's hypotheses and by which means they were decided."""
    means: dict[tuple[str, str], set[str]] = defaultdict(set)
    for name in scenarios():
        item = scenario(name)
        if len(item.q0) > _LONGEST:
            continue
        for verdict in item.verify(item.run()):
            for need in verdict.hypotheses:
                means[verdict.theorem, re.sub(r"= [0-9.]+ ", "", need.name)].add(need.decided)
    rows = [
        (f"`{known}`" if known in _known() else known, plain(need), ", ".join(x for x in _ORDER if x in how))
        for (known, need), how in sorted(means.items())
    ]
    return markdown_table(("theorem", "hypothesis", "decided"), rows)


def _known() -> set[str]:
    from flockana.theorems import theorems

    return {name for name in theorems() if theorem(name).kind == "trajectory"}


def main() -> int:
    """Put the table between its marks in the page."""
    text = PAGE.read_text(encoding="utf-8")
    before, after = text.partition(BEGIN)[0], text.partition(END)[2]
    PAGE.write_text(f"{before}{BEGIN}\n{table()}\n{END}{after}", encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
