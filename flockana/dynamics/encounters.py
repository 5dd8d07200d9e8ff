"""No encounter leapt over: how much of a step may be taken so that each meeting of two agents is met by an evaluation.

Forces of finite range are exactly zero beyond it, so an integrator whose evaluations all lie beyond it sees nothing to
resolve: it may step from before a collision to after it, with an estimated error, and an energy residual, of zero. A
step is therefore looked at once it is made. If no pair that it treats as free came into range on the paths it made,
its paths are those of the full law, and it stands. Where one did, the step is to be made again, and to end with that
pair in range: at the closest approach, or as soon as the two have gone `SHARE` of the law's length within the range.
A pair in range from the start may go as far in a step. The same holds of agents and obstacles, and of each distance at
which a law's force begins, ends or jumps (`Law.surfaces`).

Paths are the quintics that match position, velocity and acceleration at both ends of the step, ranges are widened by
the allowance for their error (`flockana.kernels.paths`), and a first contact is found by halving control polygons:
what is missed is less than the integrator's own error makes of a path. Relative ways count, so a flock's common motion
shortens no step.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from flockana.base.checks import FloatArray
from flockana.environment.beta import ObstacleField
from flockana.kernels.encounters import share_of_all, share_of_pairs
from flockana.kernels.neighbours import pair_blocks
from flockana.kernels.paths import bernstein, centred
from flockana.kernels.poles import crossing
from flockana.laws.law import Law

SHARE = 0.5  # of the law's length: as far may two agents go within each other's range between two evaluations
DENSE = 400  # agents up to which all pairs are looked at rather than searched


class State(NamedTuple):
    """Where the agents are, how they move and what moves them, each of shape (n, m)."""

    q: FloatArray
    p: FloatArray
    u: FloatArray


@dataclass(frozen=True, eq=False)
class Encounters:
    """What the agents of a law may run into.

    Parameters
    ----------
    radii : ndarray, shape (n, K)
        Distances at which each agent begins or ceases to feel another, rising.
    far : float
        How far two agents may go within them in one step.
    bodies : ObstacleField or None
        The law's obstacles.
    shell, skirt : float
        Distance from an obstacle's surface at which its force begins, and how far an agent may go within it.
    poles : ndarray
        Distances between agents that none crosses: their potential is infinite there, or their force undefined.
    among : ndarray, shape (L, 2), optional
        The pairs that poles concern; None: all.
    """

    radii: FloatArray
    far: float
    bodies: ObstacleField | None = None
    shell: float = 0.0
    skirt: float = 0.0
    poles: FloatArray = field(default_factory=lambda: np.empty(0))
    among: npt.NDArray[np.int32] | None = None

    @classmethod
    def of(cls, law: Law, n: int) -> Encounters:
        """Those of a law.

        Examples
        --------
        >>> from flockana.laws.olfati_saber import Algorithm1
        >>> encounters = Encounters.of(Algorithm1(), 2)
        >>> encounters.radii.tolist(), encounters.far
        ([[8.4], [8.4]], 3.5)
        """
        surfaces = [np.broadcast_to(np.asarray(one, dtype=np.float64), (n,)) for one in law.surfaces]
        radii = np.sort(np.array(surfaces).reshape(len(surfaces), n).T, axis=1)
        length = min(np.inf if law.scales is None else law.scales.length, radii[:, -1].min() if surfaces else np.inf)
        bodies, radii, poles = law.obstacle_field, np.ascontiguousarray(radii), np.array(law.poles, dtype=np.float64)
        among = None if law.pole_pairs is None else np.array(law.pole_pairs, dtype=np.int32).reshape(-1, 2)
        if bodies is None or not bodies.obstacles:
            return cls(radii, SHARE * length, poles=poles, among=among)
        return cls(radii, SHARE * length, bodies, bodies.beta.r, SHARE * bodies.beta.d, poles, among)

    @property
    def any(self) -> bool:
        """Whether there is anything to run into."""
        return self.radii.size > 0 or self.bodies is not None or self.poles.size > 0

    def share(self, h: float, before: State, after: State) -> float:
        """How much of a step may be taken, 1 if it stands; negative if a pair crosses a pole.

        Examples
        --------
        Two agents, 200 apart, that pass through each other within one step:

        >>> from flockana.laws.olfati_saber import Algorithm1
        >>> still, p = np.zeros((2, 1)), np.array([[15.0], [-15.0]])
        >>> before, after = (State(np.array(q), p, still) for q in ([[0.0], [200.0]], [[210.0], [-10.0]]))
        >>> h = 14.0 * Encounters.of(Algorithm1(), 2).share(14.0, before, after)
        >>> 200.0 - 8.4 < 30.0 * h < 200.0 - 4.8
        True
        """
        points, _, allowance = bernstein(h, *before, *after)
        share = 1.0 if self.bodies is None else self._share_of_bodies(self.bodies, points, allowance)
        if len(points) == 1 or not (self.radii.size or self.poles.size):
            return share
        reach = centred(points, allowance)
        if self.poles.size and self._crosses(points, reach, before.q):
            return -0.5
        if not self.radii.size:
            return share
        if len(reach) <= DENSE:
            return float(min(share, share_of_all(points, reach, allowance, self.radii, self.far)))
        search = (float(self.radii.max()) + 2.0 * float(reach.max() + allowance.max())) * (1.0 + 1e-9)
        for i, j in pair_blocks(before.q, search):
            share = share_of_pairs(points, reach, allowance, self.radii, self.far, i, j, share)
        return share

    def _crosses(self, points: FloatArray, reach: FloatArray, q: FloatArray) -> bool:
        """Whether a pair crosses a pole."""
        if self.among is not None:
            first, second = (np.ascontiguousarray(ends) for ends in self.among.T)
            return bool(crossing(points, reach, self.poles, first, second))
        around = (float(self.poles.max()) + 2.0 * float(reach.max())) * (1.0 + 1e-9)
        return any(crossing(points, reach, self.poles, i, j) for i, j in pair_blocks(q, around))

    def _share_of_bodies(self, field: ObstacleField, points: FloatArray, allowance: FloatArray) -> float:
        """The share of the step that the obstacles allow."""
        share = 1.0
        for kernels, _, pars, starts, balls in field.kinds:
            share = kernels.share(points, allowance, pars, starts, balls, self.shell, self.skirt, share)
        return share


def at_a_pole(t: float) -> str:
    """Return why a run ended that no shorter step takes past a pole."""
    return f"agents met at t = {t:g} where their potential is infinite or their force has no limit: no motion goes on"
