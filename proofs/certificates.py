"""Certificates: what was proved, step by step, as Markdown with LaTeX for people and as JSON for programs."""

from __future__ import annotations

import json
import platform
from collections.abc import Iterable
from dataclasses import asdict
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any

from flockana.base.files import atomic_write
from proofs.run import Outcome

SCHEMA = 1
_HOLDS = {True: "holds", False: "**does not hold**", None: "**unknown**"}


def versions() -> dict[str, str]:
    """What the machine that checked consisted of."""
    found = {"python": platform.python_version()}
    for name in ("flockana", "sympy", "python-flint", "z3-solver"):
        try:
            found[name] = version(name)
        except PackageNotFoundError:
            found[name] = "not installed"
    return found


def as_data(outcome: Outcome) -> dict[str, Any]:
    """A certificate as plain data."""
    data = asdict(outcome)
    del data["size"]  # that of its steps
    return {"schema": SCHEMA, "status": outcome.status} | data | {"versions": versions()}


def as_markdown(outcome: Outcome) -> str:
    """A certificate to read."""
    lines = [
        f"# {outcome.title or outcome.id}",
        "",
        f"**{_verdict(outcome)}** · proof `{outcome.id}` · {outcome.rigour or 'rigour unknown'} · "
        f"{len(outcome.steps)} steps · {outcome.seconds:.1f} s",
        "",
    ]
    if outcome.statement:  # it is not known if the proof could not be imported
        lines += [f"**Statement.** {_text(outcome.statement)}", "", f"**Given.** {_text(outcome.hypotheses)}", ""]
    if outcome.theorems:
        lines += [f"**Backs** {', '.join(outcome.theorems)} of `flockana theorems`.", ""]
    lines += [f"- {_text(objection)}" for objection in outcome.objections()] + [""] * (outcome.status != "proved")
    lines += ["## Steps", ""]
    for number, step in enumerate(outcome.steps, start=1):
        evidence = f" *{_text(step.evidence)}*" if step.evidence else ""
        lines.append(f"{number}. {_text(step.text)}: {_HOLDS[step.holds]}.{evidence}")
        lines += ["", "   $$", *(f"   {line}" for line in step.latex.splitlines()), "   $$"] if step.latex else []
        lines.append("")
    checked = ", ".join(f"{name} {number}" for name, number in versions().items())
    return "\n".join([*lines, f"Checked with {checked}.", ""])


def _text(text: str) -> str:
    """Words with signs that Markdown would take for its own."""
    return text.translate({ord(sign): f"\\{sign}" for sign in "\\*<|`"})


def _verdict(outcome: Outcome) -> str:
    return {"proved": "Proved", "failed": "FAILED", "unknown": "Unknown"}[outcome.status]


def write(outcome: Outcome, folder: Path) -> None:
    """Write a proof's two files: `<id>.md` and `<id>.json`."""
    text = json.dumps(as_data(outcome), indent=1, ensure_ascii=False)
    _write(folder / f"{outcome.id}.json", text + "\n")
    _write(folder / f"{outcome.id}.md", as_markdown(outcome))


def write_index(outcomes: Iterable[Outcome], folder: Path) -> None:
    """Write `index.md`, a row for each proof of this run."""
    rows = [
        f"| [{one.title or one.id}]({one.id}.md) | {_text(one.statement)} | {one.rigour} | "
        f"{len(one.steps)} | {_verdict(one)} | {one.seconds:.1f} s |"
        for one in outcomes
    ]
    head = ["# Certificates", "", "| theorem | what exactly is proved | rigour | steps | status | time |"]
    _write(folder / "index.md", "\n".join([*head, "|---|---|---|---|---|---|", *rows, ""]))


def _write(path: Path, text: str) -> None:
    with atomic_write(path, remedy="choose another folder") as partial:
        partial.write_text(text, encoding="utf-8")
