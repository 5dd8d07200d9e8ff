"""Hold the import direction: each stage of the package may import earlier stages only (`python tools/import_lint.py`).

No room of the package imports a source. In a source, a part of a kind (``laws.py``, ``theorems/``) stands at the stage
of the room of that kind; it imports other parts of its source that do not come later, and of other sources the public
names alone, ``from flockana.sources.SOURCE import NAME``, and in no circle. No modules import each other in a circle,
also not for type checking.

Exit status 0 if it holds, 1 with one line per violation if it does not.
"""

from __future__ import annotations

import ast
import sys
from collections.abc import Iterator
from graphlib import CycleError, TopologicalSorter
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
    ("solvers",),
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
KINDS = {"scene": "player", "figures": "report"}  # parts of a source whose name is not that of their room


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
            whole = node.module == PACKAGE or node.module.startswith(f"{PACKAGE}.sources.")
            names = [f"{node.module}.{alias.name}" for alias in node.names] if whole else [node.module]
            found += [(node.lineno, name) for name in names]
    return [(line, name) for line, name in found if name.startswith(f"{PACKAGE}.")]


def place(parts: tuple[str, ...]) -> tuple[str, str]:
    """Return (source, room) of a dotted name within the package; no source in a room of the package itself."""
    if parts[0] != "sources":
        return "", parts[0]
    source, kind = (*parts[1:3], "", "")[:2]
    return source, KINDS.get(kind, kind)


def public_names(path: Path, source: str) -> set[str]:
    """Return the names in the stub of a source beside that of a file."""
    stub = next(folder for folder in path.parents if folder.name == "sources") / source / "__init__.pyi"
    nodes = ast.parse(stub.read_text()).body if stub.exists() else []
    return {alias.asname or alias.name for node in nodes if isinstance(node, ast.ImportFrom) for alias in node.names}


def faults_of(path: Path, parts: tuple[str, ...], uses: dict[str, set[str]]) -> Iterator[tuple[int, str]]:
    """Yield (line, what is wrong) of a file's imports; note which sources its source uses."""
    source, room = place(parts)
    if path.stem in ("__init__", "__main__") and len(parts) < 4 and (len(parts) == 1 or parts[0] == "sources"):
        return
    if room not in STAGE:
        yield 1, f"{room} has no stage; give it one in tools/import_lint.py"
        return
    for line, module in imports(path):
        other, its_room = place(tuple(module.split(".")[1:]))
        if other and other != source:
            if not source:
                yield line, f"{room} imports {module}: only sources know sources; ask for a part of a kind"
            elif len(module.split(".")) > 4 or module.rpartition(".")[2] not in public_names(path, other):
                yield line, f"imports {module}: expected a public name, from {PACKAGE}.sources.{other} import ..."
            uses.setdefault(source, set()).add(other)
        elif (its_room != room or other != source) and STAGE.get(its_room, len(STAGES)) > STAGE[room] - (not source):
            yield line, f"{room} imports {module}, which does not come before it"


def circle(root: Path) -> list[str]:
    """Return modules that import each other in a circle, for type checking too; none if there is none."""
    named_paths = ((path.relative_to(root).with_suffix("").parts, path) for path in (root / PACKAGE).rglob("*.py"))
    paths = {".".join(parts): path for parts, path in named_paths}
    graph = dict[str, set[str]]()
    for name, path in paths.items():
        tree = ast.walk(ast.parse(path.read_text()))
        froms = [node for node in tree if isinstance(node, ast.ImportFrom) and node.module and not node.level]
        named = {
            f"{node.module}.{alias.name}" if f"{node.module}.{alias.name}" in paths else node.module
            for node in froms
            for alias in node.names
        }
        graph[name] = {str(one) for one in named} & paths.keys() - {name}
    try:
        TopologicalSorter(graph).prepare()
    except CycleError as error:
        return list(error.args[1])
    return []


def main(root: Path) -> int:
    """Check every file of the package under `root`; return the exit status."""
    faults, uses = [], dict[str, set[str]]()
    for path in sorted((root / PACKAGE).rglob("*.py")):
        parts = path.relative_to(root / PACKAGE).with_suffix("").parts
        faults += [f"{path}:{line}: {fault}" for line, fault in faults_of(path, parts, uses)]
    if modules := circle(root):
        faults.append(f"modules import each other in a circle: {', '.join(modules)}")
    try:
        TopologicalSorter(uses).prepare()
    except CycleError as error:
        faults.append(f"sources use each other in a circle: {', '.join(error.args[1])}")
    sys.stdout.write("".join(f"{fault}\n" for fault in faults) or "imports point down\n")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main(Path(__file__).resolve().parent.parent))
