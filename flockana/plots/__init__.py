"""Figures: each function draws what it is given on an Axes, or on a new one, and returns it; it computes nothing."""

from flockana.plots.animation import animate, animation
from flockana.plots.film import Film
from flockana.plots.lattice import barrier, collapse, collapse_brackets, defect_map
from flockana.plots.obstacles import obstacles
from flockana.plots.pair import action, potential
from flockana.plots.phase import phase_portrait
from flockana.plots.reynolds import rules
from flockana.plots.series import (
    centre_of_mass,
    clearances,
    components,
    distances,
    energy,
    energy_residual,
    measure,
    panel,
    speeds,
)
from flockana.plots.snapshot import configuration, snapshot
from flockana.plots.style import style, subplots
from flockana.plots.tracks import centre_path, trajectories

__all__ = [
    "Film",
    "action",
    "animate",
    "animation",
    "barrier",
    "centre_of_mass",
    "centre_path",
    "clearances",
    "collapse",
    "collapse_brackets",
    "components",
    "configuration",
    "defect_map",
    "distances",
    "energy",
    "energy_residual",
    "measure",
    "obstacles",
    "panel",
    "phase_portrait",
    "potential",
    "rules",
    "snapshot",
    "speeds",
    "style",
    "subplots",
    "trajectories",
]
