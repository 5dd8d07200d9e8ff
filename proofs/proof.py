"""What a proof is: a statement, its hypotheses, and steps that a machine checks; and where proofs are found."""

from __future__ import annotations

import importlib
import pkgutil
import re
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path

RIGOURS = ("symbolic", "smt", "interval")
_DEFINES_PROOF = re.compile(r"^PROOF\b", re.MULTILINE)


@dataclass(frozen=True)
class Step:
    """One checked step: what it says, and whether the check went through; None if the machine could not tell.

    `latex` is the formula that was checked and `evidence` what the machine answered, both for the certificate. `found`
    holds the numbers that it computed and the statement prints.
    """

    text: str
    holds: bool | None
    latex: str = ""
    evidence: str = ""
    found: Mapping[str, str] = field(default_factory=dict)


@dataclass(frozen=True)
class Proof:
    """A theorem with the function that checks its steps, in order: all must hold.

    `rigour` is ``"symbolic"``, ``"smt"`` or ``"interval"``, the weakest of its steps: sampling is no proof. `id` is the
    name of the file, with hyphens. A proof that has other than `size` steps is none: a loop may have run short.
    `values` holds the numbers that the statement and the hypotheses print, by name: a proof is none unless its steps
    found each, the same. `theorems` names the entries of the catalogue that it backs; a run that takes longer
    than `time_limit` seconds, its import aside, is killed, and nothing is proved. `cites` names lemmas of analysis that
    no step checks, such as ``"Barbalat"``.
    """

    id: str
    statement: str
    hypotheses: str
    rigour: str
    steps: Callable[[], Iterator[Step]]
    title: str = ""
    theorems: tuple[str, ...] = ()
    time_limit: float = 120.0
    size: int | None = None
    values: Mapping[str, str] = field(default_factory=dict)
    cites: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        if self.rigour not in RIGOURS:
            raise ValueError(f"rigour = {self.rigour!r}: expected one of {', '.join(RIGOURS)}; sampling is no proof")


def names(package: str = "proofs") -> tuple[str, ...]:
    """Ids of all proofs: the files of a package that define `PROOF`, but for `_template.py`. None is imported."""
    infos = pkgutil.iter_modules(importlib.import_module(package).__path__)
    files = ((info.name, Path(info.module_finder.path, f"{info.name}.py")) for info in infos if info.name[0] != "_")
    found = (name for name, file in files if _DEFINES_PROOF.search(file.read_text(encoding="utf-8")))
    return tuple(sorted(name.replace("_", "-") for name in found))


def load(name: str, package: str = "proofs") -> Proof:
    """The proof of that id."""
    module = importlib.import_module(f"{package}.{name.replace('-', '_')}")
    proof: Proof = module.PROOF
    if proof.id != name:
        raise ValueError(f"{module.__name__} calls its proof {proof.id!r}: expected {name!r}, after the file")
    return proof


def proofs() -> tuple[Proof, ...]:
    """Every proof, by id."""
    return tuple(load(name) for name in names())
