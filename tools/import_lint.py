"""Hold the import direction: each stage of the package may import earlier stages only (`python tools/import_lint.py`).

Exit status 0 if it holds, 1 with one line per violation if it does not.
"""

from __future__ import annotations

import ast
import sys
from pathlib import Path

PACKAGE = "flockana"

# Earlier lines may not import later ones; names on one line may not import each other, unless they are the same name.
STAGES: tuple[tuple[str, ...], ...] = (
    ("_version",),
    ("base",),
    ("jit",),
    ("symbolic", "kernels"),
    ("interactions",),
    ("environment",),
    ("measures",),
    ("lattice",),
    ("laws",),
    ("dynamics",),
    ("recorded",),
    ("lammps",),
    ("equilibria",),
    ("stability",),
    ("certified",),
    ("theorems",),
    ("scenarios",),
    ("ensemble",),
    ("falsify",),
    ("player",),
    ("plots",),
    ("report",),
    ("explore",),
    ("course",),
    ("cli",),
)
STAGE = {name: k for k, names in enumerate(STAGES) for name in names}


def imports(path: Path) -> list[tuple[int, str]]:
    """(line, module) of every import of the package in a file, except those for type checking only."""
    tree = ast.parse(path.read_text())
    typing_only = {
        id(inner)
        for node in ast.walk(tree)
        if isinstance(node, ast.If) and getattr(node.test, "id", "") == "TYPE_CHECKING"
        for inner in ast.walk(node)
    }
    found = []
    for node in ast.walk(tree):
        if id(node) in typing_only:
            continue
        if isinstance(node, ast.Import):
            found += [(node.lineno, alias.name) for alias in node.names]
        elif isinstance(node, ast.ImportFrom) and node.module:
            names = [f"{node.module}.{alias.name}" for alias in node.names] if node.module == PACKAGE else [node.module]
            found += [(node.lineno, name) for name in names]
    return [(line, name) for line, name in found if name.startswith(f"{PACKAGE}.")]


def stage_name(module: str) -> str:
    """The part of the package that a dotted module belongs to."""
    return module.split(".")[1]


def main(root: Path) -> int:
    """Check every file of the package under `root`; return the exit status."""
    faults = []
    for path in sorted((root / PACKAGE).rglob("*.py")):
        own = path.relative_to(root / PACKAGE).parts[0].removesuffix(".py")
        if own in ("__init__", "__main__"):
            continue
        if own not in STAGE:
            faults.append(f"{path}: {own} has no stage; give it one in tools/import_lint.py")
            continue
        for line, module in imports(path):
            other = stage_name(module)
            if other != own and STAGE.get(other, len(STAGES)) >= STAGE[own]:
                faults.append(f"{path}:{line}: {own} imports {module}, which does not come before it")
    sys.stdout.write("".join(f"{fault}\n" for fault in faults) or "imports point down\n")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main(Path(__file__).resolve().parent.parent))
