"""A law whose messages between agents are lost at random."""

from dataclasses import dataclass

import numpy as np

from flockana.base.errors import ArgumentError
from flockana.base.value_checks import FloatArray, ensure_nonnegative, normalise
from flockana.laws.law import Law
from flockana.laws.wrapper_base import Step, View, Wrapper, ensure_hears, input_of

_LOST = 3  # channel of random numbers


@dataclass(frozen=True)
class Lossy(Wrapper):
    """Law with random loss of messages: agent i then acts as if agent j were out of range.

    Messages are sent at each step, or at each sample within `Sampled`; losses are independent.

    Parameters
    ----------
    law : Law
        A law with a pair term.
    loss : float
        Probability, 0 <= loss <= 1.

    Raises
    ------
    ArgumentError
        If the loss is no probability, or the law has no pair term.

    Examples
    --------
    >>> from flockana.laws.olfati_saber import Algorithm1
    >>> Lossy(Algorithm1(), 0.2).loss
    0.2
    """

    law: Law
    loss: float
    seed: int = 0

    def __post_init__(self) -> None:
        super().__post_init__()
        ensure_hears(self.law)
        normalise(self, ensure_nonnegative, "loss")
        if self.loss > 1.0:
            raise ArgumentError(f"loss = {self.loss:g}: expected a probability, at most 1")

    def input(self, step: Step, view: View) -> FloatArray:  # noqa: D102
        from scipy.special import ndtri

        n = len(view.q)
        is_received = step.normal(self.seed, _LOST, (n, n)) >= ndtri(self.loss)
        is_linked = is_received if view.linked is None else is_received & view.linked
        return input_of(self.law, step, view._replace(linked=np.asarray(is_linked)))
