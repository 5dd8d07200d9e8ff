"""The proofs that back a theorem, with the steps that the machine checked."""

from __future__ import annotations

from typing import Any

from proofs.proof import Proof, proofs
from proofs.run import check
from tools.site.cache import kept

_CODE = ("proofs", "flockana/symbolic", "flockana/certified", "flockana/lattice")


def backing(theorem: str) -> tuple[Proof, ...]:
    """The proofs that name this entry of the catalogue."""
    return tuple(proof for proof in proofs() if theorem in proof.theorems)


def outcome(name: str) -> dict[str, Any]:
    """Status and checked steps of a proof; it runs if its code has changed since it last did."""
    return kept("proofs", name, _CODE, lambda: _checked(name))


def _checked(name: str) -> dict[str, Any]:
    (found,) = check([name])
    return {
        "status": found.status,
        "objections": list(found.objections()),
        "steps": [
            {"text": step.text, "holds": step.holds, "latex": step.latex, "evidence": step.evidence}
            for step in found.steps
        ],
    }
