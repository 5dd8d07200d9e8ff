"""A page for each theorem and erratum: statement, hypotheses, claims, proofs, scenarios with pictures, references."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from flockana import cite
from flockana.report.catalogues import theorem_entries
from flockana.report.coverage.report_anchors import verdict_id
from flockana.scenarios import scenario
from flockana.theorems import Theorem
from flockana.theorems.catalogue import catalogue
from flockana.theorems.claim import BYLINES
from flockana.theorems.fixed_step_verdicts import scheme_note
from tools.site.lectures import back_links
from tools.site.proofs import backing, outcome
from tools.site.scenarios import checked_on, in_report, thumbnail
from tools.site.verdicts import Verdicts
from tools.site.words import contents, plain, table

_KINDS = {
    "trajectory": "Checked on a run: `flockana verify {id}` runs every scenario it applies to; "
    '`fl.verify("{id}", run)` asks it of a run of yours.',
    "configuration": 'Checked on a configuration: `fl.verify("{id}", q=q, d=d, r=r)`.',
    "fixed": "Decided by itself, without a run: `flockana verify {id}`.",
}


def page(item: Theorem, verdicts: Verdicts, *, images: bool, report: bool) -> str:
    """The page of one."""
    parts = [
        f"# {plain(item.id)}: {plain(item.title)}",
        _index_entry(item),
        f"*{plain(item.source)}*",
        *([] if item.erratum is None else [plain(f"{item.erratum} ({item.erratum.sort})")]),
        "## Statement",
        plain(f"{item.statement} {scheme_note(item)}"),
        _KINDS[item.kind].format(id=item.id),
        "## Hypotheses",
        _hypotheses(item, verdicts),
        "## Claims",
        _claims(item, verdicts),
        "## Proof",
        _proofs(item.id),
        "## Checked on",
        _scenarios(item, verdicts, images=images, report=report),
        "## Lectures",
        back_links(item.id),
        "## References",
        *(f"```bibtex\n{cite(key)}\n```" for key in item.references),
    ]
    return "\n\n".join(parts) + "\n"


def _index_entry(item: Theorem) -> str:
    """Return the entry of the index by which a search for a printed name, such as Theorem 3, finds the page first."""
    printed = re.match(r"(?!ours)[^;(]*, (Theorem \d+)(?!\d|\()", item.source)
    return f"```{{index}} ! {printed[1]}\n```" if printed and item.id[0].islower() else ""


def _hypotheses(item: Theorem, verdicts: Verdicts) -> str:
    """As the proofs state them, and as verdicts found them."""
    parts = [f"- {plain(text)}" for text in dict.fromkeys(proof.hypotheses for proof in backing(item.id)) if text]
    parts = ["\n".join(parts)] if parts else []
    found = verdicts.hypotheses.get(item.id, {})
    if found:
        rows = [(plain(name), _counts(of)) for name, of in found.items()]
        parts.append(table(("what a verdict looks for", "found, in how many verdicts of the catalogue"), rows))
    return "\n\n".join(parts) or "None: it is a statement about formulas or numbers."


def _claims(item: Theorem, verdicts: Verdicts) -> str:
    found = verdicts.claims.get(item.id, {})
    names = tuple(dict.fromkeys((*item.claims, *found)))
    if not names:
        return "One, the statement itself."
    limits = [name for name in names if (item.id, name) in verdicts.limits]
    rows = [
        (
            f"`{name}`{_whose(item, name)}",
            plain(verdicts.stated.get((item.id, name), "")) or "—",
            _counts(found.get(name, Counter())),
        )
        for name in names
    ]
    if not verdicts.status:
        rows = [(name, "as above", "—") for name, *_ in rows]
    stated = "stated" if item.kind == "fixed" else "stated, of the first run"
    text = table(("claim, judged by itself", stated, "found, in how many verdicts of the catalogue"), rows)
    said = ", ".join(f"`{name}`" for name in limits)
    return f"{text}\n\nLimits as t → ∞: {said}. Only a certificate or a proof decides these." if limits else text


def _whose(item: Theorem, claim: str) -> str:
    """Whose a claim is, where it is not the author's of the theorem."""
    return "" if item.by(claim) == item.author else f" ({BYLINES[item.by(claim)]})"


def _counts(of: Mapping[str, int]) -> str:
    return ", ".join(f"{status}: {count}" for status, count in of.items()) or "—"


def _proofs(name: str) -> str:
    parts = []
    for proof in backing(name):
        found = outcome(proof.id)
        parts += [
            f"### {plain(proof.title or proof.id)}",
            f"`proofs/{proof.id.replace('-', '_')}.py`: **{found['status']}**, rigour *{proof.rigour}*, "
            f"{len(found['steps'])} steps. `flockana prove {proof.id}` checks it again.",
            f"{plain(proof.statement)}",
            *(_step(number, step) for number, step in enumerate(found["steps"], 1)),
            *(plain(text) for text in found["objections"]),
        ]
    return "\n\n".join(parts) or "No executable proof in `proofs/` backs it: verdicts rest on computation alone."


def _step(number: int, step: Mapping[str, Any]) -> str:
    mark = {True: "holds", False: "**does not hold**", None: "*unknown*"}[step["holds"]]
    text = f"{number}. {plain(step['text'])} ({mark})"
    return f"{text}\n\n   $$\n   {' '.join(step['latex'].split())}\n   $$" if step["latex"] else text


def _scenarios(item: Theorem, verdicts: Verdicts, *, images: bool, report: bool) -> str:
    rows = []
    if item.kind == "fixed":
        found = verdicts.status.get((item.id, ""), "—")
        found = in_report(verdict_id("fixed", item.id), found) if report else found
        rows.append(("", "by itself", item.expected.get(item.id, "—"), found))
    for name in checked_on(item.id):
        case = scenario(name)
        found = verdicts.status.get((item.id, name), "—")
        rows.append(
            (
                thumbnail(name, folder="../scenarios/images") if images else "",
                f"[{plain(name)}](../scenarios/{name}.md): {plain(case.title)}",
                case.expected.get(item.id, "—"),
                in_report(verdict_id(name, item.id), found) if report else found,
            )
        )
    if not rows:
        return "No scenario of the catalogue asks it."
    end = 4 if verdicts.status else 3
    begin = 0 if images and checked_on(item.id) else 1
    text = table(("at the end", "scenario", "expected", "measured")[begin:end], [row[begin:end] for row in rows])
    return f"{text}\n\nMeasured by {plain(verdicts.written)}." if verdicts.status else text


def write(folder: Path, verdicts: Verdicts, *, images: bool, report: bool) -> None:
    """Write all pages and their index."""
    folder.mkdir(parents=True)
    for item in catalogue().values():
        text = page(item, verdicts, images=images, report=report)
        (folder / f"{item.id}.md").write_text(text, encoding="utf-8")
    (folder / "index.md").write_text(index(), encoding="utf-8")


def index() -> str:
    """The table of all."""
    opening = (
        "# Theorems and errata\n\nA page for each entry of the catalogue, generated from the library: what is printed, "
        "what was proved by machine, and on which runs it is checked. A false printed claim is expected to read "
        "`refuted`. What is printed and what is right, side by side: [errata](../../errata.md)."
    )
    groups: dict[str, list[tuple[str, str, str]]] = {}
    for entry in theorem_entries():
        item = catalogue()[entry["name"]]
        row = (f"[{plain(item.id)}]({item.id}.md)", plain(item.title), item.expected.get(item.id, "on runs"))
        groups.setdefault(entry["source"], []).append(row)
    tables = [f"## {plain(name)}\n\n" + table(("entry", "title", "expected"), rows) for name, rows in groups.items()]
    names = [f"{item.id} <{item.id}>" for item in catalogue().values()]
    listed = contents(names).replace(":maxdepth: 1", ":hidden:")
    return "\n\n".join([opening, *tables, listed]) + "\n"
