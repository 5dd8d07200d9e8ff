"""Robustness in the engineer's terms: margins of the loop broken at each agent's input.

The loop is broken at one component of one agent's input, all others closed: with A of the closed flock and f its row
of that input, the open loop is L(s) = −f (s − A₀)⁻¹ b, where A₀ is A without that row and b the unit vector of the
input. Gain, phase and disk margins are python-control's; the sensitivity peak is the largest 1/|1 + L(jω)|.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import inf
from typing import TYPE_CHECKING, Any

import numpy as np

from flockana.base.checks import FloatArray
from flockana.base.errors import ArgumentError
from flockana.base.kinds import check_kinds
from flockana.laws import Law
from flockana.stability.linearisation import Linearisation
from flockana.stability.linearise import linearise

if TYPE_CHECKING:
    from control import StateSpace

_GRID = 400  # frequencies, of disk margins and sensitivity peaks
_NOTHING = 1e-9  # of the input
_BEYOND = 100.0  # times the fastest pole, and a hundredth of the slowest: the range of frequencies


@dataclass(frozen=True)
class LoopMargins:
    """Margins of the loop broken at one component of one agent's input."""

    agent: int  # agent, axis: Where it is broken
    axis: int
    # Factors of the input between which the flock stays stable; 0 and infinity where there is no limit
    gain: tuple[float, float]
    phase: float  # Phase margin in degrees; infinite without a crossover
    disk: float  # Disk margin (balanced): gain and phase may vary together within it
    sensitivity: float  # Peak of the sensitivity 1/|1 + L(jω)|


@dataclass(frozen=True)
class RobustnessMargins:
    """Margins of all loops of a flock, and the worst of each kind.

    Parameters
    ----------
    loops : tuple of LoopMargins
        By agent and axis.
    """

    loops: tuple[LoopMargins, ...]

    @property
    def gain(self) -> tuple[float, float]:
        """Narrowest gain margin of any one input: (least, greatest) factor."""
        return max(one.gain[0] for one in self.loops), min(one.gain[1] for one in self.loops)

    @property
    def phase(self) -> float:
        """Least phase margin, in degrees."""
        return min(one.phase for one in self.loops)

    @property
    def disk(self) -> float:
        """Least disk margin."""
        return min(one.disk for one in self.loops)

    @property
    def sensitivity(self) -> float:
        """Largest sensitivity peak."""
        return max(one.sensitivity for one in self.loops)

    @property
    def table(self) -> dict[str, dict[str, float]]:
        """All margins by loop and kind, as `flockana.plots.bars` takes them."""
        return {
            f"agent {one.agent}, {'xyz'[one.axis]}": {
                "least gain": one.gain[0],
                "greatest gain": one.gain[1],
                "phase (degrees)": one.phase,
                "disk margin": one.disk,
                "sensitivity peak": one.sensitivity,
            }
            for one in self.loops
        }

    @property
    def weakest(self) -> LoopMargins:
        """Loop with the least disk margin."""
        return min(self.loops, key=lambda one: one.disk)


@check_kinds
def open_loop(flock: Linearisation, agent: int, axis: int = 0) -> StateSpace:
    """Return the loop broken at one component of an agent's input, as a `control.StateSpace`.

    Parameters
    ----------
    flock : Linearisation
        From `linearise`.
    agent, axis : int
        Where it is broken.

    Examples
    --------
    One agent at its γ-agent: L(s) = (c2γ s + c1γ)/s².

    >>> from flockana.environment.targets import StaticTarget
    >>> from flockana.interactions import Gains
    >>> from flockana.laws.olfati_saber import Algorithm2
    >>> law = Algorithm2(gains=Gains(c1_gamma=4.0, c2_gamma=3.0), target=StaticTarget((0.0,)))
    >>> loop = open_loop(linearise(law, [[0.0]]), 0)
    >>> complex(loop(2.0))
    (2.5+0j)
    """
    import control

    n, m = flock.q.shape
    if not 0 <= agent < n or not 0 <= axis < m:
        raise ArgumentError(f"agent = {agent}, axis = {axis}: expected one of {n} agents and {m} axes")
    row = n * m + agent * m + axis
    opened, unit = flock.A.copy(), np.zeros((2 * n * m, 1))
    feedback = opened[row : row + 1].copy()
    opened[row], unit[row] = 0.0, 1.0
    return control.ss(opened, unit, -feedback, 0.0)


def robustness_margins(law: Law, equilibrium: Any) -> RobustnessMargins:
    """Return gain, phase and disk margins and sensitivity peaks of the loops broken at each agent's input.

    Parameters
    ----------
    law : Law
        A law that `linearise` takes.
    equilibrium : Equilibrium or array_like, shape (n, m)
        As for `linearise`.

    Raises
    ------
    ArgumentError
        If the flock is not stable, or on what `linearise` refuses.

    Examples
    --------
    >>> from flockana.environment.targets import StaticTarget
    >>> from flockana.interactions import Gains
    >>> from flockana.laws.olfati_saber import Algorithm2
    >>> law = Algorithm2(gains=Gains(c1_gamma=4.0, c2_gamma=4.0), target=StaticTarget((0.0,)))
    >>> found = robustness_margins(law, [[0.0]])
    >>> found.gain, round(found.phase, 2)
    ((0.0, inf), 76.35)
    """
    flock = linearise(law, equilibrium)
    if not flock.stable:
        raise ArgumentError(f"the flock is not stable: decay rate {flock.decay_rate:.3g}, expected one above 0")
    n, m = flock.q.shape
    rates = np.abs(flock.eigenvalues)
    rates = rates[rates > 0.0]
    omega = np.geomspace(rates.min() / _BEYOND, rates.max() * _BEYOND, _GRID)
    return RobustnessMargins(tuple(_margins(flock, i, c, omega) for i in range(n) for c in range(m)))


def _margins(flock: Linearisation, agent: int, axis: int, omega: FloatArray) -> LoopMargins:
    import control

    loop = open_loop(flock, agent, axis)
    gains, phases, _, *crossings, _ = map(np.ravel, control.stability_margins(loop, returnall=True))
    there = np.concatenate(crossings)
    grid = np.sort(np.concatenate([omega, there[np.isfinite(there) & (there > 0.0)]]))
    disk = float(np.asarray(control.disk_margins(loop, grid)[0]))
    low = max([0.0, *gains[(gains < 1.0) & (gains > _NOTHING)]])  # at 0 what is neutral touches the axis
    high, phase = min([inf, *gains[gains > 1.0]]), min([inf, *np.abs(phases)])
    return LoopMargins(agent, axis, (float(low), float(high)), float(phase), disk, _peak(loop, omega))


def _peak(loop: Any, omega: FloatArray) -> float:
    """Largest sensitivity, refined about the best of a grid."""
    from scipy.optimize import minimize_scalar

    sizes = 1.0 / np.abs(1.0 + np.ravel(loop(1j * omega)))
    k = int(np.argmax(sizes))
    low, high = omega[max(0, k - 1)], omega[min(len(omega) - 1, k + 1)]
    found = minimize_scalar(lambda w: abs(1.0 + complex(loop(1j * w))), bounds=(low, high), method="bounded")
    return max(1.0, float(sizes[k]), 1.0 / float(found.fun))  # 1 at the highest frequencies
