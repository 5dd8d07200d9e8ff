"""Time and memory of studies by size, as measured, and refusal of too long ones."""

from typing import NamedTuple

from flockana.base.value_checks import FloatArray, ensure_affordable

LIMIT = 600.0  # seconds of estimated work, by default


class Cost(NamedTuple):
    """Cost of a study: seconds per size to a power, and megabytes per squared size."""

    seconds: float
    power: int
    megabytes: float


COSTS = {  # of flocks of 50 to 180 coordinates, on one core of 2024
    "the margins of all loops": Cost(3e-7, 4, 1e-3),
    "the transient growth": Cost(3e-6, 3, 4e-4),
    "the norms": Cost(3e-7, 3, 8e-4),
    "the string gains": Cost(1.3e-7, 4, 8e-4),
}
_SECONDS_OF_MAP, _MEGABYTES_OF_MAP = 9e-10, 6e-5  # per cubed and squared number of states of a lifted map


def ensure_study(work: str, size: int, limit: float) -> None:
    """Raise before a study in `COSTS` that would take longer than `limit` seconds for its number of coordinates."""
    seconds, power, megabytes = COSTS[work]
    ensure_affordable(f"{work} of {size} coordinates", size, seconds * size**power, megabytes * size**2, limit)


def ensure_maps(work: str, size: int, inputs: FloatArray, limit: float) -> None:
    """Raise before a study of lifted discrete maps with many delayed inputs that would exceed `limit` seconds."""
    states = size * (4.0 + inputs)
    seconds, megabytes = _SECONDS_OF_MAP * float((states**3).sum()), _MEGABYTES_OF_MAP * float(states.max()) ** 2
    ensure_affordable(f"{work} of {size} coordinates", size, seconds, megabytes, limit)
