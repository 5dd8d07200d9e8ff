"""Methods of fixed steps, stepped towards a time in Python."""

from __future__ import annotations

import numpy as np

from flockana.kernels.adaptive_steps import GROWTH
from flockana.solvers.solver import FloatArray, Limits, Rate
from flockana.solvers.tableau import Tableau


class FixedStepper:
    """Fixed-step method, stepped towards a time in Python like scipy's solvers."""

    def __init__(self, tableau: Tableau, rate: Rate, t: float, y: FloatArray, f: FloatArray, limits: Limits) -> None:
        self.tableau, self.rate, self.t, self.y, self.f, self.t_bound = tableau, rate, t, y, f, limits.until
        self.h_abs = np.inf if limits.first is None else limits.first
        self.status = "running"

    def step(self) -> None:
        """Make one step of the method towards the end time."""
        t, y, left, stages, tableau = self.t, self.y, self.t_bound - self.t, self.tableau.stages, self.tableau
        h = left if left <= self.h_abs else self.h_abs
        rates = [self.f]
        for s in range(1, stages + 1):
            end = y + h * sum(weight * rate for weight, rate in zip(tableau.a[s], rates, strict=False) if weight)
            if s < stages:
                rates.append(self.rate(t + tableau.c[s] * h, end))
        if tableau.lead:
            dimension = y.size // 2
            end[:dimension] += tableau.lead * h * h * self.f[dimension : 2 * dimension]
        self.t, self.h_abs = (self.t_bound, np.inf) if h == left else (t + h, GROWTH * h)
        self.status, self.y, self.f = "finished" if h == left else "running", end, self.rate(self.t, end)
