"""Interface between the driver of runs and integrators, compiled or not."""

from abc import ABC, abstractmethod

import numpy as np
import numpy.typing as npt

from flockana.base.checks import FloatArray
from flockana.dynamics.encounters import StepChecks
from flockana.dynamics.frame import Frame, Plan
from flockana.kernels.advance import record
from flockana.kernels.march import Block


class Stepper(ABC):
    """Integrator at the current time of a run; it writes steps into a block, after the block's first row."""

    frame: Frame
    plan: Plan
    block: Block
    order: npt.NDArray[np.uint64]  # every agent's own number, in the order of the vectors
    stops: FloatArray  # times to come at which a step must end
    due: FloatArray  # times to come of samples
    evaluations: int
    redone: int  # steps made again
    failure: str  # why it gave up, if it did

    @abstractmethod
    def advance(self, checks: StepChecks) -> int:
        """Make accepted steps; `failure` says why the run ends, if it does."""

    @abstractmethod
    def between(self) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return (times, states, work) of the samples due within the steps; work is NaN where a step ended."""

    def states(self, good: int) -> tuple[FloatArray, FloatArray]:
        """(states of shape (good, 3, n, m), work) at the ends of the steps."""
        states, work = np.empty((good, 3, *self.frame.shape)), np.empty(good)
        record(self.block, self.order, self.frame.view, states, work)
        return states, work

    def continue_from(self, good: int) -> None:
        """Go on from the end of the last step."""
        for rows in self.block:
            rows[0] = rows[good]
        t = float(self.block.t[0])
        self.stops, self.due = self.stops[self.stops > t], self.due[self.due > t]
