"""Averaging over a scheduled net: each agent moves to a mean of heard positions."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from flockana.base.errors import ArgumentError, format_value
from flockana.base.units import Powers
from flockana.base.value_checks import FloatArray, ensure_numbers, ensure_positive, normalise
from flockana.laws.discrete import DiscreteLaw, States
from flockana.laws.law import Arrays

_WANTED = "square arrays of weights w_ij >= 0 of one size, with which agent i hears agent j and itself"
_ROUNDING = 1e-12  # of a sum of weights


def ensure_averages(name: str, value: Any) -> tuple[tuple[tuple[float, ...], ...], ...]:
    """Return row-stochastic matrices as rows of numbers; one matrix is a net by itself."""
    nets = ensure_numbers(name, value, _WANTED)
    nets = nets[None] if nets.ndim == 2 else nets
    if nets.ndim != 3 or nets.shape[1] != nets.shape[2] or not nets.size:
        raise ArgumentError(f"{name} has shape {nets.shape}: expected {_WANTED}")
    is_invalid = ~np.isfinite(nets) | (nets < 0.0)
    if is_invalid.any():
        k, i, j = np.argwhere(is_invalid)[0].tolist()
        raise ArgumentError(f"{name}[{k}][{i}, {j}] = {nets[k, i, j]:g}: expected {_WANTED}")
    deviation = np.abs(nets.sum(axis=2) - 1.0)
    if deviation.max() > _ROUNDING:
        k, i = np.argwhere(deviation > _ROUNDING)[0].tolist()
        total = nets[k, i].sum()
        raise ArgumentError(f"row {i} of {name}[{k}] sums to {total:.6g}: expected 1; divide it by its sum")
    return tuple(tuple(map(tuple, net)) for net in nets.tolist())


def ensure_steps(name: str, value: Any, least: int, count: int) -> tuple[int, ...]:
    """Return one whole number of steps for each net, each at least `least`; raise on other values."""
    steps = np.asarray(value)
    if steps.shape != (count,) or steps.dtype.kind not in "iu" or (steps < least).any():
        expectation = f"{count} whole numbers >= {least}, one for each net"
        raise ArgumentError(f"{name} = {format_value(value)}: expected {expectation}")
    return tuple(steps.tolist())


@dataclass(frozen=True)
class NetAveraging(DiscreteLaw):
    """q_i becomes Σ_j w_ij q_j: each agent moves to a mean of its own and heard positions, simultaneously.

    Nets act in turn, each for its number of steps, round after round; with `growth` each round is longer than the one
    before. Agents have no velocities of their own: p is that of the last step, and 0 at the start.

    Parameters
    ----------
    nets : array_like, shape (K, n, n) or (n, n)
        Weights w_ij >= 0 of each net, with which agent i hears agent j; rows sum to 1, to the rounding of their
        numbers, and stand for the means w_ij/Σ_k w_ik.
    lengths : sequence of int
        Steps for which each net acts in the first round; by default 1 each.
    growth : sequence of int
        Steps by which this grows from round to round; by default 0 each.
    dt : float
        Step, in time units.

    Raises
    ------
    ArgumentError
        On weights that are no averages, or numbers of steps that do not fit the nets.

    Examples
    --------
    Agent 1 hears agent 0 for two steps, then agent 0 hears agent 1 for one:

    >>> law = NetAveraging([[[1.0, 0.0], [0.5, 0.5]], [[0.5, 0.5], [0.0, 1.0]]], lengths=(2, 1))
    >>> [law.net_at(step) for step in range(4)]
    [0, 0, 1, 0]
    >>> law.step(0.0, np.array([[0.0], [1.0]]), np.zeros((2, 1)), {"step": np.array(0.0)})[0].tolist()
    [[0.0], [0.5]]
    """

    nets: Any
    lengths: Any = None
    growth: Any = None
    dt: float = 1.0

    references: ClassVar[tuple[str, ...]] = ("moreau-2005", "ren-beard-2005")
    units: ClassVar[Mapping[str, Powers]] = {"dt": (0, 1)}

    def __post_init__(self) -> None:
        normalise(self, ensure_averages, "nets")
        normalise(self, ensure_positive, "dt")
        for name, minimum in (("lengths", 1), ("growth", 0)):
            value = getattr(self, name)
            steps = [minimum] * len(self.nets) if value is None else value
            object.__setattr__(self, name, ensure_steps(name, steps, minimum, len(self.nets)))

    def net_at(self, step: int) -> int:
        """Return the index of the net in a step, counted from 0.

        Parameters
        ----------
        step : int
            At least 0.
        """
        first_duration, total_growth, rounds = sum(self.lengths), sum(self.growth), 0
        if not total_growth:
            step %= first_duration
        while step >= first_duration + total_growth * rounds:
            step -= first_duration + total_growth * rounds
            rounds += 1
        window_ends = np.cumsum(np.array(self.lengths) + rounds * np.array(self.growth))
        return int(np.searchsorted(window_ends, step, side="right"))

    def check_start(self, q: FloatArray, p: FloatArray) -> None:  # noqa: D102
        if len(q) != len(self.nets[0]):
            raise ArgumentError(f"nets are of {len(self.nets[0])} agents and the state is of {len(q)}: expected all")
        if p.any():
            i = int(np.abs(p).max(axis=1).argmax())
            raise ArgumentError(f"agent {i} starts at {p[i].tolist()}: expected p0 = 0, as places alone have a law")

    def start(self, q: FloatArray, p: FloatArray) -> Arrays:
        """Return the step count 0 as memory; empty for a constant net."""
        return {"step": np.array(0.0)} if len(self.nets) > 1 else {}

    def step(self, t: float, q: FloatArray, p: FloatArray, memory: Arrays) -> States:  # noqa: D102
        net = np.array(self.nets[self.net_at(int(memory["step"])) if memory else 0])
        heard = np.where(net[:, :, None] > 0.0, q, np.nan)
        after = np.clip(net @ q, np.nanmin(heard, axis=1), np.nanmax(heard, axis=1))  # a mean, to the last bit
        velocities = (after - q) / self.dt
        return after, velocities, (velocities - p) / self.dt, {name: value + 1.0 for name, value in memory.items()}

    def measures(self, t: FloatArray, q: FloatArray, p: FloatArray, extra: Arrays) -> Mapping[str, Any]:  # noqa: D102
        return {"spread": ("largest extent of the places along an axis", np.ptp(q, axis=1).max(axis=1))}
