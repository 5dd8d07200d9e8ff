"""Classification of runs by final state: flocking, fragmentation, collapse."""

from typing import TYPE_CHECKING

import numpy as np

from flockana.base.errors import ArgumentError
from flockana.base.value_checks import ensure_nonnegative
from flockana.theorems import Tolerances

if TYPE_CHECKING:
    import xarray

PHASES = ("flocking", "fragmentation", "collapse", "other")
CONTACT = 0.05  # of d
_NEEDED = ("end_distance", "components", "slip", "normalised_deviation_energy")
_FORMER = {"deviation_energy": "normalised_deviation_energy"}  # what saved ensembles called Ẽ once


def phases(
    dataset: "xarray.Dataset", *, contact: float = CONTACT, tolerances: Tolerances | None = None
) -> "xarray.DataArray":
    """Return the final phase of each run of an ensemble as a code into `PHASES`; -1 for a failed run.

    In this order: *collapse*, two agents are closer than `contact` d, which no lattice under pressure is before its
    links fold; *fragmentation*, the net has several components; *flocking*, it is connected with velocities matched
    (slip, K̃ in the law's own scale, ≤ ``tolerances.mismatch``) and links near d (Ẽ ≤ ``tolerances.deviation``), ε₂ and
    ε₁ of Definition 5 of Olfati-Saber (2006); *other*, connected, but still moving or strained. A phase is of the end
    time, not of a limit.
    """
    dataset = dataset.rename({old: new for old, new in _FORMER.items() if old in dataset and new not in dataset})
    missing = [name for name in _NEEDED if name not in dataset]
    if missing:
        raise ArgumentError(f"the dataset lacks {', '.join(missing)}: call ensemble with these metrics")
    limits = tolerances or Tolerances()
    distance, components, mismatch, deviation = (dataset[name] for name in _NEEDED)
    is_settled = (mismatch <= limits.mismatch) & (deviation <= limits.deviation)
    kinds = [distance < ensure_nonnegative("contact", contact), components > 1.0, is_settled]
    names = ("collapse", "fragmentation", "flocking")
    codes = np.select([kind.values for kind in kinds], [PHASES.index(name) for name in names], PHASES.index("other"))
    is_finite = np.isfinite(distance.values) & np.isfinite(components.values)
    attributes = {"long_name": "phase at the end", "flag_values": list(range(len(PHASES)))}
    attributes["flag_meanings"] = " ".join(PHASES)
    return distance.copy(data=np.where(is_finite, codes, -1).astype(np.int8)).assign_attrs(attributes).rename("phase")
