"""Agents sampled at different times: rejected, kept with gaps, or interpolated to common instants."""

from dataclasses import replace
from typing import Any

import numpy as np

from flockana.base.errors import ArgumentError
from flockana.base.value_checks import FloatArray
from flockana.recorded.recording import Recording
from flockana.recorded.velocities import pieces_of

_SHARED = 0.25  # of the fewer samples of two agents: fewer at one instant are those of two clocks
_ENOUGH = 5  # samples of each while both are seen, from which on this is judged
_MOST = 200  # agents that are judged, those with most samples


def ensure_one_clock(rec: Recording) -> None:
    """Raise if two agents are seen over the same period but hardly ever at one instant."""
    present_agents = np.sort(np.argsort(-rec.present.sum(axis=0), kind="stable")[:_MOST])
    presence: FloatArray = rec.present[:, present_agents].astype(np.float64)
    in_span = np.maximum.accumulate(presence, axis=0) * np.maximum.accumulate(presence[::-1], axis=0)[::-1]
    overlap_counts, shared = presence.T @ in_span, presence.T @ presence
    fewer_samples = np.minimum(overlap_counts, overlap_counts.T)
    is_disjoint = (fewer_samples >= _ENOUGH) & (shared < _SHARED * fewer_samples)
    if is_disjoint.any():
        i, j = (int(x) for x in np.argwhere(is_disjoint)[0])
        first_id, second_id = (rec.ids[present_agents[k]] for k in (i, j))
        counts = f"{overlap_counts[i, j]:.0f} and {overlap_counts[j, i]:.0f}"
        raise ArgumentError(
            f"agents {first_id} and {second_id} are sampled at other times: of {counts} samples while both are seen, "
            f"{shared[i, j]:.0f} are at one instant; expected common instants: give jitter=, within which stamps are "
            "one; or interpolate=, the largest acceleration an agent can have; or interpolate=False, which leaves "
            "gaps, for fit and with_velocities"
        )


def interpolated(rec: Recording, most_acceleration: float) -> Recording:
    """Return a recording interpolated to the instants of the agent with most samples.

    The error of each position covers every motion whose accelerations are at most as large as stated; gaps stay.
    """
    if not rec.gaps:
        return rec
    full, is_between = rec.filled(most_acceleration=most_acceleration), (pieces_of(rec) >= 0)[:, :, None]
    arrays: Any = {name: np.where(is_between, x, np.nan) for name in "qp" if (x := getattr(full, name)) is not None}
    full = replace(full, **arrays).select(samples=rec.present[:, int(np.argmax(rec.present.sum(axis=0)))])
    error = np.broadcast_to(full.sd if full.bound is None else full.bound, full.present.shape)
    note = (
        f"interpolated to {len(full.t)} instants of one agent: errors are {error[full.present].max():.4g} at most, "
        f"with accelerations up to {most_acceleration:.4g}"
    )
    return replace(full, read_as=(*full.read_as, note))
