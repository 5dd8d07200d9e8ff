"""Steps of a map from each sample of a recording to the next, as mean accelerations."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from flockana.base.errors import ArgumentError
from flockana.base.value_checks import FloatArray
from flockana.recorded.accelerations import Accelerations, drawn_errors, mean_accelerations
from flockana.recorded.one_step_predictions import predicted
from flockana.recorded.recording import Recording


@dataclass(frozen=True, eq=False)
class MapSteps:
    """Stand-in law for a map: the acceleration at a sample is the mean over the map's steps to the next sample."""

    title: str
    accelerations: Mapping[float, FloatArray]  # by the time of the sample

    def flow(self, t: float, q: FloatArray, p: FloatArray) -> tuple[FloatArray, None]:
        """Return the mean acceleration from the sample at a time, with None for the energy rate."""
        return self.accelerations[t], None


def map_steps(rec: Recording, law: Any) -> tuple[Accelerations, MapSteps, FloatArray, str]:
    """Return mean accelerations of samples and map, the map's displacements, and a note on missing noise.

    Each prediction begins at a sample; what else the map remembers is that of a start.
    """
    rec.ensure_complete("a comparison with a map")
    if rec.p is None or len(rec.t) < 2:
        raise ArgumentError(
            f"{len(rec.t)} samples{'' if rec.p is not None else ' without velocities'}: expected two or more with "
            f"velocities, to be led on by {law.title}; give p=, such as (q[1:] - q[:-1])/dt where positions move by "
            "dt p"
        )
    remark, noise = "", getattr(law, "noise", None)
    if noise is not None and noise != (no_noise := type(noise)()):
        law, remark = replace(law, noise=no_noise), f"steps of {law.title} are compared without its noise"
    q, p = predicted(law, rec.t, rec.q, rec.p)
    h = np.diff(rec.t)[:, None, None]
    inputs_by_time = dict(zip(rec.t[:-1].tolist(), (p - rec.p[:-1]) / h, strict=True))
    states = (rec.t[:-1], rec.q[:-1], rec.p[:-1])
    data = mean_accelerations(rec, rec.p)._replace(basis="map", states=states, scheme=None)
    return data, MapSteps(law.title, inputs_by_time), q - rec.q[:-1], remark


def noisy_map_twins(rec: Recording, law: Any, steps: MapSteps) -> list[tuple[Accelerations, MapSteps]]:
    """Return (accelerations, map steps) for a few draws of the stated errors, as if the flock obeyed the map."""
    assert rec.p is not None  # as every recording that a map is compared with
    twins, h, exact = [], np.diff(rec.t)[:, None, None], np.array(list(steps.accelerations.values()))
    for place, speed in drawn_errors(rec):
        data, noisy_steps, _, _ = map_steps(replace(rec, q=rec.q + place, p=rec.p + speed), law)
        twins.append((data._replace(u=exact + np.diff(speed, axis=0) / h), noisy_steps))
    return twins
