"""A law whose agents measure with noise."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

from flockana.base.value_checks import FloatArray, ensure_choice, ensure_nonnegative, normalise
from flockana.laws.law import Law
from flockana.laws.wrapper_base import Step, View, Wrapper, ensure_hears, input_of

NOISY = ("all", "neighbours")
_POSITION, _VELOCITY = 1, 2  # channels of random numbers


@dataclass(frozen=True)
class Measured(Wrapper):
    """Law with measured states: white noise on positions and velocities, redrawn at each step.

    A reading lasts until the next, so that its standard deviation is the intensity over the square root of the time
    between them: of a step, or of the period within `Sampled`. Shorter steps then come to the same run in the mean.

    Parameters
    ----------
    position, velocity : float
        Intensities >= 0: length times √time, and length over √time.
    of : {"all", "neighbours"}
        Noise on everything, the same for whoever looks; or on what each listener hears of each other agent.

    Raises
    ------
    ArgumentError
        On a negative intensity, or ``"neighbours"`` of a law without a pair term.

    Examples
    --------
    >>> from flockana.laws.olfati_saber import Algorithm1
    >>> Measured(Algorithm1(), position=0.01).stepped
    True
    """

    law: Law
    position: float = 0.0
    velocity: float = 0.0
    of: str = "all"
    seed: int = 0

    units: ClassVar[Mapping[str, tuple[float, float]]] = {"position": (1, 0.5), "velocity": (1, -0.5)}

    def __post_init__(self) -> None:
        super().__post_init__()
        normalise(self, ensure_nonnegative, "position", "velocity")
        ensure_choice("of", self.of, NOISY)
        if self.of == "neighbours":
            ensure_hears(self.law)

    def input(self, step: Step, view: View) -> FloatArray:  # noqa: D102
        share = step.interval**-0.5
        state = (view.q, view.p) if self.of == "all" else (view.heard or (view.q[None], view.p[None]))
        noise_shape = view.q.shape if self.of == "all" else (len(view.q), *view.q.shape)
        noisy_states = []
        for value, intensity, noise_channel in zip(
            state, (self.position, self.velocity), (_POSITION, _VELOCITY), strict=True
        ):
            noise = share * intensity * step.normal(self.seed, noise_channel, noise_shape) if intensity else 0.0
            noisy_states.append(value + noise)
        if self.of == "all":
            return input_of(self.law, step, view._replace(q=noisy_states[0], p=noisy_states[1]))
        return input_of(self.law, step, view._replace(heard=(noisy_states[0], noisy_states[1])))
