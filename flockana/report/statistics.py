"""The report's section on many seeds: in which share of them each claim holds, with intervals."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from flockana.base.errors import ArgumentError
from flockana.ensemble import shares
from flockana.ensemble.dataset import to_dataset
from flockana.report.surveys import Survey, SurveyResult, request
from flockana.scenarios import Scenario, scenario, scenarios
from flockana.scenarios.given import SOURCE
from flockana.theorems import theorem

if TYPE_CHECKING:
    import xarray
    from matplotlib.figure import Figure

    from flockana.report.figures import Picture

TEMPLATE = "statistics.html.j2"  # takes `statistics`, the section


@dataclass(frozen=True)
class Share:
    """How often a claim came out in one way, of how many runs.

    Parameters
    ----------
    count, runs : int
        Runs that did, and all that the claim was checked on.
    low, high : float
        Interval of the share.
    """

    count: int
    runs: int
    low: float
    high: float

    def __str__(self) -> str:
        """As per cent: share and interval."""
        if not self.runs:
            return "—"
        return f"{100.0 * self.count / self.runs:.1f} % [{100.0 * self.low:.1f}, {100.0 * self.high:.1f}]"


@dataclass(frozen=True)
class Row:
    """One claim over all seeds.

    Parameters
    ----------
    theorem, claim : str
        Its names.
    text : str
        What it says, in words.
    verified, refuted : Share
        Shares of the runs.
    vacuous, inconclusive : int
        Runs on which it says nothing, or that do not decide it.
    expected : str
        Status that the scenario expects for its usual seed; empty if none.
    """

    theorem: str
    claim: str
    text: str
    verified: Share
    refuted: Share
    vacuous: int
    inconclusive: int
    expected: str = ""


@dataclass(frozen=True)
class Entry:
    """One scenario over all seeds.

    Parameters
    ----------
    scenario, title : str
        Of the scenario.
    settings : str
        Whose they are: printed, recommended, …
    options : str
        Options that were given it, in words; empty if none.
    runs, incomplete : int
        All runs, and how many of them did not complete and count for nothing.
    seconds : float
        Mean time of a run.
    rows : tuple of Row
        Claims.
    """

    scenario: str
    title: str
    settings: str
    options: str
    runs: int
    incomplete: int
    seconds: float
    rows: tuple[Row, ...]


@dataclass(frozen=True)
class StatisticsSection:
    """Shares over many seeds of the scenarios that were surveyed.

    Parameters
    ----------
    level : float
        Confidence of every interval by itself.
    entries : tuple of Entry
        By scenario.
    picture : Picture, optional
        All shares.
    """

    level: float
    entries: tuple[Entry, ...]
    picture: Picture | None = None

    def to_dict(self) -> dict[str, Any]:
        """Plain data for JSON."""
        return {"level": self.level, "scenarios": [asdict(entry) for entry in self.entries]}


def gather(asked: Sequence[Survey], made: Iterable[SurveyResult], *, figures: bool = True) -> StatisticsSection | None:
    """The section of all scenarios whose surveys were all made; None if there is no such."""
    records = {result.survey: result.records for result in made}
    datasets = []
    for name in dict.fromkeys(survey.scenario for survey in asked):
        batches = [survey for survey in asked if survey.scenario == name]
        if all(survey in records for survey in batches):  # half a table is not shown as if it were whole
            seeds = [seed for survey in batches for seed in survey.seeds]
            runs = [record for survey in batches for record in records[survey]]
            datasets.append(to_dataset(request(name), {}, {}, seeds, runs))
    return statistics_section(datasets, figures=figures) if datasets else None


def statistics_section(
    datasets: Iterable[xarray.Dataset], *, level: float = 0.95, figures: bool = True
) -> StatisticsSection:
    """Gather the section from ensembles of scenarios of the catalogue."""
    given = tuple(datasets)
    entries = tuple(_entry(ensemble, level) for ensemble in given)
    tables = [shares(ensemble, level=level) for ensemble in given] if figures else []
    drawn = [table for table in tables if table.claim.size]
    return StatisticsSection(level, entries, _picture(drawn) if drawn else None)


def _picture(tables: Sequence[xarray.Dataset]) -> Picture:
    import xarray

    from flockana import plots
    from flockana.report.figures import Picture
    from flockana.report.image import svg

    named = [
        table.drop_vars("incomplete").assign_coords(
            claim=[f"{table.attrs['scenario']}: {claim.partition(':')[2]}" for claim in table.claim.values.tolist()]
        )
        for table in tables
    ]
    whole = xarray.concat(named, "claim", combine_attrs="override")

    def draw(figure: Figure) -> None:
        plots.share_bars(whole, ax=figure.subplots())

    text = (
        "In which share of the seeds each claim is verified (discs) and refuted (squares), with intervals; what is "
        "missing to 100 % is vacuous or inconclusive. The tables below say what each claim is."
    )
    return Picture(text, svg(draw, (7.5, 1.1 + 0.19 * whole.claim.size)))


def _entry(dataset: xarray.Dataset, level: float) -> Entry:
    name = dataset.attrs.get("scenario")
    if name not in scenarios() or {*dataset.run.dims} != {"seed"}:
        raise ArgumentError(
            f"an ensemble of {name} over {', '.join(map(str, dataset.run.dims))}: expected one of a "
            "scenario of the catalogue over seeds alone; select values of the others by .sel(...)"
        )
    table = shares(dataset, level=level)
    options = {str(key): value.item() for key, value in dataset.coords.items() if not value.dims}
    item = scenario(name, int(dataset.seed[0]), **options)
    return Entry(
        name,
        item.title,
        item.settings,
        ", ".join(f"{key} = {value}" for key, value in options.items()),
        int(dataset.seed.size),
        int(table.incomplete),
        float(np.mean(dataset.seconds)),
        tuple(_row(item, table.sel(claim=claim)) for claim in table.claim.values),
    )


def _row(item: Scenario, part: xarray.Dataset) -> Row:
    label = str(part.claim.item())
    name, _, claim = label.partition(":")
    runs = int(part.runs)
    verified, refuted = (
        Share(int(part[of]), runs, *(float(part[end].sel(of=of)) for end in ("low", "high")))
        for of in ("verified", "refuted")
    )
    counts = int(part.vacuous), int(part.inconclusive)
    return Row(name, claim, _text(item, name, claim), verified, refuted, *counts, item.expected.get(label, ""))


def _text(item: Scenario, name: str, claim: str) -> str:
    """What the source is reported to say, or the theorem's title."""
    if name != SOURCE:
        return theorem(name).title
    return next((report.text for report in item.reports if report.name == claim), claim)
