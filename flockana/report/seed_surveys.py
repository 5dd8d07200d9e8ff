"""Runs of scenarios from many seeds, for the report's success shares, made in batches."""

from dataclasses import dataclass

from flockana.base.errors import ArgumentError
from flockana.ensemble.one_run import Job, Record, Request, run_batch
from flockana.scenarios import scenario, scenarios
from flockana.scenarios.option_checks import SOURCE

_AT_ONCE = 10  # runs in one survey: about a second at most, so that all processes end together


@dataclass(frozen=True)
class Survey:
    """Runs of one scenario over seeds, judged by its source's reports."""

    scenario: str
    seeds: tuple[int, ...]  # which runs

    @property
    def name(self) -> str:
        """Name of the survey shown in the progress display: scenario and seeds."""
        return f"{self.scenario}, seeds {self.seeds[0]} to {self.seeds[-1]}"


@dataclass(frozen=True)
class SurveyResult:
    """Survey of a scenario over seeds, with the record of each run."""

    survey: Survey  # which runs
    records: tuple[Record, ...]  # one of each seed

    @property
    def name(self) -> str:
        """Name of the survey shown in the progress display."""
        return self.survey.name


def surveys(name: str | None, count: int | None, *, seed: int = 0) -> tuple[Survey, ...]:
    """Return the surveys of the section on many seeds."""
    if name is None:
        default_seeds = {subject: scenario(subject, seed).seeds for subject in scenarios()}
        counts = {subject: most if count is None else count for subject, most in default_seeds.items() if most}
    elif not count:
        return ()
    elif name not in scenarios() or not scenario(name, seed).reports:
        expected = f"expected a scenario whose source reports an outcome, got {name}"
        raise ArgumentError(f"--seeds {count}: {expected}; leave --seeds out")
    else:
        counts = {name: count}
    return tuple(
        Survey(subject, tuple(range(first_seed, min(first_seed + _AT_ONCE, seed + most))))
        for subject, most in counts.items()
        for first_seed in range(seed, seed + most, _AT_ONCE)
    )


def make_survey(survey: Survey) -> SurveyResult:
    """Make and judge the runs of a survey in this process."""
    request = Request(survey.scenario, (SOURCE,), ())  # judged by the source's reports alone
    return SurveyResult(survey, run_batch(request, tuple(Job(seed) for seed in survey.seeds)))
