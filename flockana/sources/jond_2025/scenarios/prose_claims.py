"""Prose statements of Jond's bearing-distance paper, each tested on a run.

None of these is simulated in the paper. Starts and settings are those of its section 5.1 or ours; each text says so.
"""

from dataclasses import replace

import numpy as np

from flockana.base.errors import ArgumentError
from flockana.base.value_checks import ensure_count
from flockana.base.vector_norms import lengths
from flockana.scenarios.lazy_start import lazy_state
from flockana.scenarios.report_claims import Claim, Tolerances, Trajectory, component_counts, finding, report, rerun
from flockana.scenarios.scenario_builders import Builder, Scenario, Start, inconclusive, verified
from flockana.sources.jond_2025.environment.zone_world import Alien, ZoneWorld
from flockana.sources.jond_2025.interactions.zone_noise import ZoneNoise
from flockana.sources.jond_2025.interactions.zones import ZoneRadii, ZoneWeights
from flockana.sources.jond_2025.laws.zone_flocking import ZoneFlocking
from flockana.sources.jond_2025.scenarios.published_runs import (
    BOX,
    FREE,
    GAP,
    OPEN,
    STRONG,
    THROUGH,
    N,
    apart,
    bounds,
    distances,
    in_column,
    keeps_speed,
    zone_entry,
)
from flockana.sources.jond_2025.theorems.random_starts import crowd_start, zone_start

_UNBOUNDED = 1e6  # an input bound that never acts
_INFORMED = 2
_HAZARD = (12.0, 15.0, 20.0)  # w^ss of three agents that meet an alien
_GIVES_WAY = ((2.0, 20.0), (20.0, 2.0))  # w^ls of each of a pair
_DRIVE, _SPEED, _SEEN = 10.0, 3.0, 6.0  # w^ga, v^d, s
_OFF, _LANES = 20.0, (-20.0, -35.0)  # how far from the alien they begin, and where the pairs meet
_AS_FAR = 1e-3  # of s: how exactly an agent keeps its distance
_MOVED = 1e-3  # of a: what counts as another run


@report("together", "the flock is one component at the end")
def _together(run: Trajectory, tolerances: Tolerances) -> Claim:
    counts = component_counts(run)
    text = f"{counts[-1]} components at the end, {counts.max()} at most, {counts[0]} at the start"
    return finding(1.5 - counts[-1], text, computed=int(counts[-1]), stated="one flock at the end")


@report("reunites", "in a box fragments eventually reunite")
def _reunites(run: Trajectory, tolerances: Tolerances) -> Claim:
    whole = np.flatnonzero(component_counts(run) == 1)
    when = f"one flock first at t = {run.t[whole[0]]:.4g}" if whole.size else f"never one flock by t = {run.t[-1]:.4g}"
    return finding(0.5 if whole.size else -0.5, when, computed=bool(whole.size), stated="one flock again")


@report("contained", "the agents stay in the box")
def _walled(run: Trajectory, tolerances: Tolerances) -> Claim:
    wall = float(run.metric("wall_distance").min())
    text = f"the least distance from a wall is {wall:.3g} (negative: beyond)"
    return finding(wall, text, computed=wall, stated="> 0")


@report("hazards", "each agent keeps the distance from an alien that its own weight gives")
def _distance_from_alien(run: Trajectory, tolerances: Tolerances) -> Claim:
    gaps = lengths(run.q[:, : len(_HAZARD)] - run.extra["alien"][:, :1]).min(axis=0)
    stated_gaps = _SEEN - _SPEED * _DRIVE / np.array(_HAZARD)
    deviation = float(np.abs(gaps - stated_gaps).max()) / _SEEN
    text = f"agents with w^ss = 12, 15, 20 keep {', '.join(f'{gap:.3f}' for gap in gaps)} m from the alien, as s - v^d "
    return finding(_AS_FAR - deviation, text + "w^ga/w^ss has it", computed=gaps.tolist(), stated=stated_gaps.tolist())


@report("gives-way", "of two agents that meet, the one with the larger weight for the other gives way")
def _right_of_way(run: Trajectory, tolerances: Tolerances) -> Claim:
    """Report that after a head-on meeting both move the way of the agent with less separation weight."""
    end = run.p[-1, len(_HAZARD) :, 0].reshape(-1, 2)
    order_signs = np.array([1.0 if first < second_weight else -1.0 for first, second_weight in _GIVES_WAY])
    slowest = float((end * order_signs[:, None]).min()) / _SPEED
    text = "; ".join(
        f"w^ls = {w[0]:g}, {w[1]:g}: both at {v[0]:.3g}, {v[1]:.3g}" for w, v in zip(_GIVES_WAY, end, strict=True)
    )
    return finding(slowest - 0.5, text, computed=end.tolist(), stated="the agent with the larger weight turns round")


@report("repeats", "the same seed gives the same run")
def _repeats(run: Trajectory, tolerances: Tolerances) -> Claim:
    if "step" in run.extra and run.extra["step"][0] != 0.0:
        return finding(float("nan"), "the run does not begin with step 0", stated="the same to the bit")
    first_end, second_end = (rerun(run, run.law).q[-1] for _ in range(2))
    same = bool((first_end == second_end).all())
    text = f"a second run ends {'the same to the bit' if same else 'elsewhere'}"
    return finding(0.5 if same else -0.5, text, stated="the same to the bit")


@report("unpredictable", "chance makes motions less predictable")
def _unpredictable(run: Trajectory, tolerances: Tolerances) -> Claim:
    reseeded_law = replace(run.law, noise=replace(run.law.noise, seed=run.law.noise.seed + 1))
    end = rerun(run, reseeded_law).q[-1]
    distance = float(np.linalg.norm(end - run.q[-1], axis=1).max()) / float(np.max(run.law.radii.a))
    text = f"with another seed of the noise an agent ends {distance:.3g} a from where it ends here"
    return finding(distance - _MOVED, text, computed=distance, stated="less predictable motions")


def _two_fragments(seed: int) -> Start:
    """Return five agents on the left and five on the right of the box, moving apart."""
    rng = np.random.default_rng(seed)
    side = np.repeat([-1.0, 1.0], N // 2)
    x = 25.0 + side * rng.uniform(5.0, 13.0, N)
    q = np.column_stack([x, rng.uniform(20.0, 30.0, N)])
    return q, np.column_stack([_SPEED * side, np.zeros(N)]) + rng.uniform(-0.2, 0.2, (N, 2))


def _head_on(seed: int) -> Start:
    """Return three agents heading for the origin, and far away two pairs heading for each other."""
    directions = np.array([[-1.0, 0.0], [1.0, 0.0], [0.0, 1.0]])
    pairs = [(x, y) for y in _LANES for x in (-10.0, 10.0)]
    velocities = [(direction * _SPEED, 0.0) for _ in _LANES for direction in (1.0, -1.0)]
    return np.vstack([_OFF * directions, pairs]), np.vstack([-_SPEED * directions, velocities])


def _own_weights() -> ZoneFlocking:
    n = len(_HAZARD) + 2 * len(_GIVES_WAY)
    separation = np.full((n, n), 5.0)
    for k, (first_weight, second_weight) in enumerate(_GIVES_WAY):
        i = len(_HAZARD) + 2 * k
        separation[i, i + 1], separation[i + 1, i] = first_weight, second_weight
    aliens = (Alien((0.0, 0.0), detection=1e-3),)
    weights = ZoneWeights(
        separation=tuple(map(tuple, separation.tolist())),
        speed=_DRIVE,
        alien=tuple((w,) for w in (*_HAZARD, *[5.0] * (n - len(_HAZARD)))),
        cohesion_gain=0.0,
        alignment_gain=0.0,
    )
    return ZoneFlocking(ZoneRadii(1.5, c=3.0, a=5.0, s=_SEEN), weights, ZoneWorld(aliens=aliens), u_max=_UNBOUNDED)


def _informed(seed: int = 0, informed: int = _INFORMED) -> Scenario:
    count = ensure_count("informed", informed)
    if count > N:
        raise ArgumentError(f"informed = {count}: expected 1 to {N}, the number of agents")
    weights = ZoneWeights(speed=tuple([5.0] * count + [0.0] * (N - count)))
    title = f"{count} of {N} agents are informed of the desired speed"
    source_text = (
        "section 2.1 says that neighbours adjust and a new global speed results; start and settings as zone-51, "
        "w^ga = 0 for those that are not informed, 60 s (J14)."
    )
    law, expected, reports = ZoneFlocking(FREE, weights), verified("source:bounds"), (keeps_speed, _together, bounds)
    return zone_entry("zone-51-informed", title, source_text, law, apart, 60.0, expected, reports)(seed)


def _scaled(seed: int = 0, n: int = 500) -> Scenario:
    agent_count = ensure_count("n", n)
    source_text = (
        "the abstract calls the flocking scalable. Settings of zone-51; n agents, 500 if not given, as dense as the "
        "ten of section 5.1 and more than 2 m apart, velocities in (0, 1) (J18)."
    )
    expected, reports = verified("source:speed", "source:bounds"), (*OPEN[1:], distances, _together)

    def draw(seed: int) -> Start:
        return lazy_state((agent_count, 2), lambda: crowd_start(seed, agent_count))

    title, law = f"{agent_count} agents", ZoneFlocking(FREE)
    return zone_entry("zone-scaled", title, source_text, law, draw, 20.0, expected, reports, settings="")(seed)


def _noisy(seed: int = 0, weights: float = 0.5, velocities: float = 0.1) -> Scenario:
    title = "stochastic weights and perturbed velocities"
    source_text = (
        "the conclusions propose stochastic weights and random perturbations in velocities. Settings of zone-51; in "
        f"each step each weight is multiplied by a number in 1 ± {weights:g}, and each component of a velocity gets "
        f"{velocities:g} m/s (standard deviation), both ours; the scenario's seed is that of the noise too."
    )
    law = ZoneFlocking(FREE, noise=ZoneNoise(weights=weights, velocities=velocities, seed=seed))
    reports, as_it_is = (_unpredictable, *OPEN), (_repeats,)
    expected = verified("source:repeats", "source:unpredictable", "source:speed", "source:bounds")
    builder = zone_entry("zone-51-noisy", title, source_text, law, apart, 20.0, expected, reports, as_it_is=as_it_is)
    return builder(seed)


_UNITS = ZoneWeights(cohesion_gain=1.0, alignment_gain=1.0)
SCENARIOS: dict[str, Builder] = {
    "zone-51-informed": _informed,
    "zone-51-growing": zone_entry(
        "zone-51-growing",
        "section 5.1 with Remark 2: radii of attraction grow until a flockmate is found",
        "Remark 2, without its box: parameters and start of section 5.1, charitably read, and a_i that grows by 10 m/s "
        "(ours) while nobody is in the zones of conflict and attraction; 60 s (J16: fragments of two do not grow).",
        ZoneFlocking(FREE, _UNITS, growth=10.0),
        zone_start,
        60.0,
        verified("source:speed", "source:bounds"),
        (_together, keeps_speed, bounds),
        settings="printed settings, charitably read",
    ),
    "zone-51-noisy": _noisy,
    "zone-box": zone_entry(
        "zone-box",
        "two fragments in a box",
        "Remark 2 says that in a box fragments eventually reunite. Ours: the box of section 5.2, the settings of "
        "zone-52, two fragments of five that run apart, 300 s (J16: some never do).",
        ZoneFlocking(FREE, STRONG, ZoneWorld(box=BOX), u_max=10.0),
        _two_fragments,
        300.0,
        inconclusive("source:bounds", "source:contained"),  # orbits part long before 300 s
        (_reunites, bounds, _walled),
    ),
    "zone-gap-speed": zone_entry(
        "zone-gap-speed",
        "the narrow gap, obstacle zones that depend on speed",
        "section 2.2 says that the zone may extend to a at speed and contract to r when slow. Place and settings of "
        "zone-gap, altitude from r at rest to a at v^max, force measured from its end (J13).",
        ZoneFlocking(FREE, STRONG, GAP, u_max=10.0, zone_length="speed", obstacle_force="reaching"),
        in_column,
        30.0,
        verified("source"),
        THROUGH,
        settings="",
    ),
    "zone-individual": zone_entry(
        "zone-individual",
        "individual weights for each neighbour and each hazard",
        "the introduction names individual weights for neighbours and hazards. Ours: three agents with w^ss = 12, 15, "
        "20 that run at an alien at rest, and two pairs that meet head on with w^ls = 2 and 20; s = 6, w^ga = 10, "
        "v^d = 3, neither cohesion nor alignment. Nothing is random.",
        _own_weights(),
        _head_on,
        20.0,
        inconclusive("source"),  # pairs that meet head on give way to either side: orbits part
        (_distance_from_alien, _right_of_way),
        settings="",
    ),
    "zone-scaled": _scaled,
}
