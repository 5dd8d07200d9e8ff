"""Radii of the zones of repulsion, conflict, attraction and surveillance, and weights of the behaviours."""

from collections.abc import Mapping
from dataclasses import KW_ONLY, dataclass
from functools import partial
from typing import Any, ClassVar

import numpy as np

from flockana.base.errors import ArgumentError
from flockana.base.short_repr import ShortRepr
from flockana.base.units import Powers
from flockana.base.value_checks import FloatArray, PerAgent, ensure_nonnegative, normalise, per_agent

Table = float | tuple[tuple[float, ...], ...]
_PAIRS = ("separation", "cohesion", "alignment")


def _spread(name: str, value: PerAgent, n: int) -> FloatArray:
    if isinstance(value, tuple) and len(value) != n:
        raise ArgumentError(f"{name} has {len(value)} entries: expected one number, or one for each of the {n} agents")
    return np.array(np.broadcast_to(np.asarray(value, dtype=np.float64), (n,)))


@dataclass(frozen=True)
class ZoneRadii(ShortRepr):
    """Radii of an agent's zones: 0 < r <= c < a < s.

    Agents at most r away repel; those up to c repel and attract (conflict); those up to a attract. Aliens are watched
    up to s. Each radius is one number, or one for each agent.

    Parameters
    ----------
    a : float or sequence of n floats
        Of attraction.
    c : float or sequence of n floats, optional
        Of conflict; by default r, that is, no conflict zone (Remark 1).
    s : float or sequence of n floats, optional
        Of surveillance; by default as r (Remark 1), which leaves the printed annulus a < d <= s empty.

    Raises
    ------
    ArgumentError
        If the radii do not increase, or there are different numbers of them.

    Examples
    --------
    >>> ZoneRadii(1.5, a=5.0).c
    1.5
    """

    r: PerAgent
    _: KW_ONLY
    a: PerAgent
    c: PerAgent | None = None
    s: PerAgent | None = None

    units: ClassVar[Mapping[str, Powers]] = dict.fromkeys("rcas", (1, 0))

    @property
    def reach(self) -> tuple[float, float, float]:
        """Largest r, c and a over the agents."""
        r, c, a = (float(np.max(np.asarray(x, dtype=np.float64))) for x in (self.r, self.c, self.a))
        return r, c, a

    def __post_init__(self) -> None:
        watched = self.s is not None
        object.__setattr__(self, "c", self.r if self.c is None else self.c)
        normalise(self, per_agent, "r", "a", "c", *("s" if watched else ""))
        counts = {name: len(v) for name in "rcas" if isinstance(v := getattr(self, name), tuple)}
        if len(set(counts.values())) > 1:
            raise ArgumentError(f"numbers of radii {counts}: expected one number each, or one for each agent")
        r, c, a, s = self.arrays(max(counts.values(), default=1))
        is_disordered = ~((r <= c) & (c < a) & ((a < s) | (not watched)))
        if is_disordered.any():
            i = int(np.argmax(is_disordered))
            text = f"r = {r[i]:g}, c = {c[i]:g}, a = {a[i]:g}" + (f", s = {s[i]:g}" if watched else "")
            raise ArgumentError(f"{text}: expected radii that increase, 0 < r <= c < a{' < s' if watched else ''}")

    def arrays(self, n: int) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
        """Return the zone radii (r, c, a, s) of n agents, each of shape (n,)."""
        r, c, a = (_spread(name, getattr(self, name), n) for name in ("r", "c", "a"))
        return r, c, a, r if self.s is None else _spread("s", self.s, n)


@dataclass(frozen=True)
class ZoneWeights(ShortRepr):
    """Weights of the six behaviours, and gains of cohesion and alignment.

    The weights of cohesion and of alignment are divided by their sum, so equal ones cancel: 0.75 and 0.25 in the
    paper do nothing (A9). What sets the strength is `cohesion_gain` and `alignment_gain`, 1 as printed; the defaults
    are those with which section 5.1 does what is said of it.

    Parameters
    ----------
    separation, cohesion, alignment : float or array of shape (n, n)
        w^ls, w^lc, w^la >= 0: how much agent i heeds agent j.
    speed, obstacle : float or sequence of n floats
        w^ga and w^oa >= 0 of each agent; w^ga = 0 for one that is not informed of the desired speed.
    alien : float or array of shape (n, K)
        w^ss >= 0: how much agent i heeds alien k.
    cohesion_gain, alignment_gain : float
        g_c and g_a >= 0.

    Raises
    ------
    ArgumentError
        On a negative weight, a wrong shape, or weights of a mean that sum to zero.

    Examples
    --------
    >>> ZoneWeights(cohesion=[[0.0, 0.0], [1.0, 0.0]])
    Traceback (most recent call last):
    flockana.base.errors.ArgumentError: cohesion[0] sums to zero: its mean is not defined; switch cohesion off ...
    """

    separation: Table = 5.0
    cohesion: Table = 0.75
    alignment: Table = 0.25
    speed: PerAgent = 5.0
    alien: Table = 5.0
    obstacle: PerAgent = 5.0
    cohesion_gain: float = 0.25
    alignment_gain: float = 8.0

    units: ClassVar[Mapping[str, Powers]] = {
        "separation": (0, -2),
        "speed": (0, -1),
        "alien": (0, -2),
        "obstacle": (0, -2),
        "cohesion_gain": (0, -2),
        "alignment_gain": (0, -1),
    }

    def __post_init__(self) -> None:
        normalise(self, per_pair, *_PAIRS)
        normalise(self, partial(per_pair, square=False), "alien")
        for name in ("cohesion", "alignment"):
            _check_sums(name, getattr(self, name))
        normalise(self, partial(per_agent, ensure=ensure_nonnegative), "speed", "obstacle")
        normalise(self, ensure_nonnegative, "cohesion_gain", "alignment_gain")

    def arrays(self, n: int, aliens: int = 0) -> dict[str, FloatArray]:
        """Return the weights by name as arrays: (n, n) of pairs or (1, 1), (n, K) of aliens, (n,) of agents.

        Parameters
        ----------
        aliens : int
            Number of aliens, K.
        """
        values = {name: _spread(name, getattr(self, name), n) for name in ("speed", "obstacle")}
        for name in (*_PAIRS, "alien"):
            value: Any = getattr(self, name)
            shape: tuple[int, ...] = (n, aliens if name == "alien" else n)
            if isinstance(value, tuple) and np.shape(value) != shape:
                raise ArgumentError(f"{name} has shape {np.shape(value)}: expected one number, or {shape}")
            if name in _PAIRS and not isinstance(value, tuple):
                shape = (1, 1)  # a table for each of 10⁴ agents would be a gigabyte
            values[name] = np.array(np.broadcast_to(np.asarray(value, dtype=np.float64), shape))
        return values


def per_pair(name: str, value: Any, *, square: bool = True) -> Table:
    """Return pair weights, checked, as one number >= 0 or a table whose entry (i, j) is j's weight for i."""
    if np.ndim(value) == 0:
        return ensure_nonnegative(name, value)
    table = np.asarray(value, dtype=object)
    if table.ndim != 2 or (square and len(set(table.shape)) > 1):
        raise ArgumentError(
            f"{name} has shape {table.shape}: expected one number, or {'(n, n)' if square else '(n, K)'}"
        )
    return tuple(
        tuple(ensure_nonnegative(f"{name}[{i}][{j}]", one) for j, one in enumerate(row)) for i, row in enumerate(table)
    )


def _check_sums(name: str, value: Table) -> None:
    """Raise if the weights of all other agents in an agent's weighted mean sum to zero."""
    remedy = f"sums to zero: its mean is not defined; switch {name} off by {name}_gain=0"
    if value == 0.0:
        raise ArgumentError(f"{name} {remedy}")
    if isinstance(value, tuple):
        other_weights = np.array(value) * (1.0 - np.eye(len(value)))
        is_empty = other_weights.sum(axis=1) == 0.0
        if is_empty.any() and len(value) > 1:
            raise ArgumentError(f"{name}[{int(np.argmax(is_empty))}] {remedy}")
