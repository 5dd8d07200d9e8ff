"""The figures of a run of the minimal model: those of any flock, and the two profiles of Jond's Fig. 10."""

from __future__ import annotations

from matplotlib.figure import Figure

from flockana import plots
from flockana.dynamics.trajectory import Trajectory
from flockana.laws.minimal import DiscreteMinimalFlocking, MinimalFlocking
from flockana.report.figures import Picture, flock_pictures
from flockana.report.image import png

LAWS = (MinimalFlocking, DiscreteMinimalFlocking)


def pictures(trajectory: Trajectory) -> tuple[Picture, ...]:
    """Draw what is drawn of any flock, and distances of all pairs, speeds and alignment, as Fig. 10 does."""
    caption = (
        "As in Fig. 10: distances of all pairs (all, the middle half, median and least), which are "
        "said to come to rest; speeds of all agents; C = 1 where all move one way."
    )
    return (
        *flock_pictures(trajectory),
        Picture(caption, png(lambda figure: _profiles(figure, trajectory), (13.0, 3.2))),
    )


def _profiles(figure: Figure, run: Trajectory) -> None:
    axes = figure.subplots(1, 3)
    plots.pair_distances(run, ax=axes[0])
    plots.speeds(run, ax=axes[1])
    plots.measure(run, "coordination", ax=axes[2])
