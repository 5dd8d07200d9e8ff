"""Potential of a law that is a sum of terms: value, force, stiffness, symmetries."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from flockana.base.errors import ArgumentError
from flockana.base.override_checks import ensure_consistent
from flockana.base.value_checks import FloatArray
from flockana.environment import Obstacle, Sphere, Wall
from flockana.equilibria.final_state import generators, rigid_motions
from flockana.interactions.pair_interaction import PairInteraction
from flockana.laws import Law, Navigation, PairTerm, SumOfTerms
from flockana.measures.centre_frame import moving_frame
from flockana.measures.nets import LinkArray

_CONCENTRIC = 1e-12  # of unit axes, or of the lengths at hand: what is less is rounding


def ensure_flock_law(law: Any, m: int) -> SumOfTerms:
    """Return the law; raise unless its forces are continuous gradients in m dimensions."""
    if not (isinstance(law, SumOfTerms) and law.conservative and law.term(PairTerm)):
        raise ArgumentError(
            "expected a sum of a pair term and others whose forces are gradients, such as Algorithm1, Algorithm2, "
            f"Algorithm3 or DeadZoneFlocking: got {type(law).__name__}"
        )
    if law.located:
        raise ArgumentError(
            "ramp = 0: contacts sit where the force jumps and never vanishes; give the interaction a ramp"
        )
    ensure_consistent(law)
    law.check_dimension(m)
    return law


@dataclass(frozen=True)
class Potential:
    """Sum of the potentials of a law's terms at one time.

    V (Algorithm 1, dead zone), U_λ in the moving frame (Algorithm 2), V_α + V_β + V_γ (Algorithm 3),
    c1α V + ½ Σ c1γ_i ‖q_i − q_r‖² (Algorithm 2 with per-agent gains).
    """

    law: SumOfTerms  # the law, from `ensure_flock_law`
    t: float = 0.0  # when: a γ-agent may move

    @property
    def pinned(self) -> bool:
        """Whether a translation of all agents changes the potential."""
        return any(term.invariance != "rigid motions" for term in self.law.terms)

    @property
    def force_scale(self) -> float:
        """Unit of force of the law, or else the pair law's largest force times its gain."""
        unit_force = self.law.scales
        return self.gain * self.pair.strength if unit_force is None else unit_force.force

    @property
    def pairs(self) -> PairTerm:
        """Pair term of the law: the sum of forces between agents."""
        return self.law.term(PairTerm)  # type: ignore[return-value]  # ensured

    @property
    def pair(self) -> PairInteraction:
        """Pair law among agents, from the law's pair term."""
        return self.pairs.pair

    @property
    def gain(self) -> float:
        """Factor of the pair potential: c1α, or 1 for the dead zone."""
        return self.pairs.stiffness

    @property
    def target(self) -> FloatArray | None:
        """Position q_r(t) of the γ-agent at the potential's time; None without a γ-agent."""
        return None if self.law.target is None else np.asarray(self.law.target.state(self.t)[0], dtype=float)

    def energy(self, q: FloatArray) -> float:
        """Return the potential energy, pairs out of range included."""
        return float(self.law.hamiltonian(self.t, q, np.zeros_like(q)))

    def listed_energy(self, q: FloatArray, pairs: LinkArray) -> float:
        """Return the energy, of listed pairs less their far potential, so that no large constant rounds it."""
        link_lengths = np.linalg.norm(q[pairs[:, 1]] - q[pairs[:, 0]], axis=1)
        total = self.gain * float(np.sum(self.pair.energy(link_lengths) - self.pair.far_potential))
        other_terms = (term for term in self.law.terms if term is not self.pairs and not term.idle)
        return total + sum(term.energy(self.t, q) for term in other_terms)

    def force(self, q: FloatArray) -> FloatArray:
        """Return the negative gradient of the potential from the law's kernels, shape (n, m)."""
        push = self.law.flow(self.t, q, np.zeros_like(q))[0]
        if not self.pinned:
            return moving_frame(push)
        if (pull := self.law.term(Navigation)) is None:
            return push
        p_r = np.broadcast_to(pull.target.state(self.t)[1], q.shape)  # at this velocity the γ-agent does not drag
        return push - pull.gains.drag * p_r

    def residual(self, q: FloatArray) -> float:
        """Return the largest force on an agent in units of `force_scale`."""
        return float(np.linalg.norm(self.force(q), axis=1).max()) / self.force_scale

    def stiffness(self, q: FloatArray) -> Any:
        """Return the Hessian of the potential, sparse, in the order of ``q.ravel()``."""
        return self.law.stiffness(q, self.t)

    def symmetries(self, q: FloatArray) -> FloatArray:
        """Return an orthonormal basis (n m, k) of the rigid motions that keep the potential."""
        # All of them where shape and centre move apart; else the rotations about the γ-agent that move no obstacle.
        if not self.pinned:
            return rigid_motions(q)
        if (centre := self.target) is None or any(term.invariance == "none" for term in self.law.terms):
            return np.zeros((q.size, 0))
        x, free_rotations = q - centre, _free_rotations(self.law.obstacles, centre, self.pair.length)
        turns = [(x @ generator.T).ravel() for generator in free_rotations]
        if not turns or not np.any(turns):
            return np.zeros((q.size, 0))
        basis, singular_values, _ = np.linalg.svd(np.array(turns).T, full_matrices=False)
        return basis[:, singular_values > 1e-9 * singular_values.max()]


def inside_obstacle(law: Law, q: FloatArray) -> bool:
    """Return whether an agent is inside an obstacle, where ψ_β falls again."""
    return not np.isfinite(q).all() or any(bool(obstacle.contains(q).any()) for obstacle in law.obstacles)


def _free_rotations(obstacles: Sequence[Obstacle], centre: FloatArray, length: float) -> list[FloatArray]:
    """Return the skew matrices of the rotations about a centre that leave every obstacle in place."""
    # A sphere whose centre is within rounding of q_r, beside the law's length, has no axis.
    from scipy.linalg import null_space

    m = centre.size
    skew = generators(m)
    if not skew or not obstacles:
        return skew
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
    images = np.array([[generator @ axis for axis in axes] for generator in skew]).reshape(len(skew), -1)
    return [np.tensordot(combination, skew, axes=1) for combination in null_space(images.T, rcond=_CONCENTRIC).T]
