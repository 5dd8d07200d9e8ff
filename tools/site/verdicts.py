"""Measured verdicts, from a report: one that is there, or one that is made."""

from __future__ import annotations

import json
import subprocess
import sys
from collections import Counter
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from tools.site.cache import CACHE, ROOT, digest


@dataclass(frozen=True)
class Verdicts:
    """What a report found.

    Parameters
    ----------
    status : dict
        Status and rigour by theorem and subject; a fixed theorem has the subject ''.
    hypotheses, claims : dict
        By theorem: how often which status was found, by name of the hypothesis or claim.
    stated : dict
        By theorem and claim, what the source states.
    limits : set
        Theorem and name of each claim about t → ∞.
    written : str
        When, by which version.
    """

    status: dict[tuple[str, str], str] = field(default_factory=dict)
    hypotheses: dict[str, dict[str, Counter[str]]] = field(default_factory=dict)
    claims: dict[str, dict[str, Counter[str]]] = field(default_factory=dict)
    stated: dict[tuple[str, str], str] = field(default_factory=dict)
    limits: set[tuple[str, str]] = field(default_factory=set)
    written: str = ""


def measured(file: Path | None) -> Verdicts:
    """The verdicts of a report's ``verdicts.json``; of no file, none."""
    if file is None:
        return Verdicts()
    data = json.loads(file.read_text(encoding="utf-8"))
    found = Verdicts(written=f"flockana {data.get('flockana', '?')}, {data.get('written', '?')}")
    for one in data["verdicts"]:
        theorem = one["theorem"]
        found.status[theorem, one.get("subject", "")] = f"{one['status']} ({one['rigour']})"
        for kind, entries in ((found.hypotheses, one.get("hypotheses", ())), (found.claims, one.get("claims", ()))):
            names = kind.setdefault(theorem, {})
            for entry in entries:
                names.setdefault(entry["name"], Counter())[entry["status"]] += 1
        for claim in one.get("claims", ()):
            found.stated.setdefault((theorem, claim["name"]), _words(claim.get("stated")))
            if claim.get("about") == "limit":
                found.limits.add((theorem, claim["name"]))
    return found


def _words(value: Any) -> str:
    text = "" if value is None else value if isinstance(value, str) else json.dumps(value, ensure_ascii=False)
    return text if len(text) <= 160 else f"{text[:159]}…"


def report() -> Path:
    """The folder of a report on the whole catalogue: that of `make verify`, else one made here and kept."""
    made = ROOT / "report"
    if _whole(made):
        return made
    folder = CACHE / f"report-{digest(('flockana',))}"
    if not _whole(folder):
        command = [sys.executable, "-m", "flockana", "verify", "--output", str(folder), "--seeds", "0"]
        if subprocess.call(command, stdout=subprocess.DEVNULL) not in (0, 3):  # 3: a verdict differs; its page says so
            raise SystemExit("flockana verify failed: run it by itself to see why")
    return folder


def _whole(folder: Path) -> bool:
    try:
        data = json.loads((folder / "verdicts.json").read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return False
    return bool(data.get("complete")) and data.get("of") is None
