"""The report's section on many seeds: in which share of them each claim holds, with intervals."""

from __future__ import annotations

import os
from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from flockana.ensemble import ensemble, shares
from flockana.errors import ArgumentError
from flockana.scenarios import Scenario, scenario, scenarios
from flockana.scenarios.scenario import SOURCE
from flockana.theorems import theorem

if TYPE_CHECKING:
    import xarray

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
    options: str
    runs: int
    incomplete: int
    seconds: float
    rows: tuple[Row, ...]


@dataclass(frozen=True)
class StatisticsSection:
    """What the section shows.

    Parameters
    ----------
    level : float
        Confidence of every interval by itself.
    entries : tuple of Entry
        By scenario.
    """

    level: float
    entries: tuple[Entry, ...]


def statistics(
    names: Iterable[str],
    seeds: Iterable[int],
    *,
    theorems: Iterable[str] = (SOURCE,),
    level: float = 0.95,
    cluster: str | None = None,
    jobs: int | None = None,
    store: str | os.PathLike[str] | None = None,
    progress: bool = False,
) -> StatisticsSection:
    """Run scenarios for many seeds and gather the shares of their claims.

    Parameters
    ----------
    names : iterable of str
        Scenarios of the catalogue.
    seeds : iterable of int
        The same for all.
    theorems : iterable of str
        Which to check; by default only what the sources report.
    level : float
        Confidence of the intervals.
    cluster, jobs, store, progress
        As in `flockana.ensemble.ensemble`.

    Raises
    ------
    ArgumentError
        On bad input.
    """
    wanted, given, chosen = tuple(names), tuple(seeds), tuple(theorems)
    return statistics_section(
        (
            ensemble(
                name,
                given,
                theorems=chosen,
                metrics=(),
                cluster=cluster,
                jobs=jobs,
                store=store,
                progress=progress,
            )
            for name in wanted
        ),
        level=level,
    )


def statistics_section(datasets: Iterable[xarray.Dataset], *, level: float = 0.95) -> StatisticsSection:
    """Gather the section from ensembles of scenarios of the catalogue.

    Parameters
    ----------
    datasets : iterable of xarray.Dataset
        From `flockana.ensemble.ensemble`, each over seeds alone.
    level : float
        Confidence of the intervals.

    Raises
    ------
    ArgumentError
        If one is over more than seeds, or not of the catalogue.
    """
    return StatisticsSection(level, tuple(_entry(one, level) for one in datasets))


def _entry(dataset: xarray.Dataset, level: float) -> Entry:
    name = dataset.attrs.get("scenario")
    if name not in scenarios() or {*dataset.run.dims} != {"seed"}:
        raise ArgumentError(
            f"an ensemble of {name} over {', '.join(map(str, dataset.run.dims))}: expected one of a "
            "scenario of the catalogue over seeds alone; select values of the others by .sel(...)"
        )
    table = shares(dataset, level=level)
    options = {str(key): one.item() for key, one in dataset.coords.items() if not one.dims}
    item = scenario(name, int(dataset.seed[0]), **options)
    return Entry(
        name,
        item.title,
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
