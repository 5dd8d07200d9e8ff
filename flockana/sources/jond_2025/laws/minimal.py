"""Minimal flocking model of the bearing-distance paper: alignment with the mean, and springs of length α_i r_i."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import KW_ONLY, dataclass
from functools import cached_property
from math import inf
from typing import Any, ClassVar

import numpy as np

from flockana.base import value_checks
from flockana.base.errors import ArgumentError
from flockana.base.natural_scales import Scales
from flockana.base.override_checks import overrides_consistently
from flockana.base.units import Powers, scaled_fields, times
from flockana.base.value_checks import FloatArray, PerAgent, normalise
from flockana.base.vector_norms import lengths
from flockana.laws.discrete import DiscreteLaw, IndexArray, States
from flockana.laws.law import Arrays, Block, Law
from flockana.laws.law_features import Feature
from flockana.laws.terms.term import Derivatives
from flockana.measures.distance_profiles import pair_distance_profile
from flockana.measures.measure import Series
from flockana.measures.nets import components
from flockana.measures.perception import Edges, ensure_edges
from flockana.sources.jond_2025.interactions.zones import Table, per_pair
from flockana.sources.jond_2025.kernels import minimal as kernel
from flockana.sources.jond_2025.laws.edge_weights import EdgeData, weighed_edges

_EQUAL = 1e-14  # relative: products of three numbers that are equal by algebra differ by less


@dataclass(frozen=True)
class MinimalFlocking(Law):
    """u_i = Σ σ_ij v_j / Σ σ_ij − v_i + Σ μ_ij (1 − α_i r_i/‖p_j − p_i‖)(p_j − p_i) over N_i  (eq. (23)-(25)).

    N_i holds the agents within i's own perception radius (closed), so perception is directed where radii differ; or
    it is frozen by `edges`. As printed α_i = β_i |N_i| with β_i = 1/r_i: the desired spacing of an agent is as many
    length units as it has neighbours, it jumps when one comes or goes, and neighbours disagree about it (erratum J5).
    `spacing` sets it once and for all, as the corrected Theorem 1 asks.

    An agent without neighbours moves straight on; coincident agents have no bearing and no spring.

    Parameters
    ----------
    radius : float or sequence of n floats
        Perception radius r_i.
    beta : float or sequence of n floats, optional
        β_i; 1/r_i by default. Not with `spacing`.
    spacing : float or sequence of n floats, optional
        Constant ρ_i = α_i r_i; by default β_i |N_i| r_i.
    mu, sigma : float or array of shape (n, n)
        μ_ij and σ_ij >= 0: how much agent i heeds agent j. σ = 0 leaves separation alone.
    edges : sequence of (int, int), optional
        A frozen graph: (j, i) if i perceives j, at any distance. By default the perceived one.
    normalised : bool
        Divide by Σ σ_ij as printed; False sums σ_ij (v_j − v_i), which is reciprocal if σ is symmetric.

    Raises
    ------
    ArgumentError
        On numbers out of range, tables of different sizes, a mean without weights, both `beta` and `spacing`.

    Examples
    --------
    Agent 1 perceives agent 0, two units away, and wants to be one unit away; agent 0 perceives nobody:

    >>> MinimalFlocking(edges=[(0, 1)], spacing=1.0).acceleration(0.0, [[0.0], [2.0]], [[0.0], [0.0]]).tolist()
    [[0.0], [-1.0]]
    """

    radius: PerAgent = 10.0
    _: KW_ONLY
    beta: PerAgent | None = None
    spacing: PerAgent | None = None
    mu: Table = 1.0
    sigma: Table = 1.0
    edges: Edges | None = None
    normalised: bool = True

    references = ("jond-2025",)
    units: ClassVar[Mapping[str, Powers]] = {"radius": (1, 0), "spacing": (1, 0), "mu": (0, -2)}

    def __post_init__(self) -> None:
        if self.beta is not None and self.spacing is not None:
            raise ArgumentError(f"beta = {self.beta} and spacing = {self.spacing}: expected one of them, or neither")
        normalise(self, value_checks.ensure_flag, "normalised")
        normalise(
            self,
            value_checks.per_agent,
            "radius",
            *(name for name in ("beta", "spacing") if getattr(self, name) is not None),
        )
        normalise(self, per_pair, "mu", "sigma")
        if self.edges is not None:
            object.__setattr__(self, "edges", ensure_edges(self.edges))
        self._check_sizes()
        self._check_means()

    @property
    def scales(self) -> Scales:
        """Length and time scales: longest spacing or perception radius, time of the stiffest spring or of alignment."""
        length_scale = float(np.max(self.radius if self.spacing is None else self.spacing))
        sigma_max = float(np.max(self.sigma))
        rate = max(float(np.sqrt(np.max(self.mu))), float(sigma_max > 0.0) if self.normalised else sigma_max)
        return Scales(length_scale, 1.0 / rate if rate > 0.0 else 1.0)

    functions = ()  # neighbours are chosen by radii of agents

    def features(self) -> tuple[Feature, ...]:
        """Return the smallest perception radius as the law's narrowest length; springs vary linearly."""
        radius = float(np.min(self.radius)) if self.edges is None else inf
        return (Feature("the perception radii", "pairs", radius),)

    @property
    def surfaces(self) -> tuple[PerAgent, ...]:
        """Switching distances of the law: each agent's perception radius, or none on a frozen graph."""
        return (self.radius,) if self.edges is None else ()

    def in_units(self, length: float, time: float) -> MinimalFlocking:
        """Return the law in other units (`flockana.rescale`).

        Raises
        ------
        ArgumentError
            If time is rescaled and alignment is normalised: its rate is then 1 per time unit, as printed.
        """
        if self.normalised and time != 1.0 and np.any(self.sigma):
            raise ArgumentError(
                f"time = {time:g}: normalised alignment has the rate 1 per time unit, as printed, and no "
                "parameter for it; expected time = 1, or a law with normalised=False"
            )
        changed_fields = scaled_fields(self, length, time)
        if not self.normalised:
            changed_fields["sigma"] = times(self.sigma, 1.0 / time)
        if self.beta is None and self.spacing is None:  # the default 1/r_i is that of the unit in which it was given
            changed_fields["beta"] = 1.0 / np.array(self.radius)
        return MinimalFlocking(**changed_fields)

    @cached_property
    def _sizes(self) -> dict[str, int]:
        tables = {name: getattr(self, name) for name in ("radius", "beta", "spacing", "mu", "sigma")}
        return {name: len(value) for name, value in tables.items() if isinstance(value, tuple)}

    @cached_property
    def _named(self) -> int:
        """Return the least flock size that the edges of a frozen graph require: highest index plus 1."""
        return 1 + max((max(edge) for edge in self.edges or ()), default=-1)

    def _check_sizes(self) -> None:
        sizes = self._sizes
        if len(set(sizes.values())) > 1:
            raise ArgumentError(f"{sizes}: expected tables of equal length, one entry for each agent")
        if sizes and self._named > (smallest := min(sizes.values())):
            raise ArgumentError(f"edges name agent {self._named - 1}: expected agents below {smallest}, as in {sizes}")

    def _check_means(self) -> None:
        """Raise if the alignment weights of all neighbours of an agent are zero."""
        if not isinstance(self.sigma, tuple) or not self.normalised:
            return
        sigma = np.array(self.sigma)
        is_neighbour = ~np.eye(len(sigma), dtype=bool) if self.edges is None else np.zeros(sigma.shape, dtype=bool)
        for j, i in self.edges or ():
            is_neighbour[i, j] = True
        is_silent = is_neighbour.any(axis=1) & ((sigma * is_neighbour).sum(axis=1) == 0.0)
        if is_silent.any() and sigma.any():
            i = int(np.argmax(is_silent))
            raise ArgumentError(
                f"sigma[{i}] sums to zero over the agents that {i} may perceive: expected a weight > 0; for separation "
                "alone give sigma=0"
            )

    @property
    def agents(self) -> int | None:
        """Number of agents implied by per-agent parameters; None if all are single numbers."""
        return next(iter(self._sizes.values()), None)

    def check_agents(self, n: int) -> None:  # noqa: D102
        if n < self._named or (self.agents is not None and n != self.agents):
            raise ArgumentError(
                f"{n} agents: expected {self.agents or f'at least {self._named}'}, as the law's parameters name them"
            )

    @cached_property
    def _frozen(self) -> EdgeData:
        pairs = np.array(self.edges, dtype=np.int64)
        return weighed_edges(self, pairs[:, 1].copy(), pairs[:, 0].copy())

    def edge_data(self, q: FloatArray) -> EdgeData:
        """Return directed edges of a state with their weights and spacings, unchecked."""
        if self.edges is not None:
            return self._frozen
        return weighed_edges(self, *kernel.perceived_edges(q, np.full(len(q), self.radius)))

    def perceived(self, q: Any) -> Edges:
        """Return the directed edges (j, i) of a state, where i perceives j.

        Examples
        --------
        >>> MinimalFlocking((3.0, 1.0)).perceived([[0.0], [2.0]])
        ((1, 0),)
        """
        q = value_checks.ensure_points("q", q)
        self.check_agents(len(q))
        data = self.edge_data(q)
        return tuple(zip(data.tail.tolist(), data.head.tolist(), strict=True))

    @cached_property
    def reciprocal(self) -> bool:
        """Whether the graph is frozen and every edge has an equal reverse edge."""
        # Equal but for rounding: a spacing β_i r_i |N_i| is a product, and so is all that is given in other
        # units.
        if self.edges is None:
            return False
        edge_values = dict(zip(self.edges, np.array(self._frozen[2:]).T, strict=True))
        pairs = [(value, edge_values.get((i, j))) for (j, i), value in edge_values.items()]
        return all(back is not None and np.allclose(value, back, rtol=_EQUAL, atol=0.0) for value, back in pairs)

    @property
    def _one_weight(self) -> bool:
        """Whether all perceived agents have the same weight."""
        return self.edges is None and isinstance(self.mu, float) and isinstance(self.sigma, float)

    def _alike(self, n: int) -> kernel.EqualEdges:
        """Return the kernel parameters of n agents for a law that weighs all perceived agents equally."""
        radius = np.full(n, self.radius)
        spacing = self.spacing if self.beta is None else np.array(self.beta) * radius
        spacings = np.full(n, 1.0 if spacing is None else spacing)
        mu, sigma = float(self.mu), float(self.sigma)  # type: ignore[arg-type]  # numbers, as all weights are equal
        return kernel.EqualEdges(radius, spacings, self.spacing is None, mu, sigma, self.normalised)

    def block(self, solver: Any) -> Block | None:
        """Return a function that makes many semi-implicit Euler steps; None for other solvers."""
        if solver.position_factor != 1.0:
            return None

        def steps(times: FloatArray, q: FloatArray, p: FloatArray, wanted: IndexArray) -> Any:
            if not self.steps_many(len(q)):
                return None
            return tuple(part[wanted - 1] for part in self.semi_implicit(q, p, solver.dt, len(times)))

        return steps

    def steps_many(self, n: int) -> bool:
        """Return whether `semi_implicit` is used for a flock of this size, rather than `flow`."""
        return (
            self._one_weight and n <= kernel.AT_ONCE and overrides_consistently(type(self), "semi_implicit", ("flow",))
        )

    def semi_implicit(
        self, q: FloatArray, p: FloatArray, dt: float, steps: int
    ) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return positions and velocities after, and inputs before, each semi-implicit Euler step."""
        return kernel.semi_implicit_steps(q, p, self._alike(len(q)), dt, steps)

    def flow(self, t: float, q: FloatArray, p: FloatArray) -> tuple[FloatArray, float]:
        """Return (u, dH/dt), unchecked; dH/dt = −Σ σ ‖v_i − v_j‖² over links if `reciprocal`, else NaN."""
        u = np.zeros_like(q)
        if self._one_weight:
            kernel.perceived_forces(q, p, self._alike(len(q)), u)
            return u, float("nan")
        dissipated_power = kernel.edge_forces(q, p, *self.edge_data(q), u)
        return u, -0.5 * dissipated_power if self.reciprocal else float("nan")

    def hamiltonian(self, t: float, q: FloatArray, p: FloatArray) -> float:
        """Return H = ½ Σ‖v_i − v̄‖² + ½ Σ μ (‖x‖ − ρ)² over links if `reciprocal`, else NaN; unchecked."""
        if not self.reciprocal:
            return float("nan")
        head, tail, mu, rho, _ = self._frozen
        stretch = np.linalg.norm(q[tail] - q[head], axis=1) - rho
        v = p - p.mean(axis=0)
        return 0.5 * float(np.sum(v * v)) + 0.25 * float(np.sum(mu * stretch * stretch))  # links come twice

    def measures(self, t: FloatArray, q: FloatArray, p: FloatArray, extra: Arrays) -> Mapping[str, Any]:  # noqa: D102
        if self.edges is not None:
            head, tail, _, rho, _ = self._frozen
            errors = np.abs(lengths(q[:, tail] - q[:, head]) - rho)
            text = "largest edge error | ‖x_e‖ − ρ_e | (length)"
            return {"edge_error": Series(text, errors.max(axis=1), logarithmic=True)} | _profile(q)
        return self._net_series(q) | _profile(q)

    def _net_series(self, q: FloatArray) -> dict[str, Any]:
        """Return connectivity of the perception graph and share of its largest component over time."""
        labels = [components(q.shape[1], np.column_stack(self.edge_data(item)[:2])) for item in q]
        parts, largest = (np.array([f(np.bincount(item)) for item in labels], float) for f in (np.size, np.max))
        n = q.shape[1]
        return {
            "connectivity": ("C = rank(L)/(n − 1), directions forgotten", (n - parts) / max(n - 1, 1)),
            "giant_share": ("C*, share of nodes", largest / n),
        }

    def derivatives(self, t: float, q: FloatArray, p: FloatArray) -> Derivatives:
        """Return (∂u/∂q, ∂u/∂p), sparse, with the graph frozen at q, unchecked.

        ∂u_i/∂q_j = μ ((1 − ρ/‖x‖) I + ρ/‖x‖ b bᵀ) with the bearing b = x/‖x‖, and ∂u_i/∂p_j = a I; the blocks of an
        agent sum to zero. Where an agent comes or goes the law jumps and has no derivative: that is not seen here.

        Raises
        ------
        ArgumentError
            If two agents coincide of which one perceives the other.
        """
        from scipy.sparse import coo_array

        n, m = q.shape
        head, tail, mu, rho, align_weights = self.edge_data(q)
        x = q[tail] - q[head]
        distance = np.linalg.norm(x, axis=1)[:, None, None]
        if not distance.all():
            e = int(np.argmin(distance))
            raise ArgumentError(f"agents {tail[e]} and {head[e]} coincide: expected distinct ones, for a derivative")
        bearing = x[:, :, None] / distance
        ratio, identity = rho[:, None, None] / distance, np.eye(m)
        stiffness = mu[:, None, None] * ((1.0 - ratio) * identity + ratio * bearing * bearing.transpose(0, 2, 1))
        rows, columns = (m * head[:, None] + np.arange(m))[:, :, None], (m * tail[:, None] + np.arange(m))[:, None, :]
        own_columns = (m * head[:, None] + np.arange(m))[:, None, :]

        def summed(blocks: FloatArray) -> Any:
            """Return the sparse matrix with each edge's block added at (i, j) and subtracted at (i, i)."""
            entries = np.concatenate([blocks.ravel(), -blocks.ravel()])
            at = [np.broadcast_to(index, blocks.shape).ravel() for index in (rows, rows, columns, own_columns)]
            indices = np.concatenate(at[:2]), np.concatenate(at[2:])
            return coo_array((entries, indices), shape=(n * m, n * m)).tocsr()

        return summed(stiffness), summed(align_weights[:, None, None] * identity)

    def discrete(self, dt: float = 0.1) -> DiscreteMinimalFlocking:
        """Return the law as a discrete map, as simulated in the paper."""
        return DiscreteMinimalFlocking(self, dt)


def _profile(q: FloatArray) -> dict[str, Any]:
    """Return median and largest distance of all pairs, as in Fig. 10."""
    median, largest = pair_distance_profile(q, (0.5, 1.0)).T
    return {
        "median_distance": ("median distance of two agents (length)", median),
        "largest_distance": ("largest distance of two agents (length)", largest),
    }


@dataclass(frozen=True)
class DiscreteMinimalFlocking(DiscreteLaw):
    """v' = v + δ u(p, v), p' = p + δ v': the minimal model in the order of the paper's Algorithm 1, all agents at once.

    Parameters
    ----------
    dt : float
        Step δ; 0.1 in the paper.

    Examples
    --------
    >>> law = MinimalFlocking(edges=[(0, 1)], spacing=1.0).discrete(0.5)
    >>> q, p, u, _ = law.step(0.0, np.array([[0.0], [2.0]]), np.zeros((2, 1)), {})
    >>> q[1].tolist(), p[1].tolist(), u[1].tolist()
    ([1.75], [-0.5], [-1.0])
    """

    law: MinimalFlocking
    dt: float = 0.1

    units: ClassVar[Mapping[str, Powers]] = {"dt": (0, 1)}
    references = ("jond-2025",)
    position_factor = 1.0
    steps_at_once = 4096

    def __post_init__(self) -> None:
        value_checks.ensure_kind("law", self.law, MinimalFlocking, "MinimalFlocking(...)")
        normalise(self, value_checks.ensure_positive, "dt")

    def step(self, t: float, q: FloatArray, p: FloatArray, memory: Arrays) -> States:  # noqa: D102
        u = self.law.flow(t, q, p)[0]
        p = p + self.dt * u
        return q + self.dt * p, p, u, memory

    def iterate(self, t: float, q: FloatArray, p: FloatArray, memory: Arrays, steps: int) -> States:  # noqa: D102
        if self.law.steps_many(len(q)) and overrides_consistently(type(self), "iterate", ("step", "start")):
            return (*self.law.semi_implicit(q, p, self.dt, steps), {})
        return super().iterate(t, q, p, memory, steps)
