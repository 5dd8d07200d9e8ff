"""Figures of a run of zone-based flocking: Jond's figures 5 to 9 and the quantities of its claims."""

import numpy as np

from flockana.dynamics.trajectory import Trajectory
from flockana.measures.distance_profiles import pair_distance_profile
from flockana.report.charts import Chart, Curve, panels
from flockana.report.figures import Picture, effort, measured, speeds
from flockana.report.flock_stills import stills
from flockana.scenarios.report_claims import component_counts, has_metric
from flockana.sources.jond_2025.laws.zone_flocking import ZoneFlocking

_DANGER = "distance to obstacle, wall, alien (length)"
_DANGERS = (("obstacle_clearance_bound", "obstacle"), ("wall_distance", "wall"), ("alien_distance", "alien"))


def pictures(trajectory: Trajectory) -> tuple[Picture, ...]:
    """Draw a zone-based run: flock, distances, speeds, inputs, measures C, R and D, zone counts and dangers."""
    run, law = trajectory, trajectory.law
    radii = [(float(r), name) for r, name in zip(law.radii.reach, "rca", strict=True) if np.isfinite(r)]
    dangers = [Curve(run.metric(name), label) for name, label in _DANGERS if has_metric(run, name)]
    zones = [Curve(run.metric(f"in_{zone}"), zone) for zone in ("repulsion", "conflict", "attraction")]
    return (
        Picture(
            "Start, middle (where the flock is most split, or else nearest to an obstacle) and end. Lines join agents "
            "within a; a cross is the alien.",
            stills(run, run.t[[0, _middle(run), -1]].tolist()),
        ),
        Picture(
            "Distances of all pairs with the radii of the zones; speeds and control effort, each with its bound; mean "
            "number of agents in each zone of an agent.",
            panels(
                [
                    Chart("distances of pairs (length)", run.t, profile_curves(run), levels=radii),
                    speeds(run, [(float(law.desired_speed), "desired"), (float(law.v_max), "bound")]),
                    effort(run, [(float(law.u_max), "bound")]),
                    Chart("mean number of agents in the zone", run.t, zones),
                ]
            ),
        ),
        Picture(
            "C = 1 where all move one way; R is the largest distance from the centre of mass; components of the net "
            "within a, above 1 where the flock splits; and least distances from obstacles (between steps too), "
            "walls and aliens.",
            panels(
                [
                    *(measured(run, name) for name in ("coordination", "cohesion_radius") if has_metric(run, name)),
                    Chart("components of the net", run.t, (Curve(component_counts(run).astype(float)),)),
                    *([Chart(_DANGER, run.t, dangers, levels=[(0.0, "")])] if dangers else []),
                ]
            ),
        ),
    )


def profile_curves(run: Trajectory) -> tuple[Curve, ...]:
    """Return the curves of greatest, median and least distance of two agents."""
    smallest, _, median, _, greatest = pair_distance_profile(run.q).T
    return Curve(greatest, "greatest"), Curve(median, "median"), Curve(smallest, "least")


def _middle(run: Trajectory) -> int:
    """Return the sample to draw mid-run: the most split, else the nearest to an obstacle, else the middle one."""
    counts = component_counts(run)
    if counts[0] == 1 and counts.max() > 1:
        return int(counts.argmax())
    has_clearance = has_metric(run, "obstacle_clearance")
    return int(run.metric("obstacle_clearance").argmin()) if has_clearance else len(run.t) // 2


PICTURES = {ZoneFlocking: pictures}
