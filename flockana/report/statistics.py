"""Report section on many seeds: shares of seeds in which claims hold, with intervals."""

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass
from itertools import product
from math import nan
from typing import Any

import numpy as np

from flockana.base.binomial_intervals import clopper_pearson
from flockana.ensemble.one_run import COMPLETE, Record
from flockana.ensemble.shares import STATUSES, shares
from flockana.report.figures import Picture
from flockana.report.seed_surveys import Survey, SurveyResult
from flockana.report.svg_figures import svg
from flockana.scenarios import Scenario, scenario
from flockana.theorems.catalogue import catalogue

_LEVEL = 0.95  # confidence of each interval
_DRAWN = 12  # combinations of parameters whose shares fit one picture
TEMPLATE = "report/statistics.html.j2"  # takes `statistics`, the section


@dataclass(frozen=True)
class Share:
    """Share of runs in which a claim had one outcome, with counts and confidence interval."""

    count: int  # count, runs: Runs that did, and all that the claim was checked on
    runs: int
    low: float  # low, high: Interval of the share
    high: float

    @property
    def share(self) -> float:
        """Number of runs with the outcome over the number of all checked runs; NaN without any."""
        return self.count / self.runs if self.runs else nan

    def __str__(self) -> str:
        """Return the share of runs and its confidence interval in per cent."""
        if not self.runs:
            return "—"
        return f"{100.0 * self.share:.1f} % [{100.0 * self.low:.1f}, {100.0 * self.high:.1f}]"


@dataclass(frozen=True)
class Row:
    """Shares of runs over all seeds in which one claim is verified or refuted, and counts of other outcomes."""

    theorem: str
    claim: str
    text: str  # what it says, in words
    verified: Share  # verified, refuted: Shares of the runs
    refuted: Share
    vacuous: int  # vacuous, inconclusive: Runs on which it says nothing, or that do not decide it
    inconclusive: int
    expected: str = ""  # status that the scenario expects for its usual seed; empty if none


@dataclass(frozen=True)
class ScenarioShares:
    """Shares of runs over all seeds in which the claims of one scenario are verified or refuted."""

    scenario: str
    title: str
    settings: str  # whose they are: printed, recommended, …
    options: str  # options that were given it, in words; empty if none
    runs: int  # runs, incomplete: All runs, and how many of them did not complete and count for nothing
    incomplete: int
    seconds: float  # mean time of a run
    rows: tuple[Row, ...]  # claims


@dataclass(frozen=True)
class StatisticsSection:
    """Report section on many seeds: shares of runs in which the claims of surveyed scenarios hold."""

    level: float  # confidence of every interval by itself
    entries: tuple[ScenarioShares, ...]  # by scenario
    picture: Picture | None = None  # all shares

    def to_dict(self) -> dict[str, Any]:
        """Return the report section as a dictionary of plain data for JSON."""
        return {"level": self.level, "scenarios": [asdict(entry) for entry in self.entries]}


def gather(asked: Sequence[Survey], made: Iterable[SurveyResult], *, figures: bool = True) -> StatisticsSection | None:
    """Return the report section on scenarios with complete surveys over seeds; None without any."""
    records = {result.survey: result.records for result in made}
    entries = []
    for name in dict.fromkeys(survey.scenario for survey in asked):
        batches = [survey for survey in asked if survey.scenario == name]
        if all(survey in records for survey in batches):  # half a table is not shown as if it were whole
            entries.append(entry_of(name, [record for survey in batches for record in records[survey]], _LEVEL))
    if not entries:
        return None
    return StatisticsSection(_LEVEL, tuple(entries), _picture(entries) if figures else None)


def entry_of(name: str, records: Sequence[Record], level: float) -> ScenarioShares:
    """Return the shares of one scenario, from records of runs with the same options."""
    options = dict(records[0].job.options)
    item = scenario(name, records[0].job.seed, **options)
    labels = dict.fromkeys(label for record in records for label in record.claims)
    statuses = {label: Counter(r.claims[label][0] for r in records if label in r.claims) for label in labels}
    return ScenarioShares(
        name,
        item.title,
        item.settings,
        _in_words(options),
        len(records),
        sum(record.status != COMPLETE for record in records),
        float(np.mean([record.seconds for record in records])),
        tuple(_row(label, counts, level, item) for label, counts in statuses.items()),
    )


def section_of(dataset: Any) -> StatisticsSection:
    """Return the section on an ensemble's dataset, with an entry for each combination of its parameters."""
    table = shares(dataset, level=_LEVEL)
    name, axes = dataset.attrs.get("scenario", "ensemble"), [str(x) for x in dataset.run.dims if x != "seed"]
    entries = []
    for values in product(*(dataset[axis].values.tolist() for axis in axes)):
        point = dict(zip(axes, values, strict=True))
        runs, counts = dataset.sel(point), table.sel(point)
        statuses = {
            label: Counter({of: int(counts[of].sel(claim=label)) for of in STATUSES}) for label in runs.claim.values
        }
        rows = tuple(_row(label, counter, _LEVEL) for label, counter in statuses.items() if counter.total())
        seconds = float(runs.seconds.mean()) if "seconds" in runs else 0.0
        run_facts = runs.run.size, int(counts.incomplete), seconds, rows
        entries.append(ScenarioShares(name, "Runs of an ensemble", "", _in_words(point), *run_facts))
    return StatisticsSection(_LEVEL, tuple(entries), _picture(entries) if len(entries) <= _DRAWN else None)


def _in_words(options: Mapping[str, Any]) -> str:
    return ", ".join(f"{key} = {value}" for key, value in options.items())


def _row(label: str, statuses: Counter[str], level: float, item: Scenario | None = None) -> Row:
    """Return the outcome shares of one claim over its checked runs."""
    name, _, claim = label.partition(":")
    runs = statuses.total()
    ends = {of: clopper_pearson(statuses[of], runs, level=level) for of in ("verified", "refuted")}
    verified, refuted = (Share(statuses[of], runs, *map(float, interval)) for of, interval in ends.items())
    others = statuses["vacuous"], statuses["inconclusive"]
    reported = {} if item is None else {report.name: report.text for report in item.reports}
    entry = catalogue().get(name)
    text = reported.get(claim, claim) if entry is None else entry.title
    return Row(name, claim, text, verified, refuted, *others, "" if item is None else item.expected.get(label, ""))


def _picture(entries: Sequence[ScenarioShares]) -> Picture | None:
    from flockana.plots.ensemble import draw_bars

    rows = {f"{entry.options or entry.scenario}: {row.claim}": row for entry in entries for row in entry.rows}
    if not rows:
        return None
    both = {of: [getattr(row, of) for row in rows.values()] for of in ("verified", "refuted")}
    shares = {of: np.array([(item.share, item.low, item.high) for item in share]).T for of, share in both.items()}
    runs = [item.runs for item in both["verified"]]
    text = (
        "In which share of the seeds each claim is verified (discs) and refuted (squares), with intervals; the "
        "rest is vacuous or inconclusive. The tables below say what each claim is."
    )
    figure_size = 7.5, 1.1 + 0.19 * len(rows)
    return Picture(text, svg(lambda figure: draw_bars(figure.subplots(), [*rows], shares, runs, _LEVEL), figure_size))
