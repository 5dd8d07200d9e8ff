"""What a proof is: a statement, its hypotheses, and steps that a machine checks."""

from __future__ import annotations

import importlib
import pkgutil
from collections.abc import Callable, Iterator
from dataclasses import dataclass


@dataclass(frozen=True)
class Step:
    """One checked step: what it says, and whether the check went through; None if the machine could not tell.

    `latex` is the formula that was checked and `evidence` what the machine answered, both for the certificate.
    """

    text: str
    holds: bool | None
    latex: str = ""
    evidence: str = ""


@dataclass(frozen=True)
class Proof:
    """A theorem with the function that checks its steps, in order; one that fails ends the proof.

    `rigour` is ``"symbolic"``, ``"smt"`` or ``"interval"``: sampling is no proof.
    """

    id: str
    statement: str
    hypotheses: str
    rigour: str
    steps: Callable[[], Iterator[Step]]


def proofs() -> tuple[Proof, ...]:
    """Every `PROOF` of a file of this package, by id."""
    package = importlib.import_module("proofs")
    modules = (importlib.import_module(f"proofs.{info.name}") for info in pkgutil.iter_modules(package.__path__))
    found = (getattr(module, "PROOF", None) for module in modules if not module.__name__.endswith("__main__"))
    return tuple(sorted((one for one in found if isinstance(one, Proof)), key=lambda one: one.id))
