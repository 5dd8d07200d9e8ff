"""The potential whose equilibria are sought, for Algorithms 1, 2 and 3: value, force, stiffness, symmetries."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np

from flockana.base.checks import FloatArray
from flockana.base.errors import ArgumentError
from flockana.environment.obstacles import Obstacle, Sphere, Wall
from flockana.equilibria.terminal import rigid_motions
from flockana.interactions.gains import weighted
from flockana.interactions.pair import PairInteraction
from flockana.laws.algorithm3 import Algorithm3
from flockana.laws.dead_zone import DeadZoneFlocking
from flockana.laws.olfati_saber import Algorithm1, Algorithm2, moving_frame
from flockana.measures.nets import LinkArray

_CONCENTRIC = 1e-12  # of unit axes, or of the lengths at hand: what is less is rounding

FlockLaw: TypeAlias = Algorithm1 | Algorithm2 | Algorithm3 | DeadZoneFlocking


def ensure_flock_law(law: Any, m: int) -> FlockLaw:
    """Return the law if it is Algorithm 1, 2 or 3, or dead-zone flocking with a ramp, in m dimensions.

    Parameters
    ----------
    law : object
        What the caller gave.
    m : int
        Dimension of the flock.

    Raises
    ------
    ArgumentError
        If it is another law, or lives in another dimension.

    Examples
    --------
    >>> ensure_flock_law(Algorithm1(), 2) == Algorithm1()
    True
    """
    if not isinstance(law, FlockLaw):
        raise ArgumentError(
            f"law = {law!r}: expected Algorithm1, Algorithm2 or Algorithm3, or DeadZoneFlocking: their forces are "
            "gradients"
        )
    if isinstance(law, DeadZoneFlocking) and law.located:
        raise ArgumentError(
            "ramp = 0: contacts sit where the force jumps and never vanishes; give the interaction a ramp"
        )
    law.check_dimension(m)
    return law


@dataclass(frozen=True)
class Potential:
    """V (Algorithm 1, dead zone), U_λ in the moving frame (Algorithm 2), V_α + V_β + V_γ (Algorithm 3) at one time.

    Under Algorithm 2 with per-agent gains the γ-agent's pull fixes the flock in space, as under Algorithm 3:
    c1α V + ½ Σ c1γ_i ‖q_i − q_r‖².

    Parameters
    ----------
    law : Algorithm1, Algorithm2, Algorithm3 or DeadZoneFlocking
        The law.
    t : float
        When: a γ-agent may move.

    Examples
    --------
    >>> Potential(Algorithm1()).force(np.array([[0.0], [7.0]])).ravel().tolist()
    [0.0, 0.0]
    """

    law: FlockLaw
    t: float = 0.0

    @property
    def pinned(self) -> bool:
        """Whether it knows where the flock is, so that a translation changes it."""
        return isinstance(self.law, Algorithm3) or (isinstance(self.law, Algorithm2) and self.law.gains.per_agent)

    @property
    def force_scale(self) -> float:
        """The law's own: the strongest force between two agents, nearly; of the dead zone, of a contact."""
        return self.law.scales.force

    @property
    def pair(self) -> PairInteraction:
        """The pair law among agents."""
        return self.law.interaction if isinstance(self.law, DeadZoneFlocking) else self.law.alpha

    @property
    def gain(self) -> float:
        """What its potential is multiplied by, c1α; 1 for the dead zone, which carries its own."""
        return 1.0 if isinstance(self.law, DeadZoneFlocking) else self.law.gains.c1_alpha

    @property
    def target(self) -> FloatArray | None:
        """q_r(t), None under a law without γ-agent."""
        return (
            None
            if isinstance(self.law, Algorithm1 | DeadZoneFlocking)
            else np.asarray(self.law.target.state(self.t)[0], dtype=float)
        )

    @property
    def centre(self) -> FloatArray:
        """q_r(t) of a law that has a γ-agent."""
        if (target := self.target) is None:
            raise ArgumentError(f"{self.law}: expected a law with a γ-agent")
        return target

    def energy(self, q: FloatArray) -> float:
        """Its value, pairs out of range included.

        Parameters
        ----------
        q : ndarray, shape (n, m)
            Positions.
        """
        return float(self.law.hamiltonian(self.t, q, np.zeros_like(q)))

    def listed_energy(self, q: FloatArray, pairs: LinkArray) -> float:
        """Its value from the listed pairs, less the far potential of each pair of agents: no large constant to round.

        Parameters
        ----------
        q : ndarray, shape (n, m)
            Positions.
        pairs : int array, shape (M, 2)
            Pairs, all those within range among them.
        """
        law, lengths = self.law, np.linalg.norm(q[pairs[:, 1]] - q[pairs[:, 0]], axis=1)
        total = self.gain * float(np.sum(self.pair.energy_at(lengths) - self.pair.far_potential))
        if isinstance(law, DeadZoneFlocking):
            return total
        g = law.gains
        if isinstance(law, Algorithm2) and not self.pinned:
            total += 0.5 * g.c1_gamma * float(np.sum(moving_frame(q) ** 2))
        elif isinstance(law, Algorithm2):
            total += weighted(g.c1_gamma, 0.5 * np.sum((q - self.centre) ** 2, axis=1))
        elif isinstance(law, Algorithm3):
            x2 = np.sum((q - self.centre) ** 2, axis=1)
            total += weighted(g.c1_gamma, x2 / (np.sqrt(1.0 + x2 / law.alpha.unit**2) + 1.0))
            total += g.c1_beta * law.obstacle_field.potential_energy(q)
        return total

    def force(self, q: FloatArray) -> FloatArray:
        """Its negative gradient by the law's own kernels, shape (n, m).

        Parameters
        ----------
        q : ndarray, shape (n, m)
            Positions.
        """
        if not self.pinned:
            return moving_frame(self.law.flow(self.t, q, np.zeros_like(q))[0])
        assert isinstance(self.law, Algorithm2 | Algorithm3)
        p_r = np.broadcast_to(self.law.target.state(self.t)[1], q.shape)  # at this velocity the γ-agent does not pull
        still = np.zeros_like(q)
        push: FloatArray = self.law.flow(self.t, q, still)[0] - self.law.gains.drag * p_r
        return push

    def residual(self, q: FloatArray) -> float:
        """Largest force on an agent over `force_scale`.

        Parameters
        ----------
        q : ndarray, shape (n, m)
            Positions.
        """
        return float(np.linalg.norm(self.force(q), axis=1).max()) / self.force_scale

    def stiffness(self, q: FloatArray) -> Any:
        """Its Hessian, sparse, in the order of ``q.ravel()``.

        Parameters
        ----------
        q : ndarray, shape (n, m)
            Positions.
        """
        return self.law.stiffness(q, self.t) if isinstance(self.law, Algorithm3) else self.law.stiffness(q)

    def symmetries(self, q: FloatArray) -> FloatArray:
        """Orthonormal basis (n m, k) of the rigid motions that leave it unchanged.

        All of them under Algorithms 1 and 2 and the dead zone; under Algorithm 3 the rotations about the γ-agent that
        move no obstacle, and those about it under Algorithm 2 with per-agent gains.

        Parameters
        ----------
        q : ndarray, shape (n, m)
            Positions.
        """
        if not self.pinned:
            return rigid_motions(q)
        x, obstacles = q - self.centre, self.law.obstacles if isinstance(self.law, Algorithm3) else ()
        free = _free_rotations(obstacles, self.centre, self.pair.length)
        turns = [(x @ generator.T).ravel() for generator in free]
        if not turns or not np.any(turns):
            return np.zeros((q.size, 0))
        basis, sizes, _ = np.linalg.svd(np.array(turns).T, full_matrices=False)
        independent: FloatArray = basis[:, sizes > 1e-9 * sizes.max()]
        return independent


def inside_obstacle(law: FlockLaw, q: FloatArray) -> bool:
    """Whether an agent is inside an obstacle of Algorithm 3, where ψ_β falls again and means nothing.

    Parameters
    ----------
    law : Algorithm1, Algorithm2 or Algorithm3
        The law.
    q : ndarray, shape (n, m)
        Positions.
    """
    obstacles = law.obstacles if isinstance(law, Algorithm3) else ()
    return not np.isfinite(q).all() or any(bool(obstacle.contains(q).any()) for obstacle in obstacles)


def _free_rotations(obstacles: Sequence[Obstacle], centre: FloatArray, length: float) -> list[FloatArray]:
    """Skew matrices that map every obstacle's axis (its centre from q_r, its normal) to zero: they move none.

    A sphere whose centre is within rounding of q_r, beside the law's length, has no axis.
    """
    m = centre.size
    generators = []
    for a in range(m):
        for b in range(a):
            skew = np.zeros((m, m))
            skew[a, b], skew[b, a] = 1.0, -1.0
            generators.append(skew)
    if not generators or not obstacles:
        return generators
    axes = []
    for obstacle in obstacles:
        if isinstance(obstacle, Sphere):
            axis = np.asarray(obstacle.centre) - centre
            off = float(np.linalg.norm(axis))
            axes.append(axis / off if off > _CONCENTRIC * max(length, float(np.abs(centre).max())) else 0.0 * axis)
        elif isinstance(obstacle, Wall):
            axes.append(np.asarray(obstacle.par[m:]))
        else:
            return []
    moved = np.array([[generator @ axis for axis in axes] for generator in generators]).reshape(len(generators), -1)
    _, sizes, rows = np.linalg.svd(moved.T, full_matrices=True)
    kept = [k for k in range(len(generators)) if k >= sizes.size or sizes[k] <= _CONCENTRIC]  # of unit axes
    return [np.tensordot(rows[k], generators, axes=1) for k in kept]
