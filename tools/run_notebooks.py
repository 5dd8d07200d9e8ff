"""Execute every lecture with its solutions; a cell that fails, or a check that does not say "right", fails the run.

`python tools/run_notebooks.py [NUMBER...]` runs those whose names begin so; by default all, two at a time.
"""

from __future__ import annotations

import sys
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

from course import notebook, sources, tags
from nbclient import NotebookClient

_TIMEOUT = 600  # seconds for one cell, and for a kernel to start


def shown(cell: Any) -> str:
    """What a cell put out, as text."""
    return "".join(out.get("text", out.get("data", {}).get("text/plain", "")) for out in cell.get("outputs", ()))


def execute(source: Path) -> tuple[Path, list[str], float]:
    """Run one; return its faults and the seconds it took."""
    started, book = time.perf_counter(), notebook(source, "solutions")
    try:
        place = {"metadata": {"path": str(source.parent)}}
        NotebookClient(book, timeout=_TIMEOUT, startup_timeout=_TIMEOUT, resources=place).execute()
        faults = [
            f"a check says {shown(c)!r}:\n{c.source}" for c in book.cells if "check" in tags(c) and "✓" not in shown(c)
        ]
        faults += [f"exercise without a check: {source.name}"] * (not any("check" in tags(c) for c in book.cells))
    except Exception as error:  # a cell that fails or takes too long, a kernel that dies or does not start
        faults = [f"{type(error).__name__}: {error}"]
    return source, faults, time.perf_counter() - started


def main(numbers: list[str]) -> int:
    """Run them; return the exit status."""
    chosen = [path for path in sources() if not numbers or path.name.startswith(tuple(numbers))]
    if not chosen:
        sys.stdout.write("no notebooks found\n")
        return 1
    failed = 0
    with ThreadPoolExecutor(2) as pool:
        for source, faults, seconds in pool.map(execute, chosen):
            failed += bool(faults)
            sys.stdout.write(f"{source.name}: {'FAILED' if faults else 'ok'} ({seconds:.1f} s)\n")
            sys.stdout.writelines(f"{fault}\n" for fault in faults)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
