"""Scenarios: a law, a start, a time span, a source, and expected statuses."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from functools import cache
from typing import Any

from flockana.base.module_discovery import source_modules
from flockana.base.units import rescale, times
from flockana.base.value_checks import FloatArray, ensure_known, ensure_seed
from flockana.dynamics.error_tolerances import options_in_units
from flockana.dynamics.simulate import simulate
from flockana.dynamics.trajectory import Trajectory
from flockana.laws import DiscreteLaw, Law
from flockana.laws.law_with_start import WithStart
from flockana.scenarios.lazy_start import LazyField
from flockana.scenarios.option_checks import SOURCE, ensure_judged, ensure_options, ensure_parts
from flockana.scenarios.rigorous_verdicts import Enclosure
from flockana.theorems import Claim, Status, Theorem, Tolerances, Verdict, verify
from flockana.theorems.observed_run import Observed, by_both_runs, with_resolution

OURS = ("olfati-saber-2006", "flockana")  # references of scenarios of our own about the paper's laws


@dataclass(frozen=True)
class Report:
    """Statement of a source about its own simulation, with a function that judges a run by it."""

    name: str  # short name
    text: str  # what the source reports, in our words
    check: Callable[[Trajectory, Tolerances], Claim]  # ``check(trajectory, tolerances) -> Claim``

    def judge(self, seen: Observed, tolerances: Tolerances) -> Claim:
        """Return the statement's claim on a run, with an error from the difference to a second run."""
        return by_both_runs(seen, lambda run: self.check(run, tolerances))


@dataclass(frozen=True)
class Scenario(WithStart):
    """Published simulation, ready to run.

    Parameters
    ----------
    name, title : str
        Name in the catalogue and one line.
    source : str
        Where it was published, and what is ours.
    q0, p0 : ndarray, shape (n, m)
        Start; what takes long to draw may be given as `flockana.scenarios.lazy_start.lazy_array`.
    expected : mapping of str to str
        Expected status by theorem id, and by ``"id:claim"`` where one claim matters.
    reports : tuple of Report
        What the source says it saw; judged as one verdict under the id ``"source"``.
    references : tuple of str
        Keys of the bibliography.
    seeds : int
        From how many seeds the report of the catalogue tells in which share of runs the reports hold; 0 for no shares.
    settings : str
        Whose settings they are, beside these shares.
    shipped : mapping of str to str
        Statuses expected of the start with seed 0 alone, as other starts come to others: there `expected` has them too.
    instants : tuple of float
        Times within t_span at which the report shows the flock, because its source does so; empty for the usual three.
    enclosed : Enclosure, optional
        Which theorems are decided rigorously, from a tube, and how.

    Raises
    ------
    ArgumentError
        On a law, start, time span, seed or status that is none, or an instant outside t_span.

    Examples
    --------
    >>> scenario("notebook-algorithm1").q0.shape
    (27, 2)
    """

    name: str
    title: str
    source: str
    law: Law | DiscreteLaw
    q0: FloatArray
    p0: FloatArray
    t_span: tuple[float, float]
    seed: int = 0
    expected: Mapping[str, Status] = field(default_factory=dict)
    reports: tuple[Report, ...] = ()
    options: Mapping[str, Any] = field(default_factory=dict)
    references: tuple[str, ...] = ("olfati-saber-2006",)
    seeds: int = 0
    settings: str = ""
    shipped: Mapping[str, Status] = field(default_factory=dict)
    instants: tuple[float, ...] = ()
    enclosed: Enclosure | None = None

    def __post_init__(self) -> None:
        ensure_parts(vars(self))
        if self.seed == 0:
            object.__setattr__(self, "expected", {**self.expected, **self.shipped})

    def __repr__(self) -> str:
        (n, m), law, (begin, end) = self.shape, self.law.title, self.t_span
        return f"<Scenario {self.name!r}: {self.title}; {n} agents, m = {m}, {law}, t = {begin:g} to {end:g}>"

    @property
    def shape(self) -> tuple[int, int]:
        """Numbers of agents and of dimensions, (n, m), known before the start is drawn."""
        n, m = vars(self)["q0"].shape
        return n, m

    @property
    def theorems(self) -> tuple[str, ...]:
        """Ids of the theorems that are checked on the scenario."""
        theorem_names = (key.split(":")[0] for key in {**self.expected, **self.shipped})
        return tuple(name for name in dict.fromkeys(theorem_names) if name != SOURCE)

    def law_and_start(self, seed: int) -> tuple[Any, Any, Any, tuple[float, float]]:  # noqa: D102
        return self.law, self.q0, self.p0, self.t_span

    def run(self, *, progress: bool = False) -> Trajectory:
        """Simulate the scenario.

        Raises
        ------
        UnknownNameError
            If a status is expected of a theorem that there is not.
        """
        ensure_judged(self.theorems)
        return simulate(self.law, self.q0, self.p0, self.t_span, progress=progress, **self.options)

    def verify(self, trajectory: Trajectory, *, tolerances: Tolerances | None = None) -> tuple[Verdict, ...]:
        """Return verdicts of every applicable theorem, and of the source's reports, on a run of this scenario."""
        verdicts = tuple(self.verdict(name, trajectory, tolerances=tolerances) for name in self.theorems)
        return verdicts + self.reported(trajectory, tolerances=tolerances)

    def verdict(self, name: str | Theorem, trajectory: Trajectory, *, tolerances: Tolerances | None = None) -> Verdict:
        """Return one theorem's verdict on a run of this scenario, rigorous if `enclosed` names the theorem."""
        if self.enclosed is not None and name in self.enclosed.theorems:
            return self.enclosed.verdict(name, trajectory, tolerances=tolerances, subject=self.name)
        return verify(name, trajectory, tolerances=tolerances, subject=self.name)

    def reported(self, trajectory: Trajectory, *, tolerances: Tolerances | None = None) -> tuple[Verdict, ...]:
        """Return the source's reports as one verdict in a tuple; empty if the source reports nothing."""
        if not self.reports:
            return ()
        tolerances_used = Tolerances() if tolerances is None else tolerances
        seen = Observed.of(trajectory)
        verdicts = with_resolution((), (report.judge(seen, tolerances_used) for report in self.reports), seen)
        return (Verdict(SOURCE, *verdicts, tolerances_used, self.name),)

    def in_units(self, length: float, time: float) -> Scenario:
        """Return the scenario in other units (`flockana.rescale`); reports keep their source's units."""
        return replace(
            self,
            law=rescale(self.law, length=length, time=time),
            q0=self.q0 * length,
            p0=self.p0 * (length / time),
            t_span=times(self.t_span, time),
            instants=times(self.instants, time),
            options=options_in_units(self.options, length, time),
        )

    def surprises(self, verdict: Verdict) -> tuple[str, ...]:
        """Return differences of a verdict from the expected one, one line each."""
        return differences(verdict, self.expected)


for _name in ("q0", "p0"):
    setattr(Scenario, _name, LazyField(_name))


def differences(verdict: Verdict, expected: Mapping[str, Status]) -> tuple[str, ...]:
    """Return differences of a verdict from expected statuses or proofs, one line each."""
    # Statuses are keyed by theorem id and by ``"id:claim"``.
    statuses = {verdict.theorem: verdict.status} | {f"{verdict.theorem}:{c.name}": c.status for c in verdict.claims}
    difference_texts = (
        f"{key} is {statuses.get(key, 'missing')}, expected {status}"
        for key, status in expected.items()
        if key.split(":")[0] == verdict.theorem and statuses.get(key) != status
    )
    faults = (f"{verdict.theorem}:{c.name} contradicts the proof {c.contradicts}" for c in verdict.contradictions)
    return (*difference_texts, *faults)


@cache
def catalogue() -> dict[str, Callable[..., Scenario]]:
    """Return the builder of each scenario by name, from the `SCENARIOS` of every source."""
    builders: dict[str, Callable[..., Scenario]] = {}
    for module in source_modules("scenarios"):
        builders |= getattr(module, "SCENARIOS", {})
    return dict(sorted(builders.items()))


def scenarios() -> tuple[str, ...]:
    """Return the names of the scenarios in the catalogue.

    Examples
    --------
    >>> "collapse" in scenarios()
    True
    """
    return tuple(catalogue())


def scenario(name: str, seed: int = 0, **options: Any) -> Scenario:
    """Return a scenario of the catalogue.

    Parameters
    ----------
    **options
        Options of that scenario by name; an unknown one is an error that lists those there are.

    Raises
    ------
    UnknownNameError
        If there is no such scenario.
    ArgumentError
        On a bad seed, an option that the scenario does not have, or more agents than memory holds.

    Examples
    --------
    >>> scenario("collapse", seed=1).name
    'collapse'
    """
    ensure_known("scenario", name, scenarios())
    builder = catalogue()[name]
    ensure_options(name, builder, options)
    return builder(seed=ensure_seed(seed), **options)
