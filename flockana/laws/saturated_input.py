"""A law whose actuators have a limit."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from flockana.base.errors import ArgumentError
from flockana.base.units import Powers
from flockana.base.value_checks import FloatArray, ensure_choice, ensure_positive, normalise
from flockana.laws.law import Law
from flockana.laws.law_matrices import block_diagonal
from flockana.laws.terms.term import Derivatives
from flockana.laws.wrapper_base import Step, View, Wrapper, input_of
from flockana.measures.centre_frame import moving_frame

BY = ("length", "component")
_AT = 1e-9  # relative: an input as near as that to the limit is at it


@dataclass(frozen=True)
class Saturated(Wrapper):
    """Law with bounded input: u shortened to `limit`, or each component clipped.

    The law stays a continuous one. Forces between agents no longer cancel where a limit acts: the centre of mass is
    pushed, and energy may rise.

    Parameters
    ----------
    limit : float
        Largest acceleration, in length over time².
    by : {"length", "component"}
        Whether the length of u_i is bounded, or each component.

    Raises
    ------
    ArgumentError
        If the limit is not positive, or `by` is unknown.

    Examples
    --------
    >>> from flockana.environment.targets import StaticTarget
    >>> from flockana.laws.olfati_saber import Algorithm2
    >>> law = Saturated(Algorithm2(target=StaticTarget((30.0, 40.0))), limit=5.0)
    >>> law.acceleration(0.0, [[0.0, 0.0]], [[0.0, 0.0]]).round(12).tolist()
    [[3.0, 4.0]]
    """

    law: Law
    limit: float
    by: str = "length"

    units: ClassVar[Mapping[str, Powers]] = {"limit": (1, -2)}

    def __post_init__(self) -> None:
        super().__post_init__()
        normalise(self, ensure_positive, "limit")
        ensure_choice("by", self.by, BY)

    stepped = False

    def bounded(self, u: FloatArray) -> FloatArray:
        """Return inputs whose length, or whose components, are cut to the limit.

        Parameters
        ----------
        u : ndarray, shape (n, m)
            Input that is asked for.
        """
        if self.by == "component":
            return np.clip(u, -self.limit, self.limit)
        magnitude = np.linalg.norm(u, axis=1, keepdims=True)
        return u * np.minimum(1.0, self.limit / np.maximum(magnitude, 1e-300))

    def input(self, step: Step, view: View) -> FloatArray:  # noqa: D102
        return self.bounded(input_of(self.law, step, view))

    def flow(self, t: float, q: FloatArray, p: FloatArray) -> tuple[FloatArray, float]:  # noqa: D102
        u, rate = self.law.flow(t, q, p)
        bounded_input = self.bounded(u)
        velocity = moving_frame(p) if self.moving else p
        return bounded_input, rate + float(np.sum((bounded_input - u) * velocity))

    def slopes(self, u: FloatArray) -> FloatArray:
        """Return the derivatives of bounded inputs by unbounded ones, (n, m, m); raise exactly at the limit.

        Parameters
        ----------
        u : ndarray, shape (n, m)
            Input that is asked for.
        """
        size = np.abs(u) if self.by == "component" else np.linalg.norm(u, axis=1, keepdims=True)
        worst = int(np.argmin(np.abs(size - self.limit).min(axis=1)))
        if np.abs(size[worst] - self.limit).min() <= _AT * self.limit:
            raise ArgumentError(
                f"the input of agent {worst} is at its limit {self.limit:g}, where it has a kink: expected a state in "
                "which every input is within its limit, or beyond it"
            )
        one = np.broadcast_to(np.eye(u.shape[1]), (*u.shape, u.shape[1]))
        if self.by == "component":
            return one * (size < self.limit)[:, :, None]
        ahead = u / np.maximum(size, 1e-300)
        turned = self.limit / np.maximum(size, 1e-300)[:, :, None] * (one - ahead[:, :, None] * ahead[:, None, :])
        return np.where((size < self.limit)[:, :, None], one, turned)

    def derivatives(self, t: float, q: FloatArray, p: FloatArray) -> Derivatives:  # noqa: D102
        from scipy.sparse import csr_array

        slopes: Any = self.law.derivatives(t, q, p)
        slope_matrix = block_diagonal(self.slopes(self.law.flow(t, q, p)[0]))
        return slope_matrix @ csr_array(slopes[0]), slope_matrix @ csr_array(slopes[1])
