"""Zone-based flocking from bearings and distances (Jond): a discrete map with all readings of the paper.

Where the paper is silent, or its letter misbehaves, the law has a choice by name: the first of `CHOICES` is the
recommended one and the default, the last is the letter of the paper (`ZoneFlocking.printed`). Of walls and
edges there are two letters: (8) names the closest point, (21) sums over all edges, and each goes with its form.
"""

from collections.abc import Mapping
from dataclasses import KW_ONLY, dataclass, field
from functools import cache
from typing import Any, ClassVar, Self

import numpy as np

from flockana.base import value_checks
from flockana.base.errors import ArgumentError
from flockana.base.natural_scales import Scales
from flockana.base.units import Powers
from flockana.base.value_checks import FloatArray, normalise
from flockana.laws.discrete import DiscreteLaw, States
from flockana.laws.law import Arrays
from flockana.sources.jond_2025.environment.zone_world import ZoneWorld
from flockana.sources.jond_2025.interactions.zone_noise import ZoneNoise
from flockana.sources.jond_2025.interactions.zones import ZoneRadii, ZoneWeights
from flockana.sources.jond_2025.kernels import zones as compiled
from flockana.sources.jond_2025.kernels.zone_counts import fragments, populations

CHOICES: dict[str, tuple[str, ...]] = {
    "form": ("position", "bearing"),
    "order": ("synchronous", "sequential"),
    "speed_bound": ("clip", "tanh"),
    "own_velocity": ("measured", "predicted", "estimated"),
    "surveillance": ("disc", "annulus"),
    "obstacle_zone": ("triangle", "buffer"),
    "zone_length": ("conflict", "attraction", "speed"),
    "trigger": ("exact", "three-segments"),
    "obstacle_force": ("repulsive", "reaching", "literal"),
    "inside": ("outward", "literal"),
    "walls": ("each", "nearest"),
    "polygons": ("nearest", "each"),
}
_OURS = ("obstacle_zone", "zone_length")  # choices that are no readings of the printed law
BEHAVIOURS = ("cohesion", "alignment", "separation", "strategic", "obstacle", "speed")  # in the kernel's order


def _radii_of_section_5() -> ZoneRadii:
    return ZoneRadii(1.5, c=3.0, a=5.0)


@dataclass(frozen=True)
class ZoneFlocking(DiscreteLaw):
    """u = cohesion + alignment + separation + strategic separation + obstacle avoidance + global speed, by zones.

    One step: u_i from (22), bounded by tanh (9); v_i += dt u_i, bounded (10); p_i += dt v_i. Then the aliens move.
    Each alternative below names, after its default, the letter of the paper; spec letters A1 to A18 are its list of
    ambiguities. The memory is each agent's heading, its estimate of its own velocity, and where the aliens are; with
    `growth` its radius of attraction, with `noise` the number of the next step.

    Parameters
    ----------
    radii : ZoneRadii
        Zones; those of section 5.1 by default.
    weights : ZoneWeights
        How much of everything.
    world : ZoneWorld
        Obstacles, box and aliens; none by default.
    desired_speed : float
        v^d of the global speed behaviour.
    u_max, v_max : float
        Bounds of input and speed.
    growth : float
        How fast the radius of attraction of an agent grows while nobody is in its zones of conflict and attraction
        (Remark 2), farther than r from it; it is a again as soon as somebody is there. By default 0: it stays a.
    noise : ZoneNoise
        What is left to chance; nothing by default.
    base : float
        Half base of the obstacle zone over the radius of conflict, 0 < base <= 1 (called α, not printed). Beyond
        1/√3 the heading is no longer the longest altitude of the triangle.
    form : {"position", "bearing"}
        Expressions (3)-(8), or (14)-(21); equal to rounding but for the global speed.
    order : {"synchronous", "sequential"}
        All inputs from one snapshot, or each agent moves at once and the next ones see it moved (A16).
    speed_bound : {"clip", "tanh"}
        v min(1, v^max/‖v‖), or (10), a drag that makes 3 into 2.541 in each step (A7, erratum J7).
    own_velocity : {"measured", "predicted", "estimated"}
        What the global speed behaviour takes for v_i: v_i, v_i + dt u^aux, or (17), which drifts (A8, J8).
    surveillance : {"disc", "annulus"}
        Aliens that are heeded: 0 < d <= s, or a < d <= s, which lets one nearer than a walk in (A1, J9).
    obstacle_zone : {"triangle", "buffer"}
        Directed zone (a cone in space), or the conventional method that section 5.2 compares with: each polygon in
        its smallest disc, and all within c repels whatever the heading.
    zone_length : {"conflict", "attraction", "speed"}
        Altitude of the zone: c; a, as the paper suggests for fast agents; or from r at rest to a at v^max, in
        proportion to the speed between them.
    trigger : {"exact", "three-segments"}
        The zone meets the obstacle, or one of its segments from the agent does, which misses some corners (A12).
    obstacle_force : {"repulsive", "reaching", "literal"}
        min(0, d − c); or min(0, d − h), which reaches as far as the zone's altitude h; or d − c, which attracts where
        the zone is longer than c (A11, J13).
    inside : {"outward", "literal"}
        Of an agent in an obstacle or beyond a wall: pushed out by d + c, or by the letter deeper in (A13, J12).
    walls : {"each", "nearest"}
        One term for each wall that the zone reaches, (21), or the nearest only, (8) (A14).
    polygons : {"nearest", "each"}
        One term for each polygon that the zone meets, at its closest point, (8), or for each of its edges, (21).

    Examples
    --------
    Two agents in each other's zone of conflict, at the desired speed side by side:

    >>> law = ZoneFlocking()
    >>> parts = law.behaviours([[0.0, 0.0], [0.0, 2.0]], [[3.0, 0.0], [3.0, 0.0]])
    >>> parts["separation"][0].tolist(), parts["cohesion"][0].tolist(), parts["speed"][0].tolist()
    ([0.0, -5.0], [0.0, 0.5], [0.0, 0.0])
    """

    radii: ZoneRadii = field(default_factory=_radii_of_section_5)
    weights: ZoneWeights = field(default_factory=ZoneWeights)
    world: ZoneWorld = field(default_factory=ZoneWorld)
    _: KW_ONLY
    desired_speed: float = 3.0
    u_max: float = 2.0
    v_max: float = 4.0
    dt: float = 0.1
    base: float = 0.5
    growth: float = 0.0
    noise: ZoneNoise = field(default_factory=ZoneNoise)
    form: str = "position"
    order: str = "synchronous"
    speed_bound: str = "clip"
    own_velocity: str = "measured"
    surveillance: str = "disc"
    obstacle_zone: str = "triangle"
    zone_length: str = "conflict"
    trigger: str = "exact"
    obstacle_force: str = "repulsive"
    inside: str = "outward"
    walls: str = "each"
    polygons: str = "nearest"

    units: ClassVar[Mapping[str, Powers]] = {
        "desired_speed": (1, -1),
        "u_max": (1, -2),
        "v_max": (1, -1),
        "growth": (1, -1),
        "dt": (0, 1),
    }
    references = ("jond-2025",)
    derived_methods: ClassVar[Mapping[str, tuple[str, ...]]] = {"iterate": ("step",)}
    extra_units: ClassVar[Mapping[str, Powers]] = {"estimate": (1, -1), "reach": (1, 0), "alien": (1, 0)}
    steps_at_once = 256  # a step of ten agents takes microseconds

    @property
    def scales(self) -> Scales:
        """Length and time scales: the radius of attraction, and the time to cross it at the greatest speed."""
        length_scale = self.radii.reach[2]
        return Scales(length_scale, length_scale / self.v_max)

    @classmethod
    def printed(cls, radii: ZoneRadii | None = None, weights: ZoneWeights | None = None, **options: Any) -> Self:
        """Return the law exactly as printed in the paper, with gains 1; keywords override.

        Its form is (14)-(21), unless another is given: (21) sums over walls and edges, (8) takes the closest point.

        Parameters
        ----------
        radii : ZoneRadii, optional
            Those of section 5.1 by default.
        weights : ZoneWeights, optional
            Those of section 5.1 by default.

        Examples
        --------
        >>> ZoneFlocking.printed().speed_bound
        'tanh'
        """
        letter: dict[str, Any] = {name: names[-1] for name, names in CHOICES.items() if name not in _OURS}
        is_summed = options.get("form", letter["form"]) == "bearing"  # (21) is a sum over edges, (8) has one point
        letter |= dict.fromkeys(("walls", "polygons"), "each" if is_summed else "nearest")
        gains = ZoneWeights(cohesion_gain=1.0, alignment_gain=1.0)
        return cls(radii or _radii_of_section_5(), weights or gains, **(letter | options))

    def __post_init__(self) -> None:
        parts = (("radii", ZoneRadii), ("weights", ZoneWeights), ("world", ZoneWorld), ("noise", ZoneNoise))
        for name, kind in parts:
            value_checks.ensure_kind(name, getattr(self, name), kind, f"a {kind.__name__}")
        normalise(self, value_checks.ensure_positive, "desired_speed", "u_max", "v_max", "dt", "base")
        normalise(self, value_checks.ensure_nonnegative, "growth")
        if self.base > 1.0:
            raise ArgumentError(f"base = {self.base:g}: expected at most 1, so that the zone lies in that of conflict")
        for name, names in CHOICES.items():
            value_checks.ensure_choice(name, getattr(self, name), names)
        self._check_box()

    def _check_box(self) -> None:
        box = self.world.box
        if box is None:
            return
        reach, side = 2.0 * self.radii.reach[1], float(np.min(np.subtract(box.high, box.low)))
        if side <= reach:
            raise ArgumentError(
                f"the box {box} has a side of {side:g}, the zone of conflict a diameter of {reach:g}: expected a box "
                "larger than a zone, in which an agent can stay clear of all walls"
            )

    def check_dimension(self, m: int) -> None:  # noqa: D102
        if self.world.dimension not in (None, m):
            raise ArgumentError(f"the world of the law has {self.world.dimension} dimensions, the agents {m}")

    def check_start(self, q: FloatArray, p: FloatArray) -> None:  # noqa: D102
        self._zones(len(q))
        self.world.check_start(q)

    def start(self, q: FloatArray, p: FloatArray) -> Arrays:
        """Return the initial memory: headings along velocities, exact velocity estimates, aliens at their starts."""
        speed = np.linalg.norm(p, axis=1, keepdims=True)
        heading = np.divide(p, speed, out=np.zeros_like(p), where=speed > 0.0)
        memory = {"heading": heading, "estimate": np.array(p)}
        radii = self.radii.arrays(len(q))[2]
        return memory | self._needed_memory(radii, np.array(0.0), self.world.alien_starts)

    def _needed_memory(self, reach: FloatArray, step: FloatArray, alien: FloatArray) -> dict[str, FloatArray]:
        """Return those of zone radii, step number and aliens that the law's settings need as memory."""
        is_needed = {"reach": self.growth > 0.0, "step": not self.noise.quiet, "alien": bool(self.world.aliens)}
        return {name: x for name, x in (("reach", reach), ("step", step), ("alien", alien)) if is_needed[name]}

    def step(self, t: float, q: FloatArray, p: FloatArray, memory: Arrays) -> States:
        """Return the state after one step (Algorithm 1 of the paper), unchecked.

        Parameters
        ----------
        memory : mapping of str to ndarray
            ``heading``, ``estimate`` and, if there are aliens, ``alien``; as `start` gives it.
        """
        q, p, u, next_memory = self.iterate(t, q, p, memory, 1)
        return q[0], p[0], u[0], {name: values[0] for name, values in next_memory.items()}

    def iterate(self, t: float, q: FloatArray, p: FloatArray, memory: Arrays, steps: int) -> States:  # noqa: D102
        flock, first = self._state(q, p, memory)
        qs, ps, us, *rest = compiled.run(flock, first, self._rules(*q.shape), steps)
        headings, estimates, reach, aliens = rest
        numbers = np.arange(first + 1.0, first + steps + 0.5)
        return qs, ps, us, {"heading": headings, "estimate": estimates} | self._needed_memory(reach, numbers, aliens)

    def behaviours(self, q: Any, p: Any, memory: Mapping[str, Any] | None = None) -> dict[str, FloatArray]:
        """Return all agents' accelerations (n, m) from each of six behaviours, by name, before the bound (9).

        Parameters
        ----------
        memory : mapping of str to array_like, optional
            As `step` takes it; by default that of a start.

        Raises
        ------
        ArgumentError
            On bad arrays, or a law for other agents than these.
        """
        q, p = value_checks.ensure_state(q, p)
        self.check_dimension(q.shape[1])
        state = self.start(q, p) if memory is None else memory
        components = compiled.behaviours(*self._state(q, p, state), self._rules(*q.shape))
        return dict(zip(BEHAVIOURS, components, strict=True))

    def measures(self, t: FloatArray, q: FloatArray, p: FloatArray, extra: Arrays) -> Mapping[str, tuple[str, Any]]:  # noqa: D102
        n = q.shape[1]
        r, c, a, _ = self.radii.arrays(n)
        parts, counts = fragments(q, a), cache(lambda: populations(q, r, c, a))
        connected_share = (n - parts[:, 0]) / (n - 1) if n > 1 else parts[:, 0]
        series = {
            "connectivity": ("C = rank(L)/(n − 1), of agents within a", connected_share),
            "giant_share": ("C*, share of nodes", parts[:, 1] / n),
        }
        for k, zone in enumerate(("repulsion", "conflict", "attraction")):
            series[f"in_{zone}"] = (f"mean number of agents in the zone of {zone}", lambda k=k: counts()[:, k])
        if "alien" in extra:
            gaps = np.linalg.norm(q[:, :, None] - extra["alien"][:, None], axis=3)
            series["alien_distance"] = ("least distance from an alien", gaps.min(axis=(1, 2)))
        if self.world.obstacles:
            series |= self._clearances(t, q)
        if self.world.box is not None:
            box_clearance = self.world.box.clearance(q.reshape(-1, q.shape[2])).reshape(q.shape[:2]).min(axis=1)
            series["wall_distance"] = ("least distance from a wall, negative outside the box", box_clearance)
        return series

    def _clearances(self, t: FloatArray, q: FloatArray) -> dict[str, tuple[str, Any]]:
        """Return measures by name: clearance from obstacles at samples, and a lower bound of it in between."""

        @cache
        def measured() -> tuple[FloatArray, FloatArray]:
            short = np.flatnonzero(np.diff(t) < 1.5 * self.dt)  # between samples further apart the way is not known
            all_clearances, way_clearances = self.world.clearances(q, short)
            least_clearances = all_clearances.min(axis=1)
            way_clearance = np.append(least_clearances[:1], np.full(len(t) - 1, np.nan))
            way_clearance[short + 1] = way_clearances.min(axis=1)
            return least_clearances, way_clearance

        return {
            "obstacle_clearance": ("least distance from an obstacle, negative inside", lambda: measured()[0]),
            "obstacle_clearance_bound": ("lower bound of it on the way to the sample", lambda: measured()[1]),
        }

    def altitudes(self, p: Any) -> FloatArray:
        """Return the length of each agent's obstacle zone along its heading, shape (n,).

        Examples
        --------
        >>> ZoneFlocking(zone_length="speed").altitudes([[0.0, 0.0], [2.0, 0.0], [0.0, 4.0]]).tolist()
        [1.5, 3.25, 5.0]
        """
        speeds = np.linalg.norm(value_checks.ensure_points("p", p), axis=1)
        r, c, a, _ = self.radii.arrays(len(speeds))
        speed_altitudes: FloatArray = r + (a - r) * np.minimum(1.0, speeds / self.v_max)
        length_by_zone = {"conflict": c, "attraction": a, "speed": speed_altitudes}
        return length_by_zone[self.zone_length]

    def _state(self, q: FloatArray, p: FloatArray, memory: Mapping[str, Any]) -> tuple[compiled.Flock, int]:
        """Return copies of positions, velocities and memory as a flock, and the number of the next step."""
        unknown = {"reach": self.radii.arrays(len(q))[2], "alien": np.empty((0, q.shape[1])), "step": 0}
        full_memory: dict[str, Any] = unknown | dict(memory)
        names = ("heading", "estimate", "reach", "alien")
        arrays = (np.array(full_memory[name], float) for name in names)
        return compiled.Flock(np.array(q), np.array(p), *arrays), int(full_memory["step"])

    def _zones(self, n: int) -> compiled.Zones:
        return compiled.Zones(*self.radii.arrays(n), **self.weights.arrays(n, len(self.world.aliens)))

    def _rules(self, n: int, m: int) -> compiled.Rules:
        """Return zones, settings, choices and world of the law in the form of the compiled step."""
        gains = self.weights.cohesion_gain, self.weights.alignment_gain
        chance = self.noise.weights, self.noise.velocities
        step_parameters = self.dt, self.desired_speed, self.u_max, self.v_max
        settings = compiled.Settings(*step_parameters, *gains, self.base, self.growth, *chance, seed=self.noise.seed)
        choices = compiled.Choices(**{name: names.index(getattr(self, name)) for name, names in CHOICES.items()})
        world = self.world.arrays(m, buffer=self.obstacle_zone == "buffer")
        return compiled.Rules(self._zones(n), settings, choices, world)
