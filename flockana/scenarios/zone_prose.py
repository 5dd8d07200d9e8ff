"""Prose statements of Jond's bearing-distance paper, each on a run.

None of these is simulated in the paper. Starts and settings are those of its section 5.1 or ours; each text says so.
"""

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from flockana.base.checks import FloatArray, ensure_count
from flockana.base.errors import ArgumentError
from flockana.base.vectors import lengths
from flockana.dynamics.trajectory import Trajectory
from flockana.environment.zone_world import Alien, ZoneWorld
from flockana.interactions import ZoneNoise, ZoneRadii, ZoneWeights
from flockana.laws.bearing_distance import ZoneFlocking
from flockana.scenarios.bearing_distance import (
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
    entry,
    in_column,
    keeps_speed,
)
from flockana.scenarios.expected import verified
from flockana.scenarios.findings import component_counts, finding, report, rerun
from flockana.scenarios.scenario import Scenario
from flockana.scenarios.start import lazy_state
from flockana.theorems import Claim, Tolerances
from flockana.theorems.bearing_distance.random_starts import crowd_start, zone_start

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
    stated = _SEEN - _SPEED * _DRIVE / np.array(_HAZARD)
    off = float(np.abs(gaps - stated).max()) / _SEEN
    text = f"agents with w^ss = 12, 15, 20 keep {', '.join(f'{gap:.3f}' for gap in gaps)} m from the alien, as s - v^d "
    return finding(_AS_FAR - off, text + "w^ga/w^ss has it", computed=gaps.tolist(), stated=stated.tolist())


@report("gives-way", "of two agents that meet, the one with the larger weight for the other gives way")
def _right_of_way(run: Trajectory, tolerances: Tolerances) -> Claim:
    """Report that after a head-on meeting both agents follow the one with the smaller weight for the other."""
    end = run.p[-1, len(_HAZARD) :, 0].reshape(-1, 2)
    forward = np.array([1.0 if first < second else -1.0 for first, second in _GIVES_WAY])
    slowest = float((end * forward[:, None]).min()) / _SPEED
    text = "; ".join(
        f"w^ls = {w[0]:g}, {w[1]:g}: both at {v[0]:.3g}, {v[1]:.3g}" for w, v in zip(_GIVES_WAY, end, strict=True)
    )
    return finding(slowest - 0.5, text, computed=end.tolist(), stated="the agent with the larger weight turns round")


@report("repeats", "the same seed gives the same run")
def _repeats(run: Trajectory, tolerances: Tolerances) -> Claim:
    if "step" in run.extra and run.extra["step"][0] != 0.0:
        return finding(float("nan"), "the run does not begin with step 0", stated="the same to the bit")
    end = rerun(run, run.law).q[-1]
    same = bool((end == run.q[-1]).all())
    text = f"a second run ends {'the same to the bit' if same else 'elsewhere'}"
    return finding(0.5 if same else -0.5, text, stated="the same to the bit")


@report("unpredictable", "chance makes motions less predictable")
def _unpredictable(run: Trajectory, tolerances: Tolerances) -> Claim:
    other = replace(run.law, noise=replace(run.law.noise, seed=run.law.noise.seed + 1))
    end = rerun(run, other).q[-1]
    moved = float(np.linalg.norm(end - run.q[-1], axis=1).max()) / float(np.max(run.law.radii.a))
    text = f"with another seed of the noise an agent ends {moved:.3g} a from where it ends here"
    return finding(moved - _MOVED, text, computed=moved, stated="less predictable motions")


_INFORMED_REPORTS = (keeps_speed, _together, bounds)
_BOX_REPORTS = (_reunites, bounds, _walled)
_INDIVIDUAL = (_distance_from_alien, _right_of_way)
_NOISY = (_unpredictable, *OPEN)


def _two_fragments(seed: int) -> tuple[FloatArray, FloatArray]:
    """Return five agents on the left and five on the right of the box, moving apart."""
    rng = np.random.default_rng(seed)
    side = np.repeat([-1.0, 1.0], N // 2)
    x = 25.0 + side * rng.uniform(5.0, 13.0, N)
    q = np.column_stack([x, rng.uniform(20.0, 30.0, N)])
    return q, np.column_stack([_SPEED * side, np.zeros(N)]) + rng.uniform(-0.2, 0.2, (N, 2))


def _head_on() -> tuple[FloatArray, FloatArray]:
    """Return three agents heading for the origin, and far away two pairs heading for each other."""
    directions = np.array([[-1.0, 0.0], [1.0, 0.0], [0.0, 1.0]])
    pairs = [(x, y) for y in _LANES for x in (-10.0, 10.0)]
    ways = [(way * _SPEED, 0.0) for _ in _LANES for way in (1.0, -1.0)]
    return np.vstack([_OFF * directions, pairs]), np.vstack([-_SPEED * directions, ways])


def _own_weights() -> ZoneFlocking:
    n = len(_HAZARD) + 2 * len(_GIVES_WAY)
    separation = np.full((n, n), 5.0)
    for k, (first, second) in enumerate(_GIVES_WAY):
        i = len(_HAZARD) + 2 * k
        separation[i, i + 1], separation[i + 1, i] = first, second
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
    source = (
        "section 2.1 says that neighbours adjust and a new global speed results; start and settings as zone-51, "
        "w^ga = 0 for those that are not informed, 60 s (J14)."
    )
    law = ZoneFlocking(FREE, weights)
    expected = verified("source:bounds")
    return entry("zone-51-informed", title, source, law, apart(seed), 60.0, seed, _INFORMED_REPORTS, expected)


def _box(seed: int = 0) -> Scenario:
    title = "two fragments in a box"
    source = (
        "Remark 2 says that in a box fragments eventually reunite. Ours: the box of section 5.2, the settings of "
        "zone-52, two fragments of five that run apart, 300 s (J16: some never do)."
    )
    law = ZoneFlocking(FREE, STRONG, ZoneWorld(box=BOX), u_max=10.0)
    expected = verified("source:bounds", "source:contained")
    return entry("zone-box", title, source, law, _two_fragments(seed), 300.0, seed, _BOX_REPORTS, expected)


def _growing(seed: int = 0) -> Scenario:
    title = "section 5.1 with Remark 2: radii of attraction grow until a flockmate is found"
    source = (
        "Remark 2, without its box: parameters and start of section 5.1, charitably read, and a_i that grows by 10 m/s "
        "(ours) while nobody is in the zones of conflict and attraction; 60 s (J16: fragments of two do not grow)."
    )
    law = ZoneFlocking(FREE, ZoneWeights(cohesion_gain=1.0, alignment_gain=1.0), growth=10.0)
    start = zone_start(seed)
    reports = (_together, keeps_speed, bounds)
    expected = verified("source:speed", "source:bounds")
    settings = "printed settings, charitably read"
    return entry("zone-51-growing", title, source, law, start, 60.0, seed, reports, expected, settings=settings)


def _by_speed(seed: int = 0) -> Scenario:
    title = "the narrow gap, obstacle zones that depend on speed"
    source = (
        "section 2.2 says that the zone may extend to a at speed and contract to r when slow. Place and settings of "
        "zone-gap, altitude from r at rest to a at v^max, force measured from its end (J13)."
    )
    law = ZoneFlocking(FREE, STRONG, GAP, u_max=10.0, zone_length="speed", obstacle_force="reaching")
    expected = verified("source")
    return entry("zone-gap-speed", title, source, law, in_column(seed), 30.0, seed, THROUGH, expected, settings="")


def _scaled(seed: int = 0, n: int = 500) -> Scenario:
    size = ensure_count("n", n)
    source = (
        "the abstract calls the flocking scalable. Settings of zone-51; n agents, 500 if not given, as dense as the "
        "ten of section 5.1 and more than 2 m apart, velocities in (0, 1) (J18)."
    )
    law = ZoneFlocking(FREE)
    start = lazy_state((size, 2), lambda: crowd_start(seed, size))
    reports = (*OPEN[1:], distances, _together)
    expected = verified("source:speed", "source:bounds")
    return entry("zone-scaled", f"{size} agents", source, law, start, 20.0, seed, reports, expected, settings="")


def _individual(seed: int = 0) -> Scenario:
    title = "individual weights for each neighbour and each hazard"
    source = (
        "the introduction names individual weights for neighbours and hazards. Ours: three agents with w^ss = 12, 15, "
        "20 that run at an alien at rest, and two pairs that meet head on with w^ls = 2 and 20; s = 6, w^ga = 10, "
        "v^d = 3, neither cohesion nor alignment. Nothing is random."
    )
    law = _own_weights()
    expected = verified("source")
    return entry("zone-individual", title, source, law, _head_on(), 20.0, seed, _INDIVIDUAL, expected, settings="")


def _noisy(seed: int = 0, weights: float = 0.5, velocities: float = 0.1) -> Scenario:
    title = "stochastic weights and perturbed velocities"
    source = (
        "the conclusions propose stochastic weights and random perturbations in velocities. Settings of zone-51; in "
        f"each step each weight is multiplied by a number in 1 ± {weights:g}, and each component of a velocity gets "
        f"{velocities:g} m/s (standard deviation), both ours; the scenario's seed is that of the noise too."
    )
    law = ZoneFlocking(FREE, noise=ZoneNoise(weights=weights, velocities=velocities, seed=seed))
    expected = verified("source:repeats", "source:unpredictable", "source:speed", "source:bounds")
    return entry("zone-51-noisy", title, source, law, apart(seed), 20.0, seed, _NOISY, expected, as_it_is=(_repeats,))


SCENARIOS: dict[str, Callable[..., Scenario]] = {
    "zone-51-informed": _informed,
    "zone-51-growing": _growing,
    "zone-51-noisy": _noisy,
    "zone-box": _box,
    "zone-gap-speed": _by_speed,
    "zone-individual": _individual,
    "zone-scaled": _scaled,
}
