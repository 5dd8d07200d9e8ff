"""An equilibrium as a JSON file that carries its law, and is verified again whenever it is read."""

from __future__ import annotations

import json
from importlib.resources import files
from math import isclose
from pathlib import Path
from typing import Any

import numpy as np

from flockana.base.errors import FileError, FlockanaError
from flockana.base.files import replacing
from flockana.base.serialize import from_data, to_data
from flockana.equilibria.potential import Potential
from flockana.equilibria.solve import Equilibrium, finish

_FORMAT = "flockana equilibrium 1"
_AGREE = 1e-6  # relative: eigenvalues written on one machine and computed on another


def write_equilibrium(found: Equilibrium, path: str | Path) -> None:
    """Write an equilibrium, its law and its Hessian spectrum as JSON; numbers read back exactly."""
    data = {
        "format": _FORMAT,
        "law": to_data(found.law),
        "q": found.q.tolist(),
        "energy": found.energy,
        "kind": found.kind,
        "strain": found.strain(),
        "links": len(found.links),
        "rigid_modes": found.rigid_modes,
        "hessian_eigenvalues": found.hessian_eigenvalues.tolist(),
    }
    with replacing(path) as partial:
        partial.write_text(json.dumps(data, indent=1) + "\n")


def read_equilibrium(path: str | Path) -> Equilibrium:
    """Read an equilibrium and compute everything anew from its positions; what the file claims must agree."""
    try:
        data = json.loads(Path(path).read_text())
        if data["format"] != _FORMAT:
            raise ValueError(f"its format is {data['format']!r}, expected {_FORMAT!r}")
        law, q = from_data(data["law"]), np.array(data["q"], dtype=np.float64)
        found = finish(Potential(law), q, True, "read from a file and verified")
        _compare(found, data)
    except (OSError, ValueError, KeyError, TypeError, AttributeError, FlockanaError) as error:
        raise FileError(f"{path} holds no equilibrium: {error}") from error
    return found


def _compare(found: Equilibrium, data: dict[str, Any]) -> None:
    """Raise unless kind, links, modes, energy and spectrum are what the file says."""
    exact = {"kind": found.kind, "links": len(found.links), "rigid_modes": found.rigid_modes}
    for name, value in exact.items():
        if data[name] != value:
            raise ValueError(f"it claims {name} = {data[name]!r}, but {value!r} is computed")
    potential = Potential(found.law)
    unit = potential.force_scale * potential.pair.length  # of energies: a lattice may have none but rounding
    largest = max(float(np.abs(found.hessian_eigenvalues).max(initial=0.0)), unit / potential.pair.length**2)
    claimed = np.array(data["hessian_eigenvalues"], dtype=np.float64)
    if claimed.shape != found.hessian_eigenvalues.shape or np.any(
        np.abs(claimed - found.hessian_eigenvalues) > _AGREE * largest
    ):
        raise ValueError("its Hessian eigenvalues are not those computed from its positions")
    if not isclose(data["energy"], found.energy, rel_tol=_AGREE, abs_tol=_AGREE * unit):
        raise ValueError(f"it claims an energy of {data['energy']}, but {found.energy} is computed")


def smallest_strained() -> Equilibrium:
    """The smallest strict local minimum of V known to us with distinct agents that is no α-lattice, verified anew.

    Thirteen agents, 24 links of 6.849 to 7.116 for d = 7: one more than a rigid net needs, so the lengths cannot all
    be d. Found from random starts of 15, by taking away what its stress does not need; no smaller one turned up.

    Examples
    --------
    >>> q13 = smallest_strained()
    >>> q13.q.shape, q13.kind, round(q13.strain(), 4), q13.curvature > 0.03
    ((13, 2), 'minimum', 0.0216, True)
    """
    return read_equilibrium(str(files("flockana.equilibria") / "strained13.json"))
