"""Stand-in for the unknown law of a recorded flock."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

from flockana.base.errors import ArgumentError
from flockana.base.natural_scales import Scales
from flockana.base.units import Powers
from flockana.base.value_checks import FloatArray, ensure_positive, normalise
from flockana.interactions import AlphaInteraction
from flockana.laws.discrete import DiscreteLaw


@dataclass(frozen=True)
class UnknownLaw(DiscreteLaw):
    """Unknown law of a recorded flock, with stated scale and range only.

    Parameters
    ----------
    alpha : AlphaInteraction, optional
        Its d and r are those that nets and lattices are measured with.
    time : float
        Time unit of thresholds.
    dt : float
        Interval between samples.
    """

    alpha: AlphaInteraction | None = None
    time: float = 1.0
    dt: float = 1.0

    units: ClassVar[Mapping[str, Powers]] = {"time": (0, 1), "dt": (0, 1)}

    def __post_init__(self) -> None:
        normalise(self, ensure_positive, "time", "dt")

    @property
    def scales(self) -> Scales | None:  # noqa: D102
        return None if self.alpha is None else Scales(self.alpha.length, self.time)

    def step(  # noqa: D102
        self, t: float, q: FloatArray, p: FloatArray, memory: Mapping[str, FloatArray]
    ) -> tuple[FloatArray, FloatArray, FloatArray, Mapping[str, FloatArray]]:
        raise ArgumentError("the law of this recording is not known: expected a law to step; see flockana.recognise")


def scaled_alpha(d: float | None, r: float | None) -> AlphaInteraction:
    """Return Olfati-Saber's pair law with scale d and range r; a missing one follows from r = 1.2 d."""
    d = ensure_positive("d", d) if d is not None else ensure_positive("r", r) / 1.2
    return AlphaInteraction(d=d, r=1.2 * d if r is None else ensure_positive("r", r))
