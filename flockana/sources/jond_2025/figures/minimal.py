"""Figures of a run of the minimal model: standard figures, and the profiles of Jond's Fig. 10."""

from flockana.dynamics.trajectory import Trajectory
from flockana.report.charts import Chart, panels
from flockana.report.figures import Picture, flock_pictures, measured, speeds
from flockana.sources.jond_2025.figures.zones import profile_curves
from flockana.sources.jond_2025.laws.minimal import DiscreteMinimalFlocking, MinimalFlocking


def pictures(trajectory: Trajectory) -> tuple[Picture, ...]:
    """Draw the standard figures of a run, with distances, speeds and alignment as in Fig. 10 of the paper."""
    caption = (
        "As in Fig. 10: distances of all pairs (greatest, median and least), which the paper says become constant; "
        "speeds of the agents; C = 1 where all move one way."
    )
    distance_chart = Chart("distances of pairs (length)", trajectory.t, profile_curves(trajectory))
    charts = [distance_chart, speeds(trajectory), measured(trajectory, "coordination")]
    return (*flock_pictures(trajectory), Picture(caption, panels(charts)))


PICTURES = {MinimalFlocking: pictures, DiscreteMinimalFlocking: pictures}
