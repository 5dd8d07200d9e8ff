"""No name of a compiled function stands for two things (`python tools/rebinding_lint.py`).

Compiled code checks neither bounds nor types: an array's name that is bound again to a shape or a number, or a loop
that counts with a name that is still in use, once made a kernel read beyond an array. In each function that numba
compiles, or that is inlined into one, this looks for

- an array, given or made here, that becomes a number, or a number that becomes one; an array that is given and is
  replaced by one made here;
- a loop's variable that is also an argument, an array, or the variable of a loop around it, or bound in the loop;
- tuple targets that bind one name twice.

Exit status 0 if there is none, 1 with one line per finding if there is.
"""

from __future__ import annotations

import ast
import sys
from collections.abc import Iterator
from pathlib import Path

ROOMS = ("kernels", "laws", "dynamics", "interactions")
COMPILED = {"njit", "kernel", "subroutine", "inlined", "register_jitable"}
ARRAYS = {"empty", "zeros", "ones", "full", "empty_like", "zeros_like", "ones_like", "arange"}
SHAPES = {"shape", "size", "ndim"}

Function = ast.FunctionDef
Finding = tuple[int, str]


def findings(source: str) -> list[Finding]:
    """(line, what is wrong) of the compiled functions of a file, in its order."""
    tree = ast.parse(source)
    functions = [node for node in ast.walk(tree) if isinstance(node, Function) and _compiled(node)]
    return sorted({found for function in functions for found in _of_function(function)})


def _compiled(function: Function) -> bool:
    heads = (each.func if isinstance(each, ast.Call) else each for each in function.decorator_list)
    return any(getattr(head, "attr", getattr(head, "id", "")) in COMPILED for head in heads)


def _of_function(function: Function) -> Iterator[Finding]:
    given = function.args
    arguments = {each.arg for each in (*given.posonlyargs, *given.args, *given.kwonlyargs)}
    indexed = {getattr(node.value, "id", "") for node in ast.walk(function) if isinstance(node, ast.Subscript)}
    kinds = dict.fromkeys(arguments & indexed, "an array")
    for node in _own_nodes(function):
        if isinstance(node, ast.Assign):
            for target in node.targets:
                yield from _twice(target)
                for name, value in _pairs(target, node.value):
                    yield from _bound_again(name, value, arguments, kinds)
    yield from _loops(function, arguments | {name for name, kind in kinds.items() if kind == "an array"}, ())


def _own_nodes(function: Function) -> Iterator[ast.AST]:
    """Nodes of a function, in their order, without those of the functions within."""
    waiting: list[ast.AST] = list(reversed(function.body))
    while waiting:
        node = waiting.pop()
        yield node
        if not isinstance(node, Function | ast.Lambda):
            waiting += reversed(list(ast.iter_child_nodes(node)))


def _twice(target: ast.expr) -> Iterator[Finding]:
    names = [node.id for node in ast.walk(target) if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store)]
    for name in {name for name in names if names.count(name) > 1 and name != "_"}:
        yield target.lineno, f"{name} is bound twice at once"


def _pairs(target: ast.expr, value: ast.expr) -> Iterator[tuple[ast.Name, ast.expr]]:
    """Names with what each of them is bound to."""
    if isinstance(target, ast.Name):
        yield target, value
    elif isinstance(target, ast.Tuple) and isinstance(value, ast.Tuple) and len(target.elts) == len(value.elts):
        for pair in zip(target.elts, value.elts, strict=True):
            yield from _pairs(*pair)


def _bound_again(target: ast.Name, value: ast.expr, arguments: set[str], kinds: dict[str, str]) -> Iterator[Finding]:
    name, kind = target.id, _kind(value)
    before = kinds.setdefault(name, kind)
    if {before, kind} == {"an array", "a number"}:
        yield target.lineno, f"{name} is {before}, and then {kind}"
    elif name in arguments and kind == before == "an array":
        yield target.lineno, f"the argument {name} is bound again, to an array of its own"


def _kind(value: ast.expr) -> str:
    """What an expression plainly is: an array, a number, or unknown."""
    if isinstance(value, ast.Constant) and isinstance(value.value, int | float):
        return "a number"
    if isinstance(value, ast.Call):
        name = getattr(value.func, "attr", getattr(value.func, "id", ""))
        return "an array" if name in ARRAYS else "a number" if name in {"len", "float", "int"} else "unknown"
    part = value.value if isinstance(value, ast.Subscript) else value
    return "a number" if isinstance(part, ast.Attribute) and part.attr in SHAPES else "unknown"


def _loops(node: ast.AST, taken: set[str], around: tuple[str, ...]) -> Iterator[Finding]:
    for child in ast.iter_child_nodes(node):
        if isinstance(child, Function | ast.Lambda):
            continue
        if isinstance(child, ast.Name) and isinstance(child.ctx, ast.Store) and child.id in around:
            yield child.lineno, f"{child.id} is bound in the loop that counts with it"
        if isinstance(child, ast.For):
            names = [each.id for each in ast.walk(child.target) if isinstance(each, ast.Name) and each.id != "_"]
            for name in names:
                if name in taken:
                    yield child.lineno, f"the loop counts with {name}, an argument or an array"
                if name in around:
                    yield child.lineno, f"the loop counts with {name}, as a loop around it does"
            body = ast.Module([*child.body, *child.orelse], [])
            yield from _loops(body, taken, (*around, *names))
            continue
        yield from _loops(child, taken, around)


def main() -> int:
    """Print every finding of the package's compiled functions."""
    root = Path(__file__).resolve().parents[1]
    patterns = (
        pattern
        for room in ROOMS
        for pattern in (f"{room}/**/*.py", f"sources/*/{room}.py", f"sources/*/{room}/**/*.py")
    )
    paths = (path for pattern in patterns for path in sorted((root / "flockana").glob(pattern)))
    lines = [f"{path.relative_to(root)}:{line}: {text}" for path in paths for line, text in findings(path.read_text())]
    sys.stdout.write("\n".join(lines or ["no name of a compiled function stands for two things"]) + "\n")
    return 1 if lines else 0


if __name__ == "__main__":
    sys.exit(main())
