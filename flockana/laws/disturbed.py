"""A law whose agents are pushed by a disturbance: a constant force, a sinusoid, white noise."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import KW_ONLY, dataclass
from math import pi
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from flockana.base.checks import FloatArray, ensure_finite_scalar, ensure_nonnegative
from flockana.base.errors import ArgumentError
from flockana.kernels import force as kernel
from flockana.laws.law import Law
from flockana.laws.terms.term import Compiled, TermKernel
from flockana.laws.wrapped import Step, View, Wrapper, ensure_seed, ensure_wrappable, input_of
from flockana.measures.frame import moving_frame

if TYPE_CHECKING:
    from scipy.sparse import sparray

_NOISE = 0  # channel of random numbers


@dataclass(frozen=True)
class Disturbed(Wrapper):
    """u + w: agents are pushed by w(t) = force + swing sin(2π frequency t + phase), and by white noise.

    White noise of intensity s gives a velocity of variance s² t in each coordinate after the time t. Without noise the
    law stays a continuous one, which every method integrates; with noise it is stepped (`simulate(..., dt=)`).

    Parameters
    ----------
    law : Law
        The law that is disturbed.
    force, swing : array_like, shape (m,) or (n, m)
        Acceleration that is constant, and amplitude of one that swings: the same for all agents, or one for each.
    frequency : float
        Cycles per time unit.
    phase : float
        In radians.
    intensity : float
        s >= 0, in length over time to the power 3/2.
    seed : int
        Of the noise.

    Raises
    ------
    ArgumentError
        On a negative intensity, or forces that are none.

    Examples
    --------
    >>> from flockana.laws.olfati_saber import Algorithm1
    >>> wind = Disturbed(Algorithm1(), force=(0.5, 0.0))
    >>> wind.acceleration(0.0, [[0.0, 0.0]], [[0.0, 0.0]]).tolist()
    [[0.5, 0.0]]
    """

    law: Law
    _: KW_ONLY
    force: Any = None
    swing: Any = None
    frequency: float = 0.0
    phase: float = 0.0
    intensity: float = 0.0
    seed: int = 0

    units: ClassVar[Mapping[str, tuple[float, float]]] = {
        "force": (1, -2),
        "swing": (1, -2),
        "frequency": (0, -1),
        "intensity": (1, -1.5),
    }

    def __post_init__(self) -> None:
        ensure_wrappable(self.law)
        for name in ("force", "swing"):
            object.__setattr__(self, name, _pushes(name, getattr(self, name)))
        object.__setattr__(self, "frequency", ensure_nonnegative("frequency", self.frequency))
        object.__setattr__(self, "phase", ensure_finite_scalar("phase", self.phase))
        object.__setattr__(self, "intensity", ensure_nonnegative("intensity", self.intensity))
        object.__setattr__(self, "seed", ensure_seed(self.seed))

    @property
    def stepped(self) -> bool:  # type: ignore[override]
        """Whether there is noise."""
        return self.intensity > 0.0

    def check_dimension(self, m: int) -> None:  # noqa: D102
        super().check_dimension(m)
        for name in ("force", "swing"):
            given = getattr(self, name)
            if given is not None and np.shape(given)[-1] != m:
                raise ArgumentError(f"{name} has {np.shape(given)[-1]} components, the agents {m}: expected as many")

    def check_agents(self, n: int) -> None:  # noqa: D102
        super().check_agents(n)
        for name in ("force", "swing"):
            given = getattr(self, name)
            if np.ndim(given) == 2 and len(given) != n:
                raise ArgumentError(f"{name} has {len(given)} rows and there are {n} agents: expected one for each")

    def push(self, t: float) -> FloatArray:
        """Return w(t) without its noise, shape (m,) or (n, m); 0 without a force.

        Parameters
        ----------
        t : float
            Time.
        """
        total: FloatArray = np.zeros(1)
        if self.force is not None:
            total = total + np.asarray(self.force)
        if self.swing is not None:
            total = total + np.asarray(self.swing) * np.sin(2.0 * pi * self.frequency * t + self.phase)
        return total

    def input(self, step: Step, view: View) -> FloatArray:  # noqa: D102
        u = input_of(self.law, step, view)
        return u if self.force is None and self.swing is None else u + self.push(view.t)

    def kick(self, step: Step, shape: tuple[int, ...]) -> FloatArray | None:  # noqa: D102
        if not self.intensity:
            return None
        kick: FloatArray = self.intensity * step.h**0.5 * step.normal(self.seed, _NOISE, shape)
        return kick

    def flow(self, t: float, q: FloatArray, p: FloatArray) -> tuple[FloatArray, float]:  # noqa: D102
        if self.stepped:
            return super().flow(t, q, p)
        u, rate = self.law.flow(t, q, p)
        push = np.broadcast_to(self.push(t), q.shape)
        velocity = moving_frame(p) if getattr(self.law, "moving", False) else p
        return u + push, rate + float(np.sum(push * velocity))

    @property
    def moving(self) -> bool:
        """Whether the law's energy is that in the frame of the centre of mass."""
        return bool(getattr(self.law, "moving", False))

    def compiled(self, m: int) -> Compiled | None:  # noqa: D102
        form = None if self.stepped else self.law.compiled(m)
        if form is None:
            return None
        numbers = kernel.numbers(form.moving, *self._rows(m), 2.0 * pi * self.frequency)
        term = TermKernel(*kernel.compiled(), numbers, np.empty((0, 0)), 0.0)
        return form._replace(terms=(*form.terms, term))

    def _rows(self, m: int) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return the constant push and the amplitudes of cos ωt and sin ωt, each (1, m) or (n, m)."""
        force, swing = (np.zeros((1, m)) if x is None else np.atleast_2d(x) for x in (self.force, self.swing))
        force, swing = np.broadcast_arrays(force, swing)
        return force, np.sin(self.phase) * swing, np.cos(self.phase) * swing

    def derivatives(self, t: float, q: FloatArray, p: FloatArray) -> tuple[sparray, sparray]:  # noqa: D102
        return self.law.derivatives(t, q, p)


def _pushes(name: str, value: Any) -> Any:
    """Return a force as nested tuples, for comparison and files; None stays None."""
    if value is None:
        return None
    try:
        array = np.asarray(value, dtype=np.float64)
    except (TypeError, ValueError):
        array = np.array(np.nan)
    if array.ndim not in (1, 2) or not array.size or not np.isfinite(array).all():
        raise ArgumentError(f"{name} = {value!r}: expected finite components, (m,) for all agents or (n, m)")
    return tuple(array.tolist()) if array.ndim == 1 else tuple(map(tuple, array.tolist()))
