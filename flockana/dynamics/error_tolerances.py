"""Absolute tolerances of adaptive solvers: multiples of the law's scales, never below rounding."""

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np

from flockana.base.errors import ArgumentError
from flockana.base.natural_scales import Scales
from flockana.base.units import times
from flockana.base.value_checks import FloatArray, ensure_positive
from flockana.dynamics.run_samples import Start

Atol = float | tuple[float, float] | None  # a length, (length, speed), or by default a share of rtol

FLOOR = 1e-2  # of the relative tolerance: the default absolute one, over the law's scales
FINEST = 3e-14  # relative tolerance below which the solvers cannot go
_ROUNDINGS = 1.0  # of the largest coordinate, at that tolerance: what a force makes of rounded places is noise
_COARSER = (
    0.25  # power of the tolerance by which more is allowed: the difference of runs at two tolerances shows the error
)


class ErrorFloors(NamedTuple):
    """Absolute error limits of a run, independent of its state: coordinate, velocity, energy balance."""

    place: float
    speed: float
    work: float


class Control(NamedTuple):
    """Step control of an adaptive solver: relative and absolute tolerances, and the longest step."""

    rtol: float
    floor: ErrorFloors
    longest: float = np.inf


def ensure_atol(name: str, value: Any) -> Atol:
    """Return an absolute tolerance: a length, a pair (length, speed), or None."""
    if value is None or np.ndim(value) == 0:
        return None if value is None else ensure_positive(name, value)
    if np.shape(value) != (2,):
        raise ArgumentError(f"{name} = {value!r}: expected a length, or a pair (length, speed)")
    return ensure_positive(f"{name}[0]", value[0]), ensure_positive(f"{name}[1]", value[1])


def options_in_units(options: Mapping[str, Any], length: float, time: float) -> dict[str, Any]:
    """Return options of `simulate`, or the statistics of a run, in other units."""
    speed = length / time
    factors = {"t_eval": time, "dt": time, "max_step": time, "atol": length}
    scaled_options = {key: times(value, factors[key]) if key in factors else value for key, value in options.items()}
    for key, powers in (("atol", (length, speed)), ("floors", (length, speed, speed**2))):
        if isinstance(options.get(key), tuple | list):
            scaled_options[key] = tuple(value * factor for value, factor in zip(options[key], powers, strict=True))
    return scaled_options


def error_floor(scales: Scales | None, start: Start, duration: float, rtol: float, atol: Atol) -> ErrorFloors:
    """Return absolute tolerances: the given ones with the law's speed, or a hundredth of `rtol` by default.

    A law without scales is measured by the extent of its start and by the duration. Work is measured against the energy
    that it is the change of, not against zero, where it starts. Far from the origin places are known to their rounding
    only, and forces to what it makes of them: nothing below that can be asked for.
    """
    q0, p0 = start.q, start.p
    if scales is None:
        extent, largest_travel = (float(np.abs(x - x.mean(axis=0)).max()) for x in (q0, p0 * duration))
        scales = Scales(extent or largest_travel or float(np.abs(p0).max()) * duration or 1.0, duration)
    if isinstance(atol, tuple):
        length_floor, speed = atol
    else:
        length_floor = FLOOR * rtol * scales.length if atol is None else atol
        speed = length_floor / scales.length * scales.speed
    energy = min(length_floor / scales.length, speed / scales.speed) * len(q0) * scales.energy
    reach = float(np.abs(q0).max() + np.abs(p0.mean(axis=0)).max() * duration)
    rounding_width = _ROUNDINGS * (rtol / FINEST) ** _COARSER * float(np.spacing(reach)) / scales.length
    length_floor, speed = max(length_floor, rounding_width * scales.length), max(speed, rounding_width * scales.speed)
    energy = max(energy, rounding_width * len(q0) * scales.energy)
    return ErrorFloors(length_floor, speed, max(energy, rtol * abs(start.energy)) if start.energetic else energy)


def rounding_floors(t: FloatArray, q: FloatArray, p: FloatArray, u: FloatArray, energies: FloatArray) -> ErrorFloors:
    """Return the rounding errors of positions, velocities and energies of a run, times included."""
    late, far, fast, largest_input, much = (float(np.abs(x).max()) if x.size else 0.0 for x in (t, q, p, u, energies))
    tick = float(np.spacing(late))
    position_error, speed, work_floor = (float(np.spacing(x)) for x in (far, fast, much))
    return ErrorFloors(position_error + tick * fast, speed + tick * largest_input, work_floor)
