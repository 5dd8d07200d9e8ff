"""Semi-implicit Euler steps of any continuous law: velocities first, then positions."""

from dataclasses import dataclass

from flockana.base.checks import FloatArray
from flockana.base.overrides import overrides_consistently
from flockana.laws.discrete import IndexArray, States
from flockana.laws.law import Arrays
from flockana.laws.scheme import Scheme


@dataclass(frozen=True)
class SemiImplicitEuler(Scheme):
    """Map p' = p + dt u(t, q, p), q' = q + dt p', for sources that give a step and no integrator.

    A scheme of first order with a fixed step: where the law jumps it neither sees the jump nor resolves it, and where
    the law holds a pair at a jump it chatters about it (erratum L7).

    Parameters
    ----------
    law, dt : Law, float
        As of every `Scheme`: the continuous law, and the step.

    Examples
    --------
    >>> from flockana.laws.olfati_saber import Algorithm1
    >>> import numpy as np
    >>> euler = SemiImplicitEuler(Algorithm1(), dt=0.01)
    >>> q, p, _, _ = euler.step(0.0, np.array([[0.0], [8.0]]), np.zeros((2, 1)), {})
    >>> bool(q[0, 0] == 0.01 * p[0, 0] > 0.0)
    True
    """

    position_factor = 1.0
    steps_at_once = 2000  # of a law with a compiled block, 2 µs a step of 50 agents

    def step(self, t: float, q: FloatArray, p: FloatArray, memory: Arrays) -> States:  # noqa: D102
        if (block := self.law.block(self)) is not None:  # the same sums in the same order as `iterate`
            next_q, next_p, applied = block(q, p, 1)
            return next_q[0], next_p[0], applied[0], memory
        u = self.law.flow(t, q, p)[0]
        p = p + self.dt * u
        return q + self.dt * p, p, u, memory

    def iterate(self, t: float, q: FloatArray, p: FloatArray, memory: Arrays, steps: int) -> States:  # noqa: D102
        block = self.law.block(self)
        if block is not None and overrides_consistently(type(self), "iterate", ("step", "start")):
            return (*block(q, p, steps), {})
        return super().iterate(t, q, p, memory, steps)

    def visit(self, t: float, q: FloatArray, p: FloatArray, memory: Arrays, wanted: IndexArray) -> States | None:  # noqa: D102
        block = self.law.block(self)
        if block is not None and overrides_consistently(type(self), "visit", ("iterate", "step", "start")):
            return (*block(q, p, int(wanted[-1]), wanted), {})
        return super().visit(t, q, p, memory, wanted)
