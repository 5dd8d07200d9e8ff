"""Step limits that keep an integrator from stepping over an encounter of two agents.

Forces of finite range are exactly zero beyond it, so an integrator whose evaluations all lie beyond it sees nothing to
resolve: it may step from before a collision to after it, with an estimated error, and an energy residual, of zero. A
step is therefore looked at once it is made. If no pair that it treats as free came into range on the paths it made,
its paths are those of the full law, and it stands. Where one did, the step is to be made again, and to end with that
pair in range: at the closest approach, or as soon as the two have gone `SHARE` of the law's length within the range.
A pair in range from the start may go as far in a step. The same holds of agents and obstacles, and of each distance at
which a law's force begins, ends or jumps (`Law.surfaces`).

Paths are the quintics that match position, velocity and acceleration at both ends of the step, ranges are widened by
the allowance for their error (`flockana.kernels.quintic_paths`), and a first contact is found by halving polygons: what
is missed is less than the integrator's own error makes of a path. Relative ways count, so a flock's common motion
shortens no step.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from flockana.base.value_checks import FloatArray
from flockana.dynamics.moving_frame import Frame, Plan
from flockana.environment.beta_agents import ObstacleField
from flockana.jit import Kernel, callback_like, thawed
from flockana.kernels.adaptive_steps import Block
from flockana.kernels.alpha import BETA_AREA
from flockana.kernels.bound_templates import bound
from flockana.kernels.cell_grid import LARGE
from flockana.kernels.encounter_checks import Around, Ends
from flockana.kernels.large_flocks import as_callback, covering, lister
from flockana.kernels.law_kernels import guard_of
from flockana.kernels.obstacle_terms import body_numbers
from flockana.kernels.step_checks import IN_VAIN, PATIENCE, Judged, Rules, checked, empty_ledger
from flockana.kernels.step_shares import TOO_MANY
from flockana.kernels.verlet_list import COUNT, Pairs, no_pairs, with_room
from flockana.laws.law import LawOfMotion

SHARE = 0.5  # of the law's length: as far may two agents go within each other's range between two evaluations
BALANCED = 0.05  # of the relative tolerance: residual of the energy's balance that a step may leave, over |H|
_TOWARD = 0.5  # of the way to a pole that a step of fixed length may go: no error estimate says that it is resolved


class State(NamedTuple):
    """Positions, velocities and accelerations of the flock, each of shape (n, m)."""

    q: FloatArray
    p: FloatArray
    u: FloatArray


@dataclass(frozen=True, eq=False)
class Encounters:
    """Interaction distances, singular distances and obstacles of a law that no step may skip over."""

    radii: FloatArray  # (n, K): distances at which each agent begins or ceases to feel another, rising
    far: float  # how far two agents may go within them in one step
    bodies: ObstacleField | None = None
    shell: float = 0.0  # distance from an obstacle's surface at which its force begins
    skirt: float = 0.0  # how far an agent may go within it
    poles: FloatArray = field(default_factory=lambda: np.empty(0))  # distances between agents that none crosses
    among: npt.NDArray[np.int32] | None = None  # (L, 2): the pairs that poles concern; None: all

    @classmethod
    def of(cls, law: LawOfMotion, n: int) -> Encounters:
        """Return the encounters of a law for n agents."""
        surfaces = [np.broadcast_to(np.asarray(surface, dtype=np.float64), (n,)) for surface in law.surfaces]
        radii = np.sort(np.array(surfaces).reshape(len(surfaces), n).T, axis=1)
        length = min(np.inf if law.scales is None else law.scales.length, radii[:, -1].min() if surfaces else np.inf)
        bodies, radii, poles = law.obstacle_field, np.ascontiguousarray(radii), np.array(law.poles, dtype=np.float64)
        pole_pairs = None if law.pole_pairs is None else np.array(law.pole_pairs, dtype=np.int32).reshape(-1, 2)
        if bodies is None or not bodies.obstacles:
            return cls(radii, SHARE * length, poles=poles, among=pole_pairs)
        return cls(radii, SHARE * length, bodies, bodies.beta.r, SHARE * bodies.beta.d, poles, pole_pairs)

    @property
    def any(self) -> bool:
        """Whether the law has distances or obstacles that an integration step may not skip over."""
        return self.radii.size > 0 or self.bodies is not None or self.poles.size > 0

    def share(self, h: float, before: State, after: State) -> float:
        """Return the fraction of a step that may be accepted; negative if a pair crosses a singularity."""
        n, m = before.q.shape
        step_ends = Ends(float(h), *(thawed(np.ascontiguousarray(x, dtype=np.float64)) for x in (*before, *after)))
        around, view_pairs = self.around(np.arange(n), 1.0), ((0.0, np.zeros(m), np.zeros(m)), no_pairs(0, m))
        is_crowd, near = False, no_pairs(n, m)
        while (share := float(self.compiled(crowd=is_crowd)(0.0, step_ends, around, *view_pairs, near))) <= TOO_MANY:
            is_crowd, near = share == TOO_MANY, with_room(near) or near
        return share

    def compiled(self, *, crowd: bool, several: bool = False) -> Kernel:
        """Return the compiled function `share_of_step` with only the checks that the law needs."""
        bodies, poles, pairs = self.bodies is not None, self.poles.size > 0, self.radii.size > 0
        flags = {"BODIES": bodies, "PAIRS": pairs or poles, "POLES": poles, "CROWD": crowd}
        if len(self.radii) >= LARGE:
            flags |= {"LARGE": True, "SEVERAL": several}
        kernel: Kernel = bound("flockana.kernels.step_shares", **flags).share_of_step
        return kernel

    def around(self, order: npt.NDArray[Any], toward: float) -> Around:
        """Return the data of the encounter checks for compiled code, with agents in the given order."""
        few = self.among is not None
        first, second_agents = np.argsort(order).astype(np.uint32)[self.among].T if few else np.empty((2, 0), np.uint32)
        edges = np.concatenate([self.radii.ravel(), [] if few else self.poles])
        shortest, largest = (edges.min(), edges.max()) if edges.size else (0.0, 0.0)
        return Around(
            self.radii[order], float(self.far), (float(shortest), float(largest)), thawed(self.poles), toward,
            np.ascontiguousarray(first), np.ascontiguousarray(second_agents), few, *self._guard,
            (float(self.shell), float(self.skirt)), as_callback(lister(large=len(order) >= LARGE)), covering(),
        )  # fmt: skip

    @cached_property
    def _guard(self) -> tuple[Any, FloatArray, npt.NDArray[np.int64]]:
        """Compiled obstacle check, with its numbers and the start index of each obstacle kind."""
        kinds, unread_numbers = () if self.bodies is None else self.bodies.kinds, np.zeros(BETA_AREA + 1)
        body_parameters = [body_numbers(self.shell, 0.0, 0.0, unread_numbers, *kind.arrays) for kind in kinds]
        starts = np.cumsum([0, *(values.size for values in body_parameters)]).astype(np.int64)
        return guard_of(tuple(kind.kernels.guard for kind in kinds)), np.concatenate([[], *body_parameters]), starts


class StepChecks:
    """Checks that every step of a run must pass (`flockana.kernels.step_checks`)."""

    def __init__(self, law: LawOfMotion, frame: Frame, plan: Plan) -> None:
        self._encounters, self._view = Encounters.of(law, frame.shape[0]), frame.view
        fixed = plan.solver.dt is not None
        balance, poles = (0.0, np.inf), self._encounters.poles.size > 0
        if plan.solver.one_step and not fixed:
            balance = (BALANCED * plan.control.rtol, BALANCED * plan.control.floor.work)
        has_energy = frame.energetic and (poles or not fixed)  # of fixed steps: whether the energy stays finite
        self._rules = Rules(self._encounters.any, has_energy, balance, fixed)
        self._toward, self._shape = _TOWARD if fixed else 1.0, frame.shape
        self._ledger, self._order, self._crowd = empty_ledger(), np.empty(0), False

    @property
    def energetic(self) -> bool:
        """Whether the energy balance of the steps is still checked."""
        return bool(self._rules.energetic and self._ledger[IN_VAIN] < PATIENCE)

    def judged(self, order: npt.NDArray[Any], *, compiled: bool = True, several: bool = False) -> Judged:
        """Return the data by which compiled code accepts or rejects steps, agents in the given order."""
        if order is not self._order:
            self._order, self.near = order, no_pairs(*self._shape)
            self._judged: dict[bool, Judged] = {}
            self._around = self._encounters.around(order, self._toward)
        if several not in self._judged:
            encounter_data, share = self._around, self._encounters.compiled(crowd=self._crowd, several=several)
            if several:
                listed = as_callback(lister(large=True, several=True))
                encounter_data = encounter_data._replace(listed=listed, covers=covering(several=True))
            if compiled:
                step_ends = Ends(0.0, *6 * (np.empty((0, self._shape[1])),))
                share = callback_like(share, 0.0, 0.0, step_ends, encounter_data, self._view, self.near, self.near)
            self._judged[several] = Judged(encounter_data, self._rules, self._ledger, share)
        return self._judged[several]

    def examine(self, block: Block, order: npt.NDArray[Any], kept: Pairs) -> tuple[float, bool]:
        """Return the length at which to repeat a step, 0 if accepted, and whether the run ends at a pole."""
        judged = self.judged(order, compiled=False)
        shorter_step, is_singular = checked(block, 0, judged, self._view, kept, self.near)
        return self.examine(block, order, kept) if is_singular and self.make_room() else (shorter_step, is_singular)

    def make_room(self) -> bool:
        """Enlarge or abandon the list of near pairs if it has overflowed; return whether it had."""
        if (near_pairs := with_room(self.near)) is not None:
            self.near = near_pairs
            return True
        if self._crowd or self.near.counts[COUNT] >= 0:
            return False
        self._crowd, self._order = True, np.empty(0)
        return True


def at_a_pole(t: float) -> str:
    """Return the message of a run that ends where agents meet at a singularity of their force."""
    return f"agents met at t = {t:g} where their potential is infinite or their force has no limit: no motion goes on"
