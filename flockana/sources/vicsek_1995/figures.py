"""Figures of a run of averaged headings."""

import numpy as np

from flockana.dynamics.trajectory import Trajectory
from flockana.measures.connectivity_windows import windows_of
from flockana.report.charts import Chart, panels
from flockana.report.figures import Picture, measured, spread
from flockana.report.flock_stills import stills
from flockana.scenarios.report_claims import has_metric
from flockana.sources.vicsek_1995.laws import HeadingAveraging

_SETTLED = 1e-3  # of the first span of headings: until it falls below there is something to see


def pictures(trajectory: Trajectory) -> tuple[Picture, ...]:
    """Draw the flock at start, middle and end, and its headings, connectivity and heading span over time."""
    early_run = trajectory.window(float(trajectory.t[0]), _until(trajectory))
    times = float(trajectory.t[0]), float(early_run.t[len(early_run.t) // 2]), float(trajectory.t[-1])
    windows = windows_of(trajectory)
    longest = max((stop - start for start, stop in windows), default=0)
    return (
        Picture(
            "Start, middle and end of the time until headings agree or the run ends. Links join agents in or on each "
            "other's circle.",
            stills(trajectory, times),
        ),
        Picture(
            "Headings: none leaves the range of the earlier ones. C = 1 where the net is connected: the nets "
            f"are jointly connected over each of {len(windows)} contiguous windows, the longest of {longest} steps.",
            panels(
                [
                    Chart("heading (radians)", early_run.t, spread(early_run.extra["heading"])),
                    *(measured(early_run, name) for name in ("connectivity",) if has_metric(early_run, name)),
                    measured(trajectory, "heading_spread"),
                ]
            ),
        ),
    )


def _until(run: Trajectory) -> float:
    """Return the last time at which headings visibly differ, or the end of the first windows if later."""
    span = run.metric("heading_spread")
    late_samples = np.flatnonzero(span > _SETTLED * span[0])
    windows = windows_of(run)[:4]
    last_sample = max([int(late_samples[-1]) if late_samples.size else 0, *(stop for _, stop in windows), 1])
    return float(run.t[min(last_sample, len(run.t) - 1)])


PICTURES = {HeadingAveraging: pictures}
