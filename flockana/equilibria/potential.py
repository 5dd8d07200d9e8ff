"""The potential whose equilibria are sought, for Algorithms 1, 2 and 3: value, force, stiffness, symmetries."""

from __future__ import annotations

from dataclasses import dataclass
from math import sqrt
from typing import Any, TypeAlias

import numpy as np

from flockana.checks import FloatArray
from flockana.environment.obstacles import Sphere, Wall
from flockana.errors import ArgumentError
from flockana.laws.algorithm3 import Algorithm3
from flockana.laws.olfati_saber import Algorithm1, Algorithm2, moving_frame
from flockana.nets import LinkArray
from flockana.terminal import rigid_motions

FlockLaw: TypeAlias = Algorithm1 | Algorithm2 | Algorithm3


def ensure_flock_law(law: Any, m: int) -> FlockLaw:
    """Return the law if it is Algorithm 1, 2 or 3 in m dimensions.

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
    if not isinstance(law, Algorithm1 | Algorithm2 | Algorithm3):
        raise ArgumentError(f"law = {law!r}: expected Algorithm1, Algorithm2 or Algorithm3, whose forces are gradients")
    law.check_dimension(m)
    return law


@dataclass(frozen=True)
class Potential:
    """V (Algorithm 1), U_λ in the moving frame (Algorithm 2), V_α + V_β + V_γ (Algorithm 3) at one time.

    Parameters
    ----------
    law : Algorithm1, Algorithm2 or Algorithm3
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
    def force_scale(self) -> float:
        """c1α b/√ε, the strongest force between two agents, nearly."""
        return self.law.gains.c1_alpha * self.law.alpha.b / sqrt(self.law.alpha.eps)

    @property
    def target(self) -> FloatArray | None:
        """q_r(t), None under Algorithm 1."""
        return None if isinstance(self.law, Algorithm1) else np.asarray(self.law.target.state(self.t)[0], dtype=float)

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
        """Its value from the listed pairs, less ψ_α(r_α) for each pair of agents: no large constant to round.

        Parameters
        ----------
        q : ndarray, shape (n, m)
            Positions.
        pairs : int array, shape (M, 2)
            Pairs, all those within range among them.
        """
        law, alpha, g = self.law, self.law.alpha, self.law.gains
        z = alpha.sigma_norm(np.linalg.norm(q[pairs[:, 1]] - q[pairs[:, 0]], axis=1))
        total = g.c1_alpha * float(np.sum(alpha.psi_alpha(z) - alpha.far_potential))
        if isinstance(law, Algorithm2):
            total += 0.5 * g.c1_gamma * float(np.sum(moving_frame(q) ** 2))
        elif isinstance(law, Algorithm3):
            x2 = np.sum((q - self.centre) ** 2, axis=1)
            total += g.c1_gamma * float(np.sum(x2 / (np.sqrt(1.0 + x2) + 1.0)))
            total += g.c1_beta * law.obstacle_field.potential_energy(q)
        return total

    def force(self, q: FloatArray) -> FloatArray:
        """Its negative gradient by the law's own kernels, shape (n, m).

        Parameters
        ----------
        q : ndarray, shape (n, m)
            Positions.
        """
        if not isinstance(self.law, Algorithm3):
            return moving_frame(self.law.flow(self.t, q, np.zeros_like(q))[0])
        p_r = np.broadcast_to(self.law.target.state(self.t)[1], q.shape)  # at this velocity the γ-agent does not pull
        still = np.zeros_like(q)
        push: FloatArray = self.law.flow(self.t, q, still)[0] - self.law.gains.c2_gamma * p_r
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

        All of them under Algorithms 1 and 2; under Algorithm 3 the rotations about the γ-agent that move no obstacle.

        Parameters
        ----------
        q : ndarray, shape (n, m)
            Positions.
        """
        if not isinstance(self.law, Algorithm3):
            return rigid_motions(q)
        x = q - self.centre
        turns = [(x @ generator.T).ravel() for generator in _free_rotations(self.law, self.centre)]
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


def _free_rotations(law: Algorithm3, centre: FloatArray) -> list[FloatArray]:
    """Skew matrices that map every obstacle's axis (its centre from q_r, its normal) to zero: they move none."""
    m = law.target.dimension
    generators = []
    for a in range(m):
        for b in range(a):
            skew = np.zeros((m, m))
            skew[a, b], skew[b, a] = 1.0, -1.0
            generators.append(skew)
    if not generators or not law.obstacles:
        return generators
    axes = []
    for obstacle in law.obstacles:
        if isinstance(obstacle, Sphere):
            axes.append(np.asarray(obstacle.centre) - centre)
        elif isinstance(obstacle, Wall):
            axes.append(np.asarray(obstacle.par[m:]))
        else:
            return []
    moved = np.array([[generator @ axis for axis in axes] for generator in generators]).reshape(len(generators), -1)
    _, sizes, rows = np.linalg.svd(moved.T, full_matrices=True)
    size = max(1.0, float(np.abs(moved).max()))
    kept = [k for k in range(len(generators)) if k >= sizes.size or sizes[k] <= 1e-12 * size]
    return [np.tensordot(rows[k], generators, axes=1) for k in kept]
