"""Recordings as `xarray.Dataset`, in the dimensions of the package `movement`."""

from typing import TYPE_CHECKING, Any

import numpy as np

from flockana.recorded.sample_interface import Samples

if TYPE_CHECKING:
    import xarray

_NAMES = {"q": "position", "p": "velocity", "u": "acceleration"}


def dataset_of(rec: Samples) -> "xarray.Dataset":
    """Return a recording as an `xarray.Dataset` in the layout of the package `movement`."""
    import xarray

    dims = ("time", "space", "individuals")
    data = {
        name: (dims, np.swapaxes(array, 1, 2))
        for key, name in _NAMES.items()
        if (array := getattr(rec, key)) is not None
    }
    attrs: dict[str, Any] = {"source_software": "flockana", "ds_type": "bboxes", "time_unit": "seconds"}
    steps = np.diff(rec.t)
    if len(steps) and np.ptp(steps) <= 1e-6 * rec.interval:
        attrs["fps"] = 1.0 / rec.interval
    attrs |= {"accuracy": str(rec.accuracy), "source": rec.source}
    coords = {"time": rec.t, "space": list("xyz"[: rec.m]), "individuals": list(rec.ids)}
    return xarray.Dataset(data, coords=coords, attrs=attrs)
