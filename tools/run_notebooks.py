"""Execute every notebook of notebooks/ from its py:percent source; a failing cell fails the run."""

from __future__ import annotations

import sys
import time
from pathlib import Path

import jupytext
from nbclient import NotebookClient
from nbclient.exceptions import CellExecutionError

ROOT = Path(__file__).resolve().parent.parent


def main() -> int:
    """Run them all, in order; return the exit status."""
    sources = sorted((ROOT / "notebooks").glob("*.py"))
    if not sources:
        sys.stdout.write("no notebooks found\n")
        return 1
    failed = 0
    for source in sources:
        started = time.perf_counter()
        notebook = jupytext.read(source)
        notebook.metadata["kernelspec"] = {"name": "python3", "language": "python", "display_name": "Python 3"}
        try:
            NotebookClient(notebook, timeout=300, resources={"metadata": {"path": str(source.parent)}}).execute()
            outcome = "ok"
        except CellExecutionError as error:
            failed += 1
            outcome = f"FAILED\n{error}"
        sys.stdout.write(f"{source.name}: {outcome} ({time.perf_counter() - started:.1f} s)\n")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
