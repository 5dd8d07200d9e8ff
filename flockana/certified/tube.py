"""Tubes: sets that provably contain a run at its steps, and boxes between the steps."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import combinations
from math import inf, nextafter
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from flint import arb, ctx

from flockana.base.errors import ArgumentError, format_value
from flockana.base.integrity_seals import ensure_sealed
from flockana.base.value_checks import FloatArray
from flockana.certified.balls import minus, norm
from flockana.certified.flow_in_balls import sphere_terms
from flockana.certified.structural_energy import BITS, structural_energy
from flockana.laws.olfati_saber import Algorithm1, Algorithm2

if TYPE_CHECKING:
    from flockana.certified.basin import Basin
    from flockana.certified.lohner import StateSet, Step

    BasinLike = Basin

Pair = tuple[int, int]


class Approach(NamedTuple):
    """Closest approach of two agents: a proved lower bound, the pair, and the begin of the step."""

    lower: float
    pair: Pair
    time: float


class ObstacleApproach(NamedTuple):
    """Closest approach to an obstacle: a proved lower bound, agent, obstacle, and begin of the step."""

    lower: float
    agent: int
    obstacle: int
    time: float


@dataclass(frozen=True)
class Tube:
    """Sets that hold every solution from a start or a box of starts, proved in ball arithmetic.

    The law enclosed is the one whose every parameter is the decimal that it prints as (0.1 is one tenth); a simulation
    computes with the nearest binary number, and a start or a time is exactly its binary number here too.

    Parameters
    ----------
    q0, p0 : ndarray, shape (n, m)
        The start, or the middle of the starts.
    t : tuple of float
        Times of the steps, exact; the first is that of the start.
    sets : tuple
        The sets at these times (`flockana.certified.lohner.StateSet`).
    taken : tuple
        What is known between them, one less (`flockana.certified.lohner.Step`).
    status : {"complete", "broken", "interrupted"}
        Whether it reaches the end of its time span.
    message : str
        Where and why it ends early.
    stats : dict
        Knobs and seconds.

    Examples
    --------
    >>> from flockana.certified.enclose_run import enclose
    >>> from flockana.laws.olfati_saber import Algorithm1
    >>> tube = enclose(Algorithm1(), [[0.0], [9.0]], [[1.0], [2.0]], (0.0, 2.0))  # out of range: uniform motion
    >>> tube.min_distance().pair, 8.0 < tube.min_distance().lower <= 9.0, tube.q[-1].ravel().tolist()
    ((0, 1), True, [2.0, 13.0])
    """

    law: Any
    q0: FloatArray
    p0: FloatArray
    t: tuple[float, ...]
    sets: tuple[StateSet, ...]
    taken: tuple[Step, ...]
    status: str
    message: str
    stats: dict[str, Any]

    def __repr__(self) -> str:
        facts = f"{self.n} agents, m = {self.m}, {self.law.title}, {len(self.taken)} steps"
        return f"<Tube of {facts}, t = {float(self.t[0]):g} to {float(self.t[-1]):g}, {self.status}>"

    def ensure_unedited(self) -> None:
        """Raise unless the tube is unchanged since `enclose` returned it."""
        ensure_sealed("tube", self, "a tube as enclose returned it", "enclose(law, q0, p0, t_span) proves another")

    @property
    def n(self) -> int:
        """Number of agents."""
        return len(self.q0)

    @property
    def m(self) -> int:
        """Dimension m of the space in which the agents move."""
        return int(self.q0.shape[1])

    @property
    def q(self) -> FloatArray:
        """Midpoints of the positions at the steps, shape (T, n, m), for drawing."""
        return self._midpoints[:, 0]

    @property
    def p(self) -> FloatArray:
        """Midpoints of the velocities at the steps, shape (T, n, m), for drawing."""
        return self._midpoints[:, 1]

    @cached_property
    def boxes(self) -> tuple[list[arb], ...]:
        """Boxes that contain positions and velocities of all enclosed solutions at each step, as balls."""
        with ctx.workprec(BITS):
            return tuple(item.hull for item in self.sets)

    @cached_property
    def _midpoints(self) -> FloatArray:
        return self._array([[float(x.mid()) for x in box] for box in self.boxes])

    @cached_property
    def radii(self) -> FloatArray:
        """Half-widths of the boxes of positions and of velocities about `q` and `p`, rounded up, shape (T, 2, n, m)."""
        rows = zip(self.boxes, self._midpoints.reshape(len(self.t), -1).tolist(), strict=True)
        with ctx.workprec(BITS):
            return self._array([[up((x - y).abs_upper()) for x, y in zip(box, row, strict=True)] for box, row in rows])

    def _array(self, rows: list[list[float]]) -> FloatArray:
        return np.array(rows).reshape(len(self.t), 2, self.n, self.m)

    def state(self, k: int) -> tuple[list[list[arb]], list[list[arb]]]:
        """Return (q, p) at step k as balls, each as a list of agents.

        Parameters
        ----------
        k : int
            Step; negative from the end.
        """
        m, box = self.m, self.boxes[k]
        rows = [box[i : i + m] for i in range(0, len(box), m)]
        return rows[: self.n], rows[self.n :]

    @property
    def pairs(self) -> list[Pair]:
        """All pairs (i, j) of agents with i < j, in the order of `distances_during`."""
        return list(combinations(range(self.n), 2))

    def distances_during(self, k: int) -> list[arb]:
        """Return balls that hold the distance of each pair from step k to the next.

        Parameters
        ----------
        k : int
            Step, the last one excluded.
        """
        with ctx.workprec(BITS):
            return [norm(gap) for gap in self.taken[k].relative]

    def min_distance(self) -> Approach:
        """Return a proved lower bound of the distance of any two agents over the whole tube."""
        with ctx.workprec(BITS):  # the start by itself: a tube may break before its first step
            start = [minus(y, x) for x, y in combinations(self.state(0)[0], 2)]
            rows = [[norm(gap) for gap in gaps] for gaps in (start, *(step.relative for step in self.taken))]
        approaches = [
            Approach(down(distance.lower()), pair, t)
            for t, row in zip((self.t[0], *self.t), rows, strict=False)
            for pair, distance in zip(self.pairs, row, strict=True)
        ]
        return min(approaches, key=lambda one: one.lower, default=Approach(inf, (0, 0), self.t[0]))

    def clearances_during(self, k: int) -> list[list[arb]]:
        """Return balls that hold the agents' clearances from each obstacle, from step k to the next.

        Parameters
        ----------
        k : int
            Step, the last one excluded.
        """
        with ctx.workprec(BITS):
            return self._clearances(self.taken[k].during)

    def _clearances(self, box: Sequence[arb]) -> list[list[arb]]:
        """Return the clearances of each agent from each obstacle, anywhere in a box."""
        agents = [box[i : i + self.m] for i in range(0, self.n * self.m, self.m)]
        terms = sphere_terms(self.law) if self.law.obstacles else ()
        return [[term.clearance(x) for x in agents] for term in terms]

    def min_clearance(self) -> ObstacleApproach:
        """Return a proved lower bound of any agent's clearance from any obstacle over the whole tube."""
        with ctx.workprec(BITS):
            rows = [self._clearances(box) for box in (self.boxes[0], *(step.during for step in self.taken))]
        clearances = [
            ObstacleApproach(down(clearance.lower()) if clearance.is_finite() else -inf, agent, obstacle, t)
            for t, row in zip((self.t[0], *self.t), rows, strict=False)
            for obstacle, own_clearance in enumerate(row)
            for agent, clearance in enumerate(own_clearance)
        ]
        return min(clearances, key=lambda one: one.lower, default=ObstacleApproach(inf, 0, 0, self.t[0]))

    def cohesion_radius(self) -> FloatArray:
        """Return proved upper bounds of R = max ‖q_i − q_c‖ between steps, shape (T − 1,)."""
        with ctx.workprec(BITS):
            return np.array([max(up(norm(x).upper()) for x in step.deviations) for step in self.taken])

    def energy(self, k: int) -> arb:
        """Return a ball around the structural energy c1α V(x) + c1γ J(x) + K(v) at step k.

        Parameters
        ----------
        k : int
            Step; negative from the end.
        """
        if type(law := self.law) not in (Algorithm1, Algorithm2):
            raise ArgumentError(
                f"law = {format_value(law)}: expected Algorithm1 or Algorithm2, whose structural energy this is"
            )
        return structural_energy(law, *self.state(k))

    def ends_in(self, basin: Basin) -> bool:
        """Return whether every state at the end lies in a certified basin of the same law.

        Parameters
        ----------
        basin : Basin
            Of `flockana.certify`.

        Raises
        ------
        ArgumentError
            If either was made or changed by hand.
        """
        self.ensure_unedited()
        basin.ensure_unedited()
        return bool(basin.law == self.law and basin.holds(*self.state(-1)))


def up(x: arb) -> float:
    """Return a float that is certainly not below an exact number."""
    return nextafter(float(x), inf)


def down(x: arb) -> float:
    """Return a float that is certainly not above an exact number."""
    return nextafter(float(x), -inf)
