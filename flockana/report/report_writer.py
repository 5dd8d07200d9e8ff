"""Writer of the report: one HTML page without network access, and the verdicts as JSON."""

import json
import os
import platform
import tempfile
from collections import Counter
from collections.abc import Iterable, Sequence
from contextlib import ExitStack
from datetime import UTC, datetime
from importlib.metadata import version
from importlib.resources import files
from itertools import count
from pathlib import Path
from typing import Any

from jinja2 import Environment
from markupsafe import Markup

from flockana._version import __version__
from flockana.base.errors import FileError
from flockana.base.files import atomic_write, ensure_path
from flockana.player.page import script, style, templates
from flockana.report.comparison import ComparisonSection
from flockana.report.coverage import coverage
from flockana.report.coverage.report_anchors import anchors, scenario_id, verdict_id
from flockana.report.figures import Picture
from flockana.report.lattices import lattice_section
from flockana.report.opening_findings import front_findings, most_telling, opening_sentence
from flockana.report.page_data import FixedPage, Page, ScenarioPage
from flockana.report.stability import NO_FLOCKS, LinearisedFlocks, stability_section
from flockana.report.statistics import StatisticsSection
from flockana.report.svg_figures import named
from flockana.report.value_texts import deciding_claim, markup, show, source_name, tolerance_rows
from flockana.theorems.claim import BYLINES
from flockana.theorems.errata import FOREWORD, SORTS, errata, erratum_of

FOLDER, HTML, JSON = Path("report"), "index.html", "verdicts.json"
UNFINISHED = "unfinished"  # folder within that of a complete report, for one that was broken off
_REMEDY = "choose another folder"
_LIBRARIES = ("numpy", "scipy", "numba", "sympy", "xarray", "matplotlib")
_STATUSES = ("verified", "refuted", "vacuous", "inconclusive")


def ensure_directory(directory: str | os.PathLike[str]) -> Path:
    """Create a writable folder before any work whose results go there."""
    path = ensure_path(directory, action="write to", remedy="choose a folder you may write to")
    try:
        path.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=path):
            pass
    except OSError as error:
        is_taken = os.path.exists(path) and not os.path.isdir(path)
        reason = "there is a file of that name" if is_taken else error.strerror or error
        raise FileError(f"cannot write to {path}: {reason}; choose a folder you may write to") from error
    return path


def report_folder(name: str | None) -> Path:
    """Return the folder of a report; a partial report never replaces a full catalogue report."""
    return FOLDER if name is None or not _covers_catalogue(FOLDER) else FOLDER / name


def _covers_catalogue(folder: Path) -> bool:
    """Return whether a folder holds a full catalogue report, or an unreadable one."""
    stored_facts = _facts(folder)
    return stored_facts is not None and stored_facts.get("of") is None


def _facts(folder: Path) -> dict[str, Any] | None:
    """Return the facts stored with a report in a folder, None without a report; damaged ones count as full."""
    if not (folder / HTML).exists() and not (folder / JSON).exists():
        return None
    facts = {"complete": True, "of": None}
    try:
        data = json.loads((folder / JSON).read_text(encoding="utf-8"))
    except (OSError, ValueError, RecursionError):
        return facts
    return data if isinstance(data, dict) and isinstance(data.get("complete"), bool) else facts


def write_report(
    pages: Sequence[Page],
    directory: str | os.PathLike[str],
    *,
    seed: int = 0,
    seconds: float | None = None,
    complete: bool = True,
    statistics: StatisticsSection | None = None,
    comparison: ComparisonSection | None = None,
    flocks: LinearisedFlocks = NO_FLOCKS,
    of: str | None = None,
) -> Path:
    """Write ``index.html`` and ``verdicts.json``; existing files are replaced only by complete ones."""
    # A report that is not complete leaves a complete one alone and goes to the folder ``unfinished`` within; one on a
    # part leaves one on the whole catalogue alone and goes to a folder of its name. `of` is what was checked, by name;
    # None for the whole catalogue.
    folder = ensure_directory(directory)
    if of is not None and _covers_catalogue(folder):
        folder = ensure_directory(folder / of)
    if not complete and (_facts(folder) or {}).get("complete"):
        folder = ensure_directory(folder / UNFINISHED)
    run = _run_facts(seed, seconds, complete) | {"of": of}
    html = _html(pages, run, flocks, statistics=statistics, comparison=comparison)
    texts = {JSON: _json(pages, run, statistics), HTML: html}
    with ExitStack() as exit_stack:  # neither takes its place before both are whole
        partials = {name: exit_stack.enter_context(atomic_write(folder / name, remedy=_REMEDY)) for name in texts}
        for name, text in texts.items():
            partials[name].write_text(text, encoding="utf-8")
    return folder / HTML


def verdicts_json(
    pages: Iterable[Page],
    *,
    seed: int = 0,
    seconds: float | None = None,
    complete: bool = True,
    statistics: StatisticsSection | None = None,
) -> str:
    """Return all verdicts as JSON text, with the facts of their run."""
    return _json(list(pages), _run_facts(seed, seconds, complete), statistics)


def _json(pages: Sequence[Page], run: dict[str, Any], statistics: StatisticsSection | None) -> str:
    data = run | {"surprises": [text for page in pages for text in page.surprises]}
    data["verdicts"] = [finding.to_dict() for page in pages for finding in page.findings]
    data["statistics"] = None if statistics is None else statistics.to_dict()
    return json.dumps(data, indent=1, ensure_ascii=False, allow_nan=False) + "\n"


def _run_facts(seed: int, seconds: float | None, complete: bool) -> dict[str, Any]:
    return {
        "flockana": __version__,
        "written": datetime.now(UTC).strftime("%Y-%m-%d %H:%M UTC"),
        "seed": seed,
        "seconds": None if seconds is None else round(seconds, 2),
        "complete": complete,
        "python": platform.python_version(),
        "libraries": {name: version(name) for name in _LIBRARIES},
    }


def page_environment() -> Environment:
    """Return the template environment of one report page, which numbers the page's figures."""
    environment, counter = templates(), count(1)

    def figure(picture: Picture) -> Markup:
        return Markup(named(picture.source, picture.caption, next(counter)))

    environment.filters |= {"show": show, "markup": markup, "deciding": deciding_claim, "figure": figure}
    environment.filters |= {"source_name": source_name, "erratum": erratum_of}
    environment.globals |= {"scenario_id": scenario_id, "verdict_id": verdict_id, "bylines": BYLINES}
    return environment


def _html(pages: Sequence[Page], run: dict[str, Any], flocks: LinearisedFlocks, **sections: Any) -> str:
    entries = [(page, f, verdict_id(page.subject, f.verdict.theorem)) for page in pages for f in page.findings]
    counts: Counter[str] = Counter(finding.verdict.status for _, finding, _ in entries)
    verdicts, is_full = [finding.verdict for _, finding, _ in entries], run["of"] is None
    return (
        page_environment()
        .get_template("report/template.html.j2")
        .render(
            run=run,
            opening=opening_sentence([finding for _, finding, _ in entries]),
            folded=is_full,
            telling=most_telling(pages),
            scenarios=[page for page in pages if isinstance(page, ScenarioPage)],
            fixed=[page for page in pages if isinstance(page, FixedPage)],
            lattices=lattice_section(pages),
            stability=stability_section(pages, flocks),
            errata=errata(),
            sorts=SORTS,
            foreword=FOREWORD,
            checked={finding.verdict.theorem: anchor for _, finding, anchor in reversed(entries)},  # where it is first
            coverage={"sources": coverage(), "anchors": anchors(pages)} if is_full else None,
            front=front_findings(pages) if is_full else (),
            counts=[(status, counts[status]) for status in _STATUSES],
            surprises=_unexpected(pages),
            sources=sorted({source_name(f.references[0]) for _, f, _ in entries if f.references}),
            rigours=sorted({verdict.rigour for verdict in verdicts}),
            player_style=Markup(style()),
            player_script=Markup(script()),
            report_script=Markup((files("flockana.report") / "report.js").read_text(encoding="utf-8")),
            report_style=Markup((files("flockana.report") / "report.css").read_text(encoding="utf-8")),
            tolerances=[tolerance_rows(t) for t in dict.fromkeys(verdict.tolerances for verdict in verdicts)],
            **sections,
        )
    )


def _unexpected(pages: Sequence[Page]) -> list[tuple[str, str]]:
    """Return (anchor in the page, text) of each difference from the expected statuses."""
    unexpected = []
    for page in pages:
        if isinstance(page, ScenarioPage) and page.early_end:
            unexpected.append((scenario_id(page.name), page.early_end))
        for finding in page.findings:
            anchor = verdict_id(page.subject, finding.verdict.theorem)
            unexpected += [(anchor, text) for text in finding.surprises]
    return unexpected
