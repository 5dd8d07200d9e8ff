"""A page for each theorem and erratum: statement, hypotheses, claims, proofs, scenarios, picture, references."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from flockana import cite
from flockana.scenarios import scenario
from flockana.theorems import Theorem
from flockana.theorems.catalogue import catalogue
from tools.site.pictures import checked_on, picture, shown
from tools.site.proofs import backing, outcome
from tools.site.words import contents, plain, table

Measured = Mapping[tuple[str, str], str]
_KINDS = {
    "trajectory": "Checked on a run: `flockana verify {id}` runs every scenario it applies to; "
    '`fl.verify("{id}", run)` asks it of a run of yours.',
    "configuration": 'Checked on a configuration: `fl.verify("{id}", q=q, d=d, r=r)`.',
    "fixed": "Decided by itself, without a run: `flockana verify {id}`.",
}


def measured(file: Path | None) -> Measured:
    """Status by theorem and subject of a report's ``verdicts.json``; a fixed theorem has the subject ''."""
    if file is None:
        return {}
    found = json.loads(file.read_text(encoding="utf-8"))["verdicts"]
    return {(one["theorem"], one.get("subject", "")): f"{one['status']} ({one['rigour']})" for one in found}


def page(item: Theorem, verdicts: Measured, *, image: str | None = None) -> str:
    """The page of one, with the name of its image if there is one."""
    parts = [
        f"# {plain(item.id)}: {plain(item.title)}",
        f"*{plain(item.source)}*",
        "## Statement",
        plain(item.statement),
        _KINDS[item.kind].format(id=item.id),
        "## Hypotheses and claims",
        _claims(item),
        "## Proof",
        _proofs(item.id),
        "## Checked on",
        _scenarios(item, verdicts),
    ]
    if image is not None:
        parts += ["## A picture", image]
    parts += ["## References", *(f"```bibtex\n{cite(key)}\n```" for key in item.references)]
    return "\n\n".join(parts) + "\n"


def _claims(item: Theorem) -> str:
    given = [f"- {plain(text)}" for text in _hypotheses(item)]
    text = "\n".join(given) if given else "A verdict lists the hypotheses that it found met, unmet or assumed."
    if not item.claims:
        return text
    limits = [name for name in item.claims if name in item.limits]
    named = ", ".join(f"`{name}`" for name in item.claims)
    more = f" Of limits speak {', '.join(f'`{name}`' for name in limits)}: a run that is too short decides nothing."
    return f"{text}\n\nClaims, judged one by one: {named}.{more if limits else ''}"


def _hypotheses(item: Theorem) -> tuple[str, ...]:
    """As the proofs state them; what a verdict asks of a run stands in the verdict."""
    return tuple(dict.fromkeys(proof.hypotheses for proof in backing(item.id)))


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


def _scenarios(item: Theorem, verdicts: Measured) -> str:
    rows = []
    if item.kind == "fixed":
        rows.append(("by itself", item.expected.get(item.id, "—"), verdicts.get((item.id, ""), "—")))
    for name in checked_on(item.id):
        case = scenario(name)
        rows.append(
            (f"`{name}`: {plain(case.title)}", case.expected.get(item.id, "—"), verdicts.get((item.id, name), "—"))
        )
    if not rows:
        return "No scenario of the catalogue asks it."
    header = ("scenario", "expected", "measured")
    return table(header if verdicts else header[:2], rows if verdicts else [row[:2] for row in rows])


def write(folder: Path, verdicts: Measured, *, images: bool = True) -> None:
    """Write all pages, their images if asked for, and their index."""
    (folder / "images").mkdir(parents=True, exist_ok=True)
    for item in catalogue().values():
        image, case = None, shown(item.id) if images else None
        if case is not None:
            caption, data = picture(case)
            (folder / "images" / f"{case}.png").write_bytes(data)
            image = f"![Scenario {case}: {scenario(case).title}](images/{case}.png)\n\n`{case}`. {plain(caption)}"
        (folder / f"{item.id}.md").write_text(page(item, verdicts, image=image), encoding="utf-8")
    (folder / "index.md").write_text(index(), encoding="utf-8")


def index() -> str:
    """The table of all."""
    opening = (
        "# Theorems and errata\n\nA page for each entry of the catalogue, generated from the library: what is printed, "
        "what was proved by machine, and on which runs it is checked. A false printed claim is expected to read "
        "`refuted`."
    )
    rows = [
        (f"[{plain(item.id)}]({item.id}.md)", plain(item.title), item.expected.get(item.id, "on runs"))
        for item in catalogue().values()
    ]
    names = [f"{item.id} <{item.id}>" for item in catalogue().values()]
    listed = contents(names).replace(":maxdepth: 1", ":hidden:")
    return f"{opening}\n\n{table(('entry', 'title', 'expected'), rows)}\n\n{listed}\n"
