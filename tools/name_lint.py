"""No variable or function is named by a bare participle or adjective (`python tools/name_lint.py`).

``found``, ``made``, ``kept``, ``own`` and ``least`` say of what they name only that something was done to it, or how it
compares: a noun says what it is. Fields and arguments that users know by such a name stay.

Exit status 0 if there is none, 1 with one line per name if there is.
"""

import ast
import sys
from collections.abc import Iterator
from pathlib import Path

BARE = {"found", "made", "kept", "own", "least"}


def names(path: Path) -> Iterator[str]:
    """Yield each bare name of a file with its place."""
    for function in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if not isinstance(function, ast.FunctionDef):
            continue
        for node in ast.walk(function):
            if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store) and node.id in BARE:
                yield f"{path}:{node.lineno}: {node.id} in {function.name}()"


if __name__ == "__main__":
    findings = [line for path in sorted(Path("flockana").rglob("*.py")) for line in dict.fromkeys(names(path))]
    sys.stdout.write("\n".join(findings or ["every variable is named by a noun"]) + "\n")
    sys.exit(bool(findings))
