"""Scenarios of Jadbabaie, Lin and Morse: two groups that meet and agree, and two that separate."""

import numpy as np

from flockana.base.value_checks import FloatArray
from flockana.scenarios.one_start import RANGE, SPEED, LawEntry
from flockana.scenarios.report_claims import Claim, Tolerances, Trajectory, finding, limit_report, report
from flockana.scenarios.scenario_builders import Builder, Report, Start, Status, entry, vacuous, verified
from flockana.sources.vicsek_1995.laws import HeadingAveraging
from flockana.sources.vicsek_1995.theorems.heading_averages import permanently_connected, permanently_separated

_REFERENCES = ("jadbabaie-lin-morse-2003", "flockana")
_SIZE = 0.7  # spacing of a group's agents over r
_SHAKEN = 0.05  # of r and of a radian: what chance adds to each coordinate and heading of a start


def _group(centre: float, heading: float, generator: np.random.Generator) -> tuple[FloatArray, FloatArray]:
    """Return positions and headings of two by three agents on a perturbed grid, nearly aligned."""
    grid = _SIZE * np.array([[x, y] for x in (-0.5, 0.5) for y in (-1.0, 0.0, 1.0)]) + (centre, 0.0)
    start_noise = generator.uniform(-_SHAKEN, _SHAKEN, (len(grid), 3))
    return grid + start_noise[:, :2], heading + start_noise[:, 2]


def _last(run: Trajectory) -> tuple[HeadingAveraging, FloatArray, FloatArray]:
    return run.law, run.q[-1], run.extra["heading"][-1]


@report("apart-at-first", "the net is not connected at every instant")
def _apart_at_first(run: Trajectory, tolerances: Tolerances) -> Claim:
    steps = int(np.sum(run.metric("connectivity") < 1.0))
    text = f"the net is not connected at {steps} of {len(run.t)} instants"
    return finding(steps - 0.5, text, computed=steps, stated="at some")


@report("one-flock", "all headings agree in the end")
def _agrees(run: Trajectory, tolerances: Tolerances) -> Claim:
    end = float(np.ptp(run.extra["heading"][-1]))
    text = f"headings differ by {end:.2g} at the end"
    return limit_report(permanently_connected(*_last(run)), text, computed=end, stated="one heading")


@report("two-flocks", "the groups never meet again, their headings never agree")
def _never_agrees(run: Trajectory, tolerances: Tolerances) -> Claim:
    heading = run.extra["heading"][-1]
    text = f"headings differ by {np.ptp(heading):.3g} radians at the end"
    return limit_report(permanently_separated(*_last(run)), text, computed=float(np.ptp(heading)))


def _build(name: str, title: str, heading: float, steps: int, expected: dict[str, Status], *reports: Report) -> Builder:
    source_text = (
        "Ours, on Jadbabaie, Lin and Morse's model: two groups of two by three agents, 0.7 r apart within a group, "
        "3 r between the centres, headings mirrored, each coordinate and heading shaken by up to 0.05."
    )
    law = HeadingAveraging(range=1.0, speed=0.05, dt=1.0)

    def two_groups(seed: int) -> Start:
        """Return a group on the left with a heading, and one on the right with the mirrored heading."""
        generator = np.random.default_rng(seed)
        left, right = _group(-1.5, heading, generator), _group(1.5, np.pi - heading, generator)
        return np.vstack([left[0], right[0]]), law.velocities(np.concatenate([left[1], right[1]]))

    return entry(name, title, source_text, law, two_groups, float(steps), expected, reports, references=_REFERENCES)


_MEET, _PART = verified("jlm-headings"), verified("jlm-headings:hull")
_MEET |= verified("jlm-headings:contraction", "jlm-headings:agreement", "source")
_PART |= vacuous("jlm-headings:contraction", "jlm-headings:agreement") | verified("source")
_MEETING = "Two groups meet: linked together over a long window, then at every step"
_PARTING = "Two groups separate: never linked together, two headings permanently"
SCENARIOS = {
    "headings-meet": _build("headings-meet", _MEETING, 1.2, 400, _MEET, _apart_at_first, _agrees),
    "headings-part": _build("headings-part", _PARTING, 2.0, 100, _PART, _never_agrees),
}


ONE_START = (
    LawEntry(
        "Averaged headings",
        lambda q, p: HeadingAveraging(range=RANGE, speed=SPEED, dt=0.1),
        "jlm-headings",
        "headings agree if the nets are jointly connected over one bounded window of time after the other",
        "verified",
    ),
)
