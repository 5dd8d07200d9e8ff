"""The mutants of the package: every small change that cosmic-ray's operators can make, less those that mean nothing.

Left out are changes

- that cannot compile, or only change a type: shifts and bits of numbers, `is` for `==`, operators in annotations;
- of `strict=` in `zip`, which asserts what the lines before it have made so;
- inside of `raise`, `assert` and f-strings (texts), of `__all__`, of `if TYPE_CHECKING:`, of ``__repr__``;
- of decorators that say how to compile (`njit`, `register_jitable`, `vectorize` and their options), or nothing at run
  time (`override`, `abstractmethod`, `overload`).

cosmic-ray does not touch strings, so docstrings stay. A mutant is known by its file and by the lines before and after,
not by line numbers: edits elsewhere change neither the sample nor what has been said of a survivor.
"""

from __future__ import annotations

import hashlib
import re
from collections import Counter, defaultdict
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from difflib import ndiff
from functools import cache
from pathlib import Path
from typing import Any

import parso.python.tree  # noqa: F401  before cosmic_ray, which cannot import it first
from cosmic_ray import plugins
from cosmic_ray.ast import ast_nodes, get_ast
from cosmic_ray.mutating import mutate_code

PACKAGES = ("kernels", "symbolic", "measures", "lattice", "laws", "interactions", "theorems", "certified")
_ARITHMETIC = "(Add|Sub|Mul|Div|FloorDiv|Mod|Pow)"
_ORDER = "(Eq|NotEq|Lt|LtE|Gt|GtE)"
_KINDS = re.compile(
    rf"core/(ReplaceBinaryOperator_({_ARITHMETIC}_{_ARITHMETIC}|BitOr_BitAnd|BitAnd_BitOr)"
    rf"|ReplaceComparisonOperator_({_ORDER}_{_ORDER}|Is_IsNot|IsNot_Is)"
    "|ReplaceUnaryOperator_(USub_UAdd|Delete_Invert|Delete_Not)"
    "|AddNot|ReplaceTrueWithFalse|ReplaceFalseWithTrue|ReplaceAndWithOr|ReplaceOrWithAnd|ReplaceBreakWithContinue"
    "|ReplaceContinueWithBreak|ExceptionReplacer|NumberReplacer|RemoveDecorator|ZeroIterationForLoop)"
)
_COMPILING = re.compile(
    r"\s*@\s*(?:\w+\.)*(njit|register_jitable|vectorize|lift\w*|override|abstractmethod|overload|(?:lru_)?cache)\b"
)
_TEXTS = ("raise_stmt", "assert_stmt", "fstring", "tfpdef")


@dataclass(frozen=True)
class Mutant:
    """A change: the ``occurrence``-th that an operator makes in a file, ``number``-th of those that look alike."""

    path: str
    operator: str
    occurrence: int
    line: int
    before: str
    after: str
    number: int = 0

    @property
    def package(self) -> str:
        """Its room of flockana."""
        return Path(self.path).parts[1]

    @property
    def key(self) -> str:
        """Its name: the same wherever the lines stand."""
        said = "\n".join((self.path, self.before, self.after, str(self.number)))
        return hashlib.sha256(said.encode()).hexdigest()[:16]

    def source(self, root: Path) -> str:
        """The file with the change."""
        return str(mutate_code((root / self.path).read_text("utf-8"), _operators()[self.operator], self.occurrence))


@cache
def _operators() -> dict[str, Any]:
    names = [name for name in plugins.operator_names() if _KINDS.fullmatch(name)]
    return {name.removeprefix("core/"): plugins.get_operator(name)() for name in names}


def _means_nothing(node: Any) -> bool:
    """Whether a change at a node is a text, a type, a way to compile, or of what is kept for the next time."""
    below, above = None, node
    while above is not None:
        kind = above.type
        if kind in _TEXTS or (kind == "annassign" and below is above.children[1]):
            return True
        if kind == "decorator" and _COMPILING.match(above.get_code(include_prefix=False)):
            return True
        if kind == "funcdef" and (below is above.annotation or above.name.value == "__repr__"):
            return True
        if kind == "parameters" and below is not None and below.type == "operator":
            return True  # the star before those that go by name
        if kind == "if_stmt" and above.children[1].get_code().strip() == "TYPE_CHECKING":
            return True
        if kind == "expr_stmt" and above.children[0].get_code().strip() in ("__all__", "__slots__"):
            return True
        if kind == "argument" and above.children[0].get_code().strip() == "strict":
            return True
        below, above = above, above.parent
    return False


def _places(text: str) -> Iterator[tuple[str, int, int]]:
    """Operator, occurrence and line of every change of a source that means something."""
    counts: Counter[str] = Counter()
    for node in ast_nodes(get_ast(text)):
        found = [
            (name, place[0][0])
            for name, operator in _operators().items()
            for place in operator.mutation_positions(node)
        ]
        sound = bool(found) and not _means_nothing(node)
        for name, line in found:
            if sound:
                yield name, counts[name], line
            counts[name] += 1


def _lines(before: str, after: str) -> tuple[str, str]:
    """The lines that differ, without indentation, those of one side joined."""
    said = [line for line in ndiff(before.splitlines(), after.splitlines()) if line[:2] in ("- ", "+ ")]
    return tuple(" ".join(line[2:].strip() for line in said if line[0] == sign) for sign in "-+")  # type: ignore[return-value]


def files(root: Path, packages: Iterable[str] = PACKAGES) -> list[str]:
    """The sources of some packages, relative to the project."""
    found = (path for name in packages for path in (root / "flockana" / name).rglob("*.py"))
    return sorted(str(path.relative_to(root)) for path in found)


def rank(path: str, operator: str, line: str, occurrence: int, salt: str) -> str:
    """The place of a mutant in the order in which samples are drawn: the same on every machine, whatever is edited."""
    return hashlib.sha256("\n".join((salt, path, operator, line, str(occurrence))).encode()).hexdigest()


def count_and_draw(root: Path, paths: Iterable[str], size: int | None, salt: str) -> tuple[Counter[str], list[Mutant]]:
    """How many mutants each package has, and the first of each in the order of ranks.

    Parameters
    ----------
    root : Path
        The project.
    paths : iterable of str
        Files.
    size : int or None
        How many of each package; all of them without.
    salt : str
        Another one draws another sample. A larger sample holds the smaller ones.
    """
    counts, ranked = Counter[str](), defaultdict[str, list[tuple[str, str, str, int, int]]](list)
    for path in paths:
        text = (root / path).read_text("utf-8")
        lines, same = text.splitlines(), Counter[tuple[str, str]]()
        for operator, occurrence, line in _places(text):
            said = operator, lines[line - 1].strip()
            place = rank(path, *said, same[said], salt)
            same[said] += 1
            ranked[Path(path).parts[1]].append((place, path, operator, occurrence, line))
    drawn = list[Mutant]()
    for package, found in ranked.items():
        counts[package] = len(found)
        drawn += _compiled(root, sorted(found), size)
    return counts, drawn


def _compiled(root: Path, found: list[tuple[str, str, str, int, int]], size: int | None) -> list[Mutant]:
    """The first of a package that compile and change something."""
    drawn, same = list[Mutant](), Counter[tuple[str, str, str]]()
    for _, path, operator, occurrence, line in found:
        if len(drawn) == size:
            break
        text = (root / path).read_text("utf-8")
        try:
            changed = mutate_code(text, _operators()[operator], occurrence)
        except AttributeError:  # cosmic-ray knows no dotted name after `except`
            continue
        before, after = _lines(text, changed or text)
        try:
            compile(changed or "", path, "exec")
        except SyntaxError:
            continue
        if before == after:
            continue
        number = same[path, before, after]
        same[path, before, after] += 1
        drawn.append(Mutant(path, operator, occurrence, line, before, after, number))
    return drawn
