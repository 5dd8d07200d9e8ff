"""Results of the report as plain data, cheap to send between processes."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Any

from flockana.base.errors import ArgumentError
from flockana.dynamics.trajectory import Trajectory
from flockana.player.marked_instants import marks_of
from flockana.player.page import text_of
from flockana.player.scene import scene
from flockana.report.figures import Picture, pictures
from flockana.report.flock_stills import still
from flockana.report.value_texts import parameters
from flockana.scenarios import Scenario, scenarios
from flockana.scenarios.option_checks import SOURCE
from flockana.scenarios.scenario import differences
from flockana.theorems import Status, Theorem, Verdict, theorem
from flockana.theorems.catalogue import catalogue

_VALUES = 24_000  # numbers of places and velocities of a run in the page: all runs together take 2 MB of it
_FEW_SAMPLES, _ENOUGH = 20, 60  # below the first a player would show straight lines; so many it gets then


@dataclass(frozen=True)
class Finding:
    """Verdict on a theorem with the theorem's statement, its source and the expected status."""

    verdict: Verdict
    title: str
    statement: str
    source: str
    # expected status by theorem id and by ``"id:claim"``; empty if nothing is
    expected: Mapping[str, Status] = field(default_factory=dict)
    surprises: tuple[str, ...] = ()  # what differs from the expected, one line each
    references: tuple[str, ...] = ()  # keys of the bibliography

    @property
    def as_expected(self) -> bool | None:
        """Return whether the verdict is as expected; None without an expectation."""
        return not self.surprises if self.expected else None

    def to_dict(self) -> dict[str, Any]:
        """Return the finding as a dictionary of plain data for JSON."""
        outcome = {"as_expected": self.as_expected, "surprises": list(self.surprises)}
        return self.verdict.to_dict() | {"title": self.title, "expected": dict(self.expected)} | outcome


@dataclass(frozen=True)
class ScenarioPage:
    """Data of a report page on one scenario: facts of the run, verdicts, pictures and player data."""

    name: str
    title: str
    source: str
    facts: tuple[tuple[str, str], ...]  # how it was run, by name
    findings: tuple[Finding, ...]
    pictures: tuple[Picture, ...] = ()  # its figures; empty if none were drawn
    early_end: str = ""  # why the run ended early; empty if it did not
    references: tuple[str, ...] = ()  # keys of the bibliography
    play: str = ""  # the run for the player, as text (`flockana.player`); empty if there are no figures
    thumbnail: str = ""  # the flock at the end, as SVG; empty if there are no figures

    @property
    def command(self) -> str:
        """Shell command that repeats the scenario's run; empty for a run outside the catalogue."""
        return f"flockana verify {self.name}" if self.name in scenarios() else ""

    @property
    def subject(self) -> str:
        """Name of the scenario, the subject of the page's verdicts, for ids in the report."""
        return self.name

    @property
    def surprises(self) -> tuple[str, ...]:
        """One line per difference of the run from the expected verdicts, including an early end of the run."""
        surprises = tuple(text for finding in self.findings for text in finding.surprises)
        return (self.early_end, *surprises) if self.early_end else surprises


@dataclass(frozen=True)
class FixedPage:
    """Data of a report page on a theorem or erratum that is checked without a run."""

    finding: Finding
    subject = "fixed"

    @property
    def name(self) -> str:
        """Id of the page's theorem or erratum."""
        return self.finding.verdict.theorem

    @property
    def findings(self) -> tuple[Finding, ...]:
        """The page's single verdict, in a tuple."""
        return (self.finding,)

    @property
    def surprises(self) -> tuple[str, ...]:
        """One line per difference of the page's verdict from the expected one."""
        return self.finding.surprises


Page = ScenarioPage | FixedPage


def fixed_page(verdict: Verdict) -> FixedPage:
    """Return the page data of a theorem or erratum that is checked without a run, from its verdict."""
    item = theorem(verdict.theorem)
    return FixedPage(_finding(verdict, item, item.expected))


def scenario_page(
    scenario: Scenario,
    run: Trajectory,
    verdicts: tuple[Verdict, ...],
    *,
    figures: bool = True,
    own: Mapping[str, Theorem] = MappingProxyType({}),
) -> ScenarioPage:
    """Return a scenario's run with the verdicts of `Scenario.verify` as plain data, with its figures drawn.

    `own` has the theorems that are no catalogue's, by their ids.
    """
    early_end_text = "" if run.status == "complete" else f"the run of {scenario.name} {run.status}: {run.message}"
    return ScenarioPage(
        scenario.name,
        scenario.title,
        scenario.source,
        _facts(scenario, run),
        tuple(_scenario_finding(scenario, verdict, own) for verdict in verdicts),
        pictures(run, scenario.instants) if figures else (),
        early_end_text,
        tuple(scenario.references),
        _play(scenario, run, verdicts) if figures else "",
        still(run, float(run.t[-1])) if figures else "",
    )


def verdicts_page(name: str, verdicts: tuple[Verdict, ...]) -> ScenarioPage:
    """Return the page data of the user's own verdicts, without a run."""
    entries = catalogue()
    findings = (
        _finding(verdict, entries[verdict.theorem], {})
        if verdict.theorem in entries
        else Finding(verdict, verdict.theorem, "", "own claim")
        for verdict in verdicts
    )
    return ScenarioPage(name, "Verdicts", "Verdicts of the user's own.", (), tuple(findings))


def _play(scenario: Scenario, run: Trajectory, verdicts: tuple[Verdict, ...]) -> str:
    """Return a run as text for the player, with instants marked that its source shows or that decide claims."""
    marks, title, played_run = marks_of(run, verdicts, scenario.instants), f"{scenario.name}: {scenario.title}", run
    if 1 < len(run.t) < _FEW_SAMPLES and not run.law.is_map:
        from flockana.plots.animation import equal_times

        played_run = equal_times(run, _ENOUGH)  # cubics that match places and velocities
    try:
        return text_of(scene(played_run, values=_VALUES, exact=False, title=title, marks=marks))
    except ArgumentError:  # places or velocities are so large that the player's numbers have no room for them
        return ""


def _scenario_finding(scenario: Scenario, verdict: Verdict, own: Mapping[str, Theorem]) -> Finding:
    expected = {k: v for k, v in scenario.expected.items() if k.split(":")[0] == verdict.theorem}
    if verdict.theorem != SOURCE:
        return _finding(verdict, own.get(verdict.theorem) or theorem(verdict.theorem), expected)
    reports = " ".join(f"{report.name}: {report.text.rstrip('.')}." for report in scenario.reports)
    texts = "What the source reports", reports, scenario.source, expected
    return Finding(verdict, *texts, differences(verdict, expected), scenario.references)


def _finding(verdict: Verdict, item: Theorem, expected: Mapping[str, Status]) -> Finding:
    surprises = differences(verdict, expected)
    return Finding(verdict, item.title, item.statement, item.source, dict(expected), surprises, item.references)


def _facts(scenario: Scenario, run: Trajectory) -> tuple[tuple[str, str], ...]:
    stats = run.stats
    knobs = [(key, stats[key]) for key in ("rtol", "atol", "dt", "max_step") if stats.get(key) is not None]
    tolerances = ", ".join(f"{key} {value:g}" if isinstance(value, float) else f"{key} {value}" for key, value in knobs)
    steps = f"{stats.get('method', '—')} ({tolerances}): {stats.get('steps', '—')} steps"
    return (
        ("agents", f"{run.n} in {run.m} dimension{'s' if run.m > 1 else ''}"),
        ("time", f"{run.t[0]:g} to {run.t[-1]:g}, {len(run.t)} samples"),
        ("start", f"seed {scenario.seed}" if stats else run.message),
        *parameters(run.law),
        *([("integrated by", steps)] if stats else []),
    )
