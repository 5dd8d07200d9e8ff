"""The figures of a run of zone-based flocking: what Jond's figures 5 to 9 show, and what its claims speak of."""

from __future__ import annotations

from matplotlib.figure import Figure

from flockana import plots
from flockana.dynamics.trajectory import Trajectory
from flockana.laws.bearing_distance import ZoneFlocking
from flockana.plots.series import has_metric
from flockana.report.figures import Picture
from flockana.report.image import png
from flockana.scenarios.findings import component_counts

LAWS = (ZoneFlocking,)


def pictures(trajectory: Trajectory) -> tuple[Picture, ...]:
    """Draw snapshots, paths, distances, speeds and inputs against their bounds, C R D, and dangers."""

    def drawn(draw: object, size: tuple[float, float]) -> str:
        return png(lambda figure: draw(figure, trajectory), size)  # type: ignore[operator]

    return (
        Picture(
            "Start, middle (where the flock is most split, or else nearest to an obstacle) and end. Lines join "
            "agents within a; triangles are the zones in which an agent heeds obstacles; a cross is the alien, "
            "which keeps to the tinted area; dashed circles are the buffers of the conventional method.",
            drawn(_snapshots, (13.0, 4.6)),
        ),
        Picture(
            "Paths of all agents; number of components of the net within a, which leaves 1 where the flock splits; "
            "mean number of agents in each zone of an agent.",
            drawn(_motion, (13.0, 3.8)),
        ),
        Picture(
            "Distances of all pairs with the radii of the zones; speeds; inputs; each with its bound.",
            drawn(_bounds, (13.0, 3.2)),
        ),
        Picture(
            "C = 1 where all move one way; R is the largest distance from the centre of mass; D the least distance of "
            "two agents; and how near obstacles (between the steps too), walls and aliens come.",
            drawn(_measures, (13.0, 3.0)),
        ),
    )


def _snapshots(figure: Figure, run: Trajectory) -> None:
    for k, sample in enumerate((0, _middle(run), -1)):
        ax = figure.add_subplot(1, 3, k + 1, projection="3d" if run.m == 3 else None)
        plots.zones(run, float(run.t[sample]), ax=ax)


def _middle(run: Trajectory) -> int:
    """Where a flock, once together, is most split; else where it is nearest to an obstacle; else half way in time."""
    counts = component_counts(run)
    if counts[0] == 1 and counts.max() > 1:
        return int(counts.argmax())
    near = has_metric(run, "obstacle_clearance")
    return int(run.metric("obstacle_clearance").argmin()) if near else len(run.t) // 2


def _motion(figure: Figure, run: Trajectory) -> None:
    plots.trajectories(run, ax=figure.add_subplot(1, 3, 1, projection="3d" if run.m == 3 else None))
    plots.components(run, ax=figure.add_subplot(1, 3, 2))
    plots.zone_populations(run, ax=figure.add_subplot(1, 3, 3))


def _bounds(figure: Figure, run: Trajectory) -> None:
    for ax, draw in zip(
        figure.subplots(1, 3), (plots.zone_distances, plots.zone_speeds, plots.zone_controls), strict=True
    ):
        draw(run, ax=ax)


def _measures(figure: Figure, run: Trajectory) -> None:
    axes = figure.subplots(1, 4)
    for ax, name in zip(axes, ("coordination", "cohesion_radius", "min_distance"), strict=False):
        plots.measure(run, name, ax=ax)
    plots.zone_safety(run, ax=axes[3])
