"""Simulations of Jond's bearing-distance paper, sections 5.1 and 5.2: literal, charitable and recommended.

The letter is Algorithm 1 as typeset with the printed parameters: what the paper leaves open is ours and said so. The
charitable reading has the same parameters and starts and takes of every ambiguity the side that harms least. The
recommended runs are what reaches the reported figures: plain clips, true velocities, all agents at once, gains in
front of the two means, and starts that do not violate the claim already. The narrow gap is ours: the paper says that
a flock passes one that the conventional method, which wraps obstacles in discs, would close.
"""

from collections.abc import Callable
from typing import Any

import numpy as np
import numpy.typing as npt

from flockana.base.value_checks import FloatArray
from flockana.base.vector_norms import lengths
from flockana.dynamics.trajectory import Trajectory
from flockana.environment.polygon import SimplePolygon
from flockana.measures.metrics import diameters
from flockana.measures.nets import components, links
from flockana.scenarios.lazy_start import lazy_state
from flockana.scenarios.report_claims import component_counts, finding, in_source_units, report
from flockana.scenarios.scenario_builders import Builder, Report, Start, Status, entry, inconclusive, refuted, verified
from flockana.sources.jond_2025.environment.zone_obstacles import Box
from flockana.sources.jond_2025.environment.zone_world import Alien, ZoneWorld
from flockana.sources.jond_2025.interactions.zones import ZoneRadii, ZoneWeights
from flockana.sources.jond_2025.laws.zone_flocking import ZoneFlocking
from flockana.sources.jond_2025.theorems.random_starts import zone_start
from flockana.theorems import Claim, Tolerances

N, AREA, SPEED = 10, 10.0, 3.0
SAFE, IN_ORDER = 1.5, 0.99  # m; what counts as C = 1
_NEAR = 0.05  # a mean speed this close, relative, is "about" the desired one
_KEPT = 1e-11  # relative: a bound that is reached is kept, but for rounding
FREE, WATCHFUL = ZoneRadii(1.5, c=3.0, a=5.0), ZoneRadii(1.5, c=3.0, a=5.0, s=6.0)
STRONG = ZoneWeights(separation=20.0, obstacle=20.0, cohesion_gain=0.5, alignment_gain=4.0)
_TRIANGLE = SimplePolygon([(8.0, 22.0), (24.0, 24.0), (14.0, 42.0)])
_IRREGULAR = SimplePolygon([(30.0, 20.0), (38.0, 17.0), (45.0, 24.0), (44.0, 33.0), (36.0, 36.0), (29.0, 29.0)])
BOX = Box((0.0, 0.0), (50.0, 50.0))
_SLAB = SimplePolygon([(36.0, 14.0), (44.0, 12.0), (45.5, 25.0), (45.0, 38.0), (38.0, 36.0), (40.0, 25.0)])
_WORLD = ZoneWorld((_IRREGULAR,), BOX, (Alien(np.mean(_TRIANGLE.vertices, axis=0), _TRIANGLE),))
GAP = ZoneWorld((_SLAB,), BOX)


def _late(run: Trajectory, values: FloatArray, since: float) -> FloatArray:
    """Return the values of a series after a time; NaN for a run with an earlier end."""
    is_late = values[run.t > since - 0.5 * run.law.dt]
    return is_late if is_late.size else np.array([np.nan])


@report("distances", "the agents stay more than 1.5 m apart throughout")
def distances(run: Trajectory, tolerances: Tolerances) -> Claim:
    """Claim that no two agents come nearer than 1.5 m."""
    near = run.metric("min_distance")
    k = int(np.argmin(near))
    text = f"the least distance is {near[0]:.3g} at the start and {near[k]:.3g} at worst, at t = {run.t[k]:.3g}"
    return finding(near[k] - SAFE, text, computed=float(near[k]), stated="> 1.5", witness=float(run.t[k]))


@report("coordination", "perfect order of the directions within 2 s, and kept")
def _coordination(run: Trajectory, tolerances: Tolerances) -> Claim:
    c = _late(run, run.metric("coordination"), 2.0)
    text = f"from t = 2 on C is {c.min():.4f} or more, and {c[-1]:.4f} at the end"
    return finding(c.min() - IN_ORDER, text, computed=float(c.min()), stated="1, that is >= 0.99")


@report("radius", "the cohesive radius is stable from about 5 s on")
def _radius(run: Trajectory, tolerances: Tolerances) -> Claim:
    r = _late(run, run.metric("cohesion_radius"), 5.0)
    ratio = float(r.max() / r.min())
    text = f"from t = 5 on the cohesive radius lies between {r.min():.3g} and {r.max():.3g}"
    stated_text = f"stable (by a factor of {tolerances.cohesion:g})"
    return finding(tolerances.cohesion - ratio, text, computed=ratio, stated=stated_text)


@report("speed", "the mean speed is close to the desired 3 m/s")
def keeps_speed(run: Trajectory, tolerances: Tolerances) -> Claim:
    """Claim that the mean speed is the desired one."""
    mean = float(_late(run, lengths(run.p).mean(axis=1), 5.0).mean())
    text = f"the mean speed from t = 5 on is {mean:.3f}"
    return finding(_NEAR * SPEED - abs(mean - SPEED), text, computed=mean, stated="about 3")


@report("bounds", "speeds and inputs keep within their bounds")
def bounds(run: Trajectory, tolerances: Tolerances) -> Claim:
    """Claim that speeds and inputs keep their bounds."""
    speed, force = (float(lengths(x).max()) for x in (run.p, run.u))
    margin = min(1.0 + _KEPT - x / bound for x, bound in ((speed, run.law.v_max), (force, run.law.u_max)))
    text = f"the largest speed is {speed:.4g} of {run.law.v_max:g}, the largest input {force:.4g} of {run.law.u_max:g}"
    return finding(margin, text, computed=(speed, force), stated=(run.law.v_max, run.law.u_max))


def _apart_after_together(run: Trajectory) -> tuple[npt.NDArray[np.int64], int]:
    """Return component counts over time, and the first sample at which a once connected flock is split, or -1."""
    counts = component_counts(run)
    joined_samples = np.flatnonzero(counts == 1)
    split_samples = np.flatnonzero(counts[joined_samples[0] :] > 1) if joined_samples.size else joined_samples
    return counts, int(joined_samples[0] + split_samples[0]) if split_samples.size else -1


@report("fragments", "the alien breaks the flock up for a while")
def _fragments(run: Trajectory, tolerances: Tolerances) -> Claim:
    counts, k = _apart_after_together(run)
    when = "never apart after having been together" if k < 0 else f"together, then apart from t = {run.t[k]:.3g} on"
    text = f"{when}; up to {counts.max()} components, together at {np.mean(counts == 1):.0%} of the samples"
    return finding(-0.5 if k < 0 else 0.5, text, computed=int(counts.max()), stated="apart for a while")


@report("reunites", "the flock reunites")
def _reunites(run: Trajectory, tolerances: Tolerances) -> Claim:
    counts, k = _apart_after_together(run)
    again = k >= 0 and bool((counts[k:] == 1).any())
    text = f"{'one component again' if again else 'not one component'} after it fell apart; {counts[-1]} at the end"
    return finding(0.5 if again else -0.5, text, computed=int(counts[-1]), stated="one flock again")


@report("range", "distances reach up to 10 m when the flock is cohesive")
def _range(run: Trajectory, tolerances: Tolerances) -> Claim:
    is_connected = component_counts(run) == 1
    if not is_connected.any():
        return finding(float("nan"), "the flock is never cohesive", stated="up to 10 when cohesive")
    spans = diameters(run.q[is_connected])
    text = f"while the flock is one component its largest distance is {spans.min():.3g} to {spans.max():.3g}"
    maximum = float(spans.max())
    return finding(10.0 - maximum, text, computed=maximum, stated="up to 10 when cohesive")


@report("contained", "the agents stay in the box and off the obstacle")
def contained(run: Trajectory, tolerances: Tolerances) -> Claim:
    """Claim that no agent leaves the box or enters the obstacle."""
    wall, solid = (float(run.metric(name).min()) for name in ("wall_distance", "obstacle_clearance_bound"))
    text = (
        f"the least distance from a wall is {wall:.3g}, from the obstacle {solid:.3g} "
        "(negative: beyond a wall, or inside the obstacle)"
    )
    return finding(min(wall, solid), text, computed=(wall, solid), stated="> 0, between the steps too")


def passed(run: Trajectory) -> int:
    """Return the number of agents that pass the gap between slab and wall upwards."""
    corners = np.array(_SLAB.vertices)
    x, y = run.q[:, :, 0], run.q[:, :, 1]
    is_inside = (x > corners[:, 0].max()) & (y > corners[:, 1].mean())
    first_passage = np.where(is_inside.any(axis=0), is_inside.argmax(axis=0), len(run.t))
    return sum(bool((y[k:, i] > corners[:, 1].max()).any()) for i, k in enumerate(first_passage))


@report("passes", "the flock passes a narrow gap beside the obstacle")
def _passes(run: Trajectory, tolerances: Tolerances) -> Claim:
    count = passed(run)
    text = f"{count} of {run.n} agents pass between the obstacle and the wall"
    return finding(count - run.n + 0.5, text, computed=count, stated=f"all {run.n}")


@report("blocked", "with circular buffer zones none passes")
def _blocked(run: Trajectory, tolerances: Tolerances) -> Claim:
    count = passed(run)
    return finding(0.5 - count, f"{count} of {run.n} agents pass", computed=count, stated="none")


OPEN = (distances, _coordination, _radius, keeps_speed, bounds)
_CLOSED = (_fragments, _reunites, _range, distances, keeps_speed, bounds, contained)
THROUGH = (_passes, bounds, contained)


def apart(seed: int) -> Start:
    """Return the paper's random start, redrawn until all distances exceed 2 m and the net is connected."""
    return lazy_state((N, 2), lambda: _drawn_apart(seed))


def _drawn_apart(seed: int, least: float = 2.0) -> Start:
    """Return the printed start, redrawn until distances exceed `least` and the net is connected."""
    rng = np.random.default_rng(seed)
    while True:
        q = rng.uniform(0.0, AREA, (1, 2))
        for x in rng.uniform(0.0, AREA, (50 * N, 2)):
            if len(q) < N and np.linalg.norm(q - x, axis=1).min() > least:
                q = np.vstack([q, x])
        if len(q) == N and not components(N, links(q, FREE.reach[2])).any():
            return q, rng.uniform(0.0, 1.0, (N, 2))


def in_column(seed: int, n: int = 5) -> Start:
    """Return a column of agents heading up between the slab and the right wall."""
    rng = np.random.default_rng(seed)
    height = 1.5 + 2.1 * np.arange(n)[::-1] + rng.uniform(-0.1, 0.1, n)
    q = np.column_stack([rng.uniform(47.5, 48.0, n), height])
    return q, np.column_stack([rng.uniform(-0.2, 0.2, n), SPEED + rng.uniform(-0.2, 0.2, n)])


PRINTED = "n = 10, r = 1.5, c = 3, w^ls = 5, w^lc = 0.75, w^la = 0.25, w^ga = 5, v^d = 3, v^max = 4, dt = 0.1. "
_LETTER = (
    "The least charitable reading: agents move one after the other, (9) and (10) as they stand, the estimate (17), "
    "aliens at a < d <= s, three segments, d - c, no way out of an obstacle; walls and edges are summed, as (21) says. "
)
_CHARITABLE = (
    "The charitable reading of the same: all agents at once, a plain clip of the speed, the true velocity, aliens at "
    "0 < d <= s, the whole triangle, min(0, d - c), pushed out of obstacles, each wall counts; gains 1, as printed. "
)
_OWN = "Gains, plain clips and starts more than 2 m apart and connected are ours. "
_PLACE = "Obstacle, the alien's speed and triangle, and the half base 0.5 c of the obstacle zone are ours. "
_FIGURE_5, _FIGURE_8 = (0.1, 7.5, 15.0, 20.0), (0.1, 12.5, 25.0, 37.5, 50.0, 75.0, 87.5, 100.0)
_SECTIONS = {  # title, place, end, reports, instants
    "51": ("section 5.1, open plane", "", 20.0, OPEN, _FIGURE_5),
    "52": ("section 5.2, obstacle, box and alien", _PLACE, 100.0, _CLOSED, _FIGURE_8),
}
_READINGS = {  # title, text, start, seeds, settings
    "-printed": ("by the letter", _LETTER, zone_start, 200, "printed settings"),
    "-charitable": ("charitably read", _CHARITABLE, zone_start, 25, "printed settings, charitably read"),
    "": ("as recommended", _OWN, apart, 200, "recommended settings"),
}


def zone_entry(
    name: str,
    title: str,
    source: str,
    law: ZoneFlocking,
    draw: Callable[[int], Start],
    end: float,
    expected: dict[str, Status],
    reports: tuple[Report, ...],
    *,
    as_it_is: tuple[Report, ...] = (),
    settings: str = "recommended settings",
    seeds: int = 25,
    **fields: Any,
) -> Builder:
    """Return the builder of a scenario of the bearing-distance paper, with its reports."""
    title, source = f"Bearing-distance flocking: {title}", f"Jond, bearing-distance flocking: {source}"
    judged = as_it_is + in_source_units(lambda: law.scales, reports)
    fields |= {"references": ("jond-2025",), "settings": settings, "seeds": seeds if settings else 0}
    return entry(name, title, source, law, draw, end, expected, judged, **fields)


def _read(name: str, parameters: str, law: ZoneFlocking, expected: dict[str, Status]) -> Builder:
    """Return the scenario builder for a section of the paper under a given reading, both by name."""
    place_text, place_note, end, reports, instants = _SECTIONS[name[5:7]]
    description, text, draw, seeds, settings = _READINGS[name[7:]]
    title, source_text = f"{place_text}, {description}", f"{PRINTED}{parameters}. {text}{place_note}"
    entry_options: dict[str, Any] = {"seeds": seeds, "settings": settings, "instants": instants}
    return zone_entry(name, title, source_text, law, draw, end, expected, reports, **entry_options)


_UNITS = ZoneWeights(cohesion_gain=1.0, alignment_gain=1.0)
_AS_PRINTED = "a = 5, s = 6, w^ss = w^oa = 5, u^max = 2"
# statuses that hold at every seed (all of 400); for the others the report gives shares of seeds
_CASES: dict[str, tuple[str, ZoneFlocking, dict[str, Status]]] = {
    "zone-51-printed": (
        "a = 5, u^max = 2",
        ZoneFlocking.printed(FREE),
        refuted("source", "source:distances", "source:coordination", "source:radius", "source:speed")
        | verified("source:bounds"),
    ),
    "zone-51-charitable": (
        "a = 5, u^max = 2",
        ZoneFlocking(FREE, _UNITS),
        refuted("source", "source:coordination") | verified("source:speed", "source:bounds"),
    ),
    "zone-51": (
        "a = 5, u^max = 2, gains 0.25 and 8",
        ZoneFlocking(FREE),
        verified("source:distances", "source:speed", "source:bounds"),
    ),
    "zone-52-printed": (
        _AS_PRINTED,
        ZoneFlocking.printed(WATCHFUL, world=_WORLD),
        refuted("source", "source:speed") | verified("source:bounds") | refuted("source:contained"),
    ),
    "zone-52-charitable": (
        _AS_PRINTED,
        ZoneFlocking(WATCHFUL, _UNITS, _WORLD),
        inconclusive("source", "source:bounds"),  # orbits part within 70 s
    ),
    "zone-52": (
        "a = 5, s = 6, w^ss = 5; w^ls = w^oa = 20, u^max = 10, gains 0.5 and 4",
        ZoneFlocking(WATCHFUL, STRONG, _WORLD, u_max=10.0),
        inconclusive("source", "source:bounds"),
    ),
}
SCENARIOS: dict[str, Builder] = {name: _read(name, *case) for name, case in _CASES.items()} | {
    "zone-gap": zone_entry(
        "zone-gap",
        "a gap of 4.5 m, directed obstacle zones",
        "Section 5.2's claim in a place of our own: 5 agents as in zone-52, a slab beside the wall.",
        ZoneFlocking(FREE, STRONG, GAP, u_max=10.0),
        in_column,
        30.0,
        verified("source"),
        THROUGH,
        seeds=200,
    ),
    "zone-gap-buffer": zone_entry(
        "zone-gap-buffer",
        "the same gap, circular buffer zones",
        "The method that section 5.2 compares with: zone-gap, with the slab in its smallest disc.",
        ZoneFlocking(FREE, STRONG, GAP, u_max=10.0, obstacle_zone="buffer"),
        in_column,
        30.0,
        verified("source"),
        (_blocked, bounds, contained),
        seeds=200,
    ),
}
