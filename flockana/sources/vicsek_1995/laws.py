"""Agents of constant speed that turn to their neighbours' mean heading (Vicsek; Jadbabaie, Lin and Morse)."""

from collections.abc import Mapping
from dataclasses import KW_ONLY, dataclass
from math import pi
from typing import Any, ClassVar

import numpy as np

from flockana.base import value_checks
from flockana.base.errors import ArgumentError
from flockana.base.natural_scales import Scales
from flockana.base.units import Powers
from flockana.base.value_checks import FloatArray, normalise
from flockana.kernels.neighbours import pair_list
from flockana.kernels.random_noise import noise as random_number
from flockana.laws.discrete import DiscreteLaw, States
from flockana.laws.law import Arrays
from flockana.measures.nets import LinkArray, components

AVERAGES = ("headings", "vectors")
_TURN = 2.0 * pi
_SPEED = 1e-9  # relative: how far a start's speeds may be from the law's
_SEARCH = 1.0 + 1e-9  # the neighbour search is strict, "in or on the circle" is not
_CANCELS = 1e-12  # of the neighbours' number: a sum of unit vectors that points nowhere


@dataclass(frozen=True)
class HeadingAveraging(DiscreteLaw):
    """θ_i becomes the mean of θ_j over agent i and all agents within the closed circle of radius r.

    Positions move first, q_i + dt v (cos θ_i, sin θ_i), by the headings that they have; all agents turn at once. The
    linear mean is that of Jadbabaie, Lin and Morse, with headings in [0, 2π): it depends on where angles are counted
    from, and neighbours on both sides of that direction turn away from it. Vicsek's mean of unit vectors does not. A
    start within rounding of the direction `zero` may come to either side of it.

    Parameters
    ----------
    range : float
        r > 0, in length.
    speed : float
        v > 0 of every agent, in length over time.
    dt : float
        Step, in time.
    average : {"headings", "vectors"}
        The mean of the angles, or the angle of the mean of the unit vectors (Vicsek and others); agents whose
        neighbours' vectors cancel keep their heading.
    zero : float
        Direction from which headings are counted, in radians: those of a start lie in [zero, zero + 2π).
    noise : float
        η >= 0 of Vicsek and others, in radians: each new heading is turned by a number uniform in (−η/2, η/2).
    seed : int
        Of the noise, >= 0; every number is a function of (seed, step, agent).

    Examples
    --------
    Two neighbours at 0.2 and 0.4 radians agree after one step:

    >>> law = HeadingAveraging(range=1.0, speed=1.0, dt=0.1)
    >>> q = np.array([[0.0, 0.0], [0.5, 0.0]])
    >>> after = law.step(0.0, q, q, {"heading": np.array([0.2, 0.4])})[3]
    >>> [round(angle, 12) for angle in after["heading"].tolist()]
    [0.3, 0.3]
    """

    range: float = 1.0
    speed: float = 0.03
    dt: float = 1.0
    _: KW_ONLY
    average: str = "headings"
    zero: float = 0.0
    noise: float = 0.0
    seed: int = 0

    units: ClassVar[Mapping[str, Powers]] = {"range": (1, 0), "speed": (1, -1), "dt": (0, 1)}
    references = ("jadbabaie-lin-morse-2003", "vicsek-1995")

    def __post_init__(self) -> None:
        normalise(self, value_checks.ensure_positive, "range", "speed", "dt")
        normalise(self, value_checks.ensure_finite_scalar, "zero")
        normalise(self, value_checks.ensure_nonnegative, "noise")
        value_checks.ensure_choice("average", self.average, AVERAGES)
        if self.noise > _TURN:
            raise ArgumentError(f"noise = {self.noise:g}: expected at most 2π radians, at which headings are uniform")
        object.__setattr__(self, "seed", value_checks.ensure_seed(self.seed, 63))

    @property
    def scales(self) -> Scales:
        """Length and time scales: the radius r, and the time to cross it."""
        return Scales(self.range, self.range / self.speed)

    def check_dimension(self, m: int) -> None:  # noqa: D102
        if m != 2:
            raise ArgumentError(f"the agents live in {m} dimensions: a heading is an angle, expected the plane, m = 2")

    def check_start(self, q: FloatArray, p: FloatArray) -> None:  # noqa: D102
        deviation = np.abs(np.linalg.norm(p, axis=1) / self.speed - 1.0)
        worst = int(np.argmax(deviation))
        if deviation[worst] > _SPEED:
            raise ArgumentError(
                f"agent {worst} has the speed {np.linalg.norm(p[worst]):g}: expected speed = {self.speed:g} for all "
                "agents; make velocities with law.velocities(headings)"
            )

    def velocities(self, headings: Any) -> FloatArray:
        """Return the velocities of agents with given headings, shape (n, 2).

        Parameters
        ----------
        headings : array_like, shape (n,)
            In radians.

        Examples
        --------
        >>> HeadingAveraging(speed=2.0).velocities([0.0]).tolist()
        [[2.0, 0.0]]
        """
        angles = np.asarray(headings, dtype=np.float64)
        return self.speed * np.stack([np.cos(angles), np.sin(angles)], axis=-1)

    def links(self, q: FloatArray) -> LinkArray:
        """Return unordered pairs within the closed circle of radius r, each once, unchecked.

        Examples
        --------
        >>> HeadingAveraging(range=1.0).links(np.array([[0.0, 0.0], [1.0, 0.0], [2.5, 0.0]])).tolist()
        [[0, 1]]
        """
        pairs = np.column_stack(pair_list(q, _SEARCH * self.range))
        return pairs[np.linalg.norm(q[pairs[:, 1]] - q[pairs[:, 0]], axis=1) <= self.range]

    def start(self, q: FloatArray, p: FloatArray) -> Arrays:
        """Return as memory the initial headings in [zero, zero + 2π), and with noise the step number 0."""
        heading = self.zero + np.mod(np.arctan2(p[:, 1], p[:, 0]) - self.zero, _TURN)
        return {"heading": heading} | ({"step": np.array(0.0)} if self.noise else {})

    def step(self, t: float, q: FloatArray, p: FloatArray, memory: Arrays) -> States:  # noqa: D102
        heading = memory["heading"]
        average = _mean_angles if self.average == "headings" else _mean_vectors
        turned, next_memory = average(heading, self.links(q)), dict(memory)
        if self.noise:
            k = int(memory["step"])
            noise_samples = [random_number(self.seed, k, i, 0, 0) for i in range(len(q))]
            turned = turned + 0.5 * self.noise * np.array(noise_samples)
            next_memory["step"] = memory["step"] + 1.0
        before, velocities = self.velocities(heading), self.velocities(turned)
        return q + self.dt * before, velocities, (velocities - before) / self.dt, next_memory | {"heading": turned}

    def averaging_matrix(self, q: FloatArray, heading: FloatArray) -> Any:
        """Return the Jacobian matrix of one step: derivatives of next headings by present ones.

        Parameters
        ----------
        heading : ndarray, shape (n,)
            Headings, in radians.

        Raises
        ------
        ArgumentError
            If two agents are at the edge of each other's circle, where the map jumps.

        Examples
        --------
        >>> matrix = HeadingAveraging(range=1.0).averaging_matrix(np.array([[0.0, 0.0], [0.5, 0.0]]), np.zeros(2))
        >>> matrix.toarray().tolist()
        [[0.5, 0.5], [0.5, 0.5]]
        """
        from scipy.sparse import coo_array

        near_pairs = np.column_stack(pair_list(q, _SEARCH * self.range))
        range_gaps = np.abs(np.linalg.norm(q[near_pairs[:, 1]] - q[near_pairs[:, 0]], axis=1) - self.range)
        if near_pairs.size and range_gaps.min() <= (_SEARCH - 1.0) * self.range:
            i, j = near_pairs[int(np.argmin(range_gaps))]
            raise ArgumentError(f"agents {i} and {j} are at the edge of each other's circle: the map jumps there")
        n, pairs = len(q), self.links(q)
        rows = np.concatenate([np.arange(n), pairs[:, 0], pairs[:, 1]])
        columns = np.concatenate([np.arange(n), pairs[:, 1], pairs[:, 0]])
        weights = np.ones(rows.size)
        if self.average == "vectors":
            weights = np.cos(heading[columns] - _mean_vectors(heading, pairs)[rows])
        sums = np.bincount(rows, weights, n)
        return coo_array((weights / sums[rows], (rows, columns)), shape=(n, n)).tocsr()

    def measures(self, t: FloatArray, q: FloatArray, p: FloatArray, extra: Arrays) -> Mapping[str, Any]:  # noqa: D102
        n = q.shape[1]
        counts = np.array([components(n, self.links(x)).max() + 1 for x in q])
        series: dict[str, Any] = {
            "connectivity": ("C = rank(L)/(n − 1), of agents in or on the circle", (n - counts) / max(1, n - 1))
        }
        if "heading" in extra:
            series["heading_spread"] = ("largest heading less the least (radians)", np.ptp(extra["heading"], axis=1))
        return series


def _mean_angles(heading: FloatArray, pairs: LinkArray) -> FloatArray:
    """Return the mean heading angle of each agent and its neighbours, clipped to their range."""
    (i, j), n = pairs.T, heading.size
    total = heading + np.bincount(i, heading[j], n) + np.bincount(j, heading[i], n)
    lower, maximum = heading.copy(), heading.copy()
    for agent_index, neighbour_index in ((i, j), (j, i)):
        np.minimum.at(lower, agent_index, heading[neighbour_index])
        np.maximum.at(maximum, agent_index, heading[neighbour_index])
    return np.clip(total / _sizes(pairs, n), lower, maximum)


def _mean_vectors(heading: FloatArray, pairs: LinkArray) -> FloatArray:
    """Return the angle of the mean unit vector; the agent's own heading if the mean vanishes."""
    (i, j), n = pairs.T, heading.size
    x, y = (f(heading) + np.bincount(i, f(heading)[j], n) + np.bincount(j, f(heading)[i], n) for f in (np.cos, np.sin))
    is_cancelling = np.hypot(x, y) <= _CANCELS * _sizes(pairs, n)
    return np.where(is_cancelling, heading, np.arctan2(y, x))


def _sizes(pairs: LinkArray, n: int) -> FloatArray:
    """Return the number of agents in each agent's average, itself included."""
    return np.bincount(pairs.ravel(), minlength=n).astype(np.float64) + 1.0
