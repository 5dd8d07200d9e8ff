"""The proofs that back a theorem, with the steps that the machine checked."""

from __future__ import annotations

import json
import os
from functools import cache
from typing import Any

from flockana.base.progress import progress_bar
from proofs.proof import Proof, proofs
from proofs.run import Outcome, check
from tools.site.cache import place, write

_CODE = ("proofs", "flockana/symbolic", "flockana/certified", "flockana/lattice")


def backing(theorem: str) -> tuple[Proof, ...]:
    """The proofs that name this entry of the catalogue."""
    return tuple(proof for proof in proofs() if theorem in proof.theorems)


def outcome(name: str) -> dict[str, Any]:
    """Status and checked steps of a proof."""
    return outcomes()[name]


@cache
def outcomes() -> dict[str, dict[str, Any]]:
    """Those of all proofs; they run, on all cores, whose code has changed since they were last proved."""
    files = {proof.id: place("proofs", proof.id, _CODE) for proof in proofs()}
    found = {name: json.loads(file.read_text(encoding="utf-8")) for name, file in files.items() if file.exists()}
    missing = [name for name in files if name not in found]
    with progress_bar(len(missing)) as advance:
        for each in check(missing, jobs=os.cpu_count() or 1):
            found[each.id] = plain_data(each)
            if each.status == "proved":  # what failed for want of time may succeed in the next build
                write(files[each.id], found[each.id])
            advance(sum(name in found for name in missing), f"{each.id}: {each.status}")
    return found


def plain_data(found: Outcome) -> dict[str, Any]:
    """What a page says of a proof."""
    return {
        "status": found.status,
        "objections": list(found.objections()),
        "steps": [
            {"text": step.text, "holds": step.holds, "latex": step.latex, "evidence": step.evidence}
            for step in found.steps
        ],
    }
