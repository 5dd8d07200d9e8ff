"""Figures: each function draws what it is given on an Axes, or on a new one, and returns it; it computes nothing."""

from flockana.plots.animation import animate, animation
from flockana.plots.control import bode, delay_chart, gain_sweep, norms, root_locus
from flockana.plots.dead_zone import dead_zone_energies, dead_zone_force
from flockana.plots.decay import linear_range, measured_gains
from flockana.plots.ensemble import distribution, phase_diagram, share_against, share_bars
from flockana.plots.falsify import falsification, search_history
from flockana.plots.film import Film
from flockana.plots.lattice import barrier, collapse, collapse_brackets, defect_map
from flockana.plots.minimal import perception
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
from flockana.plots.stability import animate_mode, mode_shape, mode_title, pole_map
from flockana.plots.style import style, subplots
from flockana.plots.tracks import centre_path, trajectories
from flockana.plots.zones import (
    zone_controls,
    zone_distances,
    zone_populations,
    zone_safety,
    zone_speeds,
    zones,
)

__all__ = [
    "Film",
    "action",
    "animate",
    "animate_mode",
    "animation",
    "barrier",
    "bode",
    "centre_of_mass",
    "centre_path",
    "clearances",
    "collapse",
    "collapse_brackets",
    "components",
    "configuration",
    "dead_zone_energies",
    "dead_zone_force",
    "defect_map",
    "delay_chart",
    "distances",
    "distribution",
    "energy",
    "energy_residual",
    "falsification",
    "gain_sweep",
    "linear_range",
    "measure",
    "measured_gains",
    "mode_shape",
    "mode_title",
    "norms",
    "obstacles",
    "panel",
    "perception",
    "phase_diagram",
    "phase_portrait",
    "pole_map",
    "potential",
    "root_locus",
    "rules",
    "search_history",
    "share_against",
    "share_bars",
    "snapshot",
    "speeds",
    "style",
    "subplots",
    "trajectories",
    "zone_controls",
    "zone_distances",
    "zone_populations",
    "zone_safety",
    "zone_speeds",
    "zones",
]
