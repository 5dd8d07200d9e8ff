"""Figures: each function draws what it is given on an Axes, or on a new one, and returns it; it computes nothing."""

from flockana.plots.pair import action, potential
from flockana.plots.series import centre_of_mass, distances, energy, energy_residual, measure, panel, speeds
from flockana.plots.snapshot import configuration, snapshot
from flockana.plots.style import style
from flockana.plots.tracks import centre_path, trajectories

__all__ = [
    "action",
    "centre_of_mass",
    "centre_path",
    "configuration",
    "distances",
    "energy",
    "energy_residual",
    "measure",
    "panel",
    "potential",
    "snapshot",
    "speeds",
    "style",
    "trajectories",
]
