"""Measures of a recorded flock over time, with errors from the accuracy of the samples."""

from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from flockana.base.value_checks import FloatArray
from flockana.base.vector_norms import lengths
from flockana.measures.measure import Flock, measures
from flockana.measures.metrics import connectivity, giant_share
from flockana.measures.nets import link_lengths, links
from flockana.recorded.sample_interface import Samples
from flockana.recorded.unknown_law import UnknownLaw, scaled_alpha
from flockana.recorded.velocities import with_velocities

if TYPE_CHECKING:
    import xarray

_OF_NETS = {"connectivity": connectivity, "giant_share": giant_share}  # they grow with the range
_OF_VELOCITIES = ("normalised_velocity_mismatch", "velocity_diameter", "order", "coordination")


def measured(rec: Samples, d: float, r: float) -> "xarray.Dataset":
    """Return measures over time (see `Recording.metrics`), without agents missing at a sample."""
    import xarray

    if rec.p is None:
        rec = with_velocities(rec)
    assert rec.p is not None
    p, shape = rec.p, rec.present.shape
    law = UnknownLaw(scaled_alpha(d, r), 1.0, rec.interval)
    used_measures = {name: it for name, it in measures().items() if it.over_time is not None and it.defined(law)}
    values, errors = ({name: np.full(len(rec.t), np.nan) for name in used_measures} for _ in range(2))
    widths = [np.broadcast_to(x, shape) for x in (rec.accuracy.place, rec.accuracy.speed)]
    moving = rec.present & ~np.isnan(p[:, :, 0])
    for is_of_velocities, is_present in ((False, rec.present), (True, moving)):
        for agents, samples in _alike(is_present):
            at = np.ix_(samples, agents)
            flock, half_widths = Flock(law, rec.q[at], np.nan_to_num(p[at])), [x[at].max(axis=1) for x in widths]
            for name, it in used_measures.items():
                if (name in _OF_VELOCITIES) == is_of_velocities:
                    values[name][samples] = series = it.over_time(flock)  # type: ignore[misc]
                    errors[name][samples] = _error(name, flock, series, *half_widths)
    data: dict[str, Any] = {"agents": ("time", rec.present.sum(axis=1), {"long_name": "agents seen"})}
    for name, it in used_measures.items():
        data[name] = ("time", values[name], {"long_name": it.text, "units": it.unit})
        data[f"{name}_error"] = ("time", errors[name], {"long_name": f"error of: {it.text}", "units": it.unit})
    return xarray.Dataset(data, coords={"time": rec.t}, attrs={"accuracy": str(rec.accuracy), "d": d, "r": r})


def _alike(seen: npt.NDArray[np.bool_]) -> list[tuple[npt.NDArray[np.intp], npt.NDArray[np.intp]]]:
    """Return sets of agents, each with the samples at which exactly this set was seen; never empty."""
    sets, group_numbers = np.unique(seen, axis=0, return_inverse=True)
    groups = [(np.flatnonzero(item), np.flatnonzero(group_numbers.ravel() == k)) for k, item in enumerate(sets)]
    return [(agents, samples) for agents, samples in groups if agents.size]


def _error(name: str, flock: Flock, values: FloatArray, off_q: FloatArray, off_p: FloatArray) -> FloatArray:
    """Return the largest change of a measure within the errors of positions or velocities."""
    n = flock.q.shape[1]
    if not np.isfinite(off_q).all():
        return np.full(len(values), np.inf)
    if name in ("cohesion_radius", "min_distance", "position_diameter", "velocity_diameter"):
        return np.multiply(2.0, off_p if name == "velocity_diameter" else off_q)
    if name in ("inertia", "normalised_velocity_mismatch"):  # half a square of a norm, which moves by √n off, over n
        spread_error, share = (off_q, 1.0) if name == "inertia" else (off_p, float(n))
        norm = np.sqrt(2.0 * values * share)
        return (0.5 * (norm + np.sqrt(n) * spread_error) ** 2) / share - values
    if name in ("order", "coordination"):
        speed = lengths(flock.p)
        with np.errstate(divide="ignore", invalid="ignore"):
            turn_angle = np.where(speed > 0.0, 2.0 * off_p[:, None] / speed, 2.0)
        maximum = 1.0 if name == "order" else 2.0
        return np.minimum(maximum * np.minimum(turn_angle, 2.0).mean(axis=1), maximum)
    return np.array([_net_error(name, flock, k, float(values[k]), float(off_q[k])) for k in range(len(values))])


def _net_error(name: str, flock: Flock, k: int, value: float, off: float) -> float:
    """Return the error of a net measure, as links may appear or vanish within position errors."""
    d, r = flock.law.lattice
    q = flock.q[k]
    minimum, maximum = max(r - 2.0 * off, 1e-12 * r), r + 2.0 * off
    if name in _OF_NETS:
        return max(abs(_OF_NETS[name](q, x) - value) for x in (minimum, maximum))
    # Ẽ: links that stay change by 2 off each, those that may come or go by what they add at most
    pairs = links(q, maximum)
    apart = link_lengths(q, pairs)
    is_certain = apart <= minimum
    squares = (np.abs(apart - d) + 2.0 * off) ** 2 / d**2
    high = 2.0 * float(squares.sum()) / (2.0 * int(is_certain.sum()) + 1.0)
    excess = np.maximum(np.abs(apart[is_certain] - d) - 2.0 * off, 0.0) ** 2 / d**2
    low = 2.0 * float(excess.sum()) / (2.0 * len(pairs) + 1.0)
    return max(abs(high - value), abs(value - low))
