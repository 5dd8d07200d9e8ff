"""The table of a run: per package what was killed, what survived, and how sure that is."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence

from .mutants import Mutant
from .trial import Result

_HEAD = "| package | mutants | tried | killed | of these timeouts | equivalent | survived | killed, 95 % interval |\n"


def interval(killed: int, tried: int) -> str:
    """The share killed of the mutants that compute something else, by Clopper and Pearson.

    >>> interval(60, 60)
    '94.0-100.0 %'
    """
    from flockana.base.binomial import clopper_pearson

    low, high = clopper_pearson(killed, tried)
    return f"{100.0 * low:.1f}-{100.0 * high:.1f} %"


def table(
    counts: Mapping[str, int],
    drawn: Sequence[Mutant],
    results: Mapping[str, Result],
    reviewed: Mapping[tuple[str, str, str], str],
) -> tuple[str, list[Mutant]]:
    """The table in Markdown with the survivors below it, and the survivors.

    Parameters
    ----------
    counts : mapping
        Mutants of each package, drawn or not.
    drawn : sequence of Mutant
        The sample.
    results : mapping
        By key; what is not in it has not been tried.
    reviewed : mapping
        Reasons why a mutant is equivalent, by path and lines.
    """
    text = _HEAD + "|" + " --- |" * 8 + "\n"
    survivors, total = list[Mutant](), Counter[str]()
    for package, mutants in counts.items():
        kinds = Counter[str]()
        for one in drawn:
            if one.package == package:
                same = (one.path, one.before, one.after) in reviewed
                kind = "equivalent" if same else results[one.key].outcome if one.key in results else "open"
                kinds[kind] += 1
                if kind in ("survived", "spent"):
                    survivors.append(one)
        text += _row(package, mutants, kinds)
        total += kinds
    text += _row("all", sum(counts.values()), total)
    for one in survivors:
        result = results[one.key]
        asked = f"{result.files} test files, {result.seconds:.0f} s"
        text += f"\n{one.path}:{one.line} {one.operator} ({asked})\n    - {one.before}\n    + {one.after}\n"
    return text, survivors


def _row(package: str, mutants: int, kinds: Counter[str]) -> str:
    killed, survived = kinds["killed"] + kinds["timeout"], kinds["survived"] + kinds["spent"]
    tried = killed + survived + kinds["equivalent"]
    cells = (package, mutants, tried, killed, kinds["timeout"], kinds["equivalent"], survived)
    return "| " + " | ".join(map(str, cells)) + f" | {interval(killed, killed + survived)} |\n"
