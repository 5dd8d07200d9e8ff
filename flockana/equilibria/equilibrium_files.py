"""Equilibria as JSON files, checked against recomputed properties when read."""

import json
from importlib.resources import files
from math import isclose
from pathlib import Path
from typing import Any

import numpy as np

from flockana.base.errors import FileError, FlockanaError, SolverError
from flockana.base.files import read_text_file, write_atomic
from flockana.base.integrity_seals import with_digest, without_digest
from flockana.base.serialize import from_data, read_json, to_data
from flockana.equilibria.potential import Potential
from flockana.equilibria.solve import Equilibrium, ensure_unedited_equilibrium, finish

_FORMAT = "flockana equilibrium 1"
_EXPECTED = f"expected JSON of the format {_FORMAT!r}, as 'flockana equilibrium SOURCE -o FILE' writes it"
_REMEDY = "the file is damaged or was edited: take it as it was written, or find the equilibrium anew"
_KEYS = ("format", "law", "q", "energy", "kind", "strain", "links", "rigid_modes", "hessian_eigenvalues")
_AGREE = 1e-6  # relative: eigenvalues written on one machine and computed on another


def write_equilibrium(equilibrium: Equilibrium, path: str | Path) -> None:
    """Write an equilibrium, its law and its Hessian spectrum as JSON; numbers read back exactly."""
    ensure_unedited_equilibrium("equilibrium", equilibrium)
    data = {
        "format": _FORMAT,
        "law": to_data(equilibrium.law),
        "q": equilibrium.q.tolist(),
        "energy": equilibrium.energy,
        "kind": equilibrium.kind,
        "strain": equilibrium.strain(),
        "links": len(equilibrium.links),
        "rigid_modes": equilibrium.rigid_modes,
        "hessian_eigenvalues": equilibrium.hessian_eigenvalues.tolist(),
    }
    write_atomic(path, json.dumps(with_digest(data), indent=1) + "\n")


def read_equilibrium(path: str | Path) -> Equilibrium:
    """Return an equilibrium from a file, after recomputing its properties and comparing them with the file."""
    data = _read(path)
    try:
        law, q = from_data(data["law"]), np.array(data["q"], dtype=np.float64)
        equilibrium = finish(Potential(law), q, True, "read from a file and verified")
        _compare(equilibrium, data)
        without_digest(data, keys=_KEYS)
    except SolverError as error:  # the solver's advice concerns a search, not a file
        raise _not_an_equilibrium(path, f"its positions are none of its law; {_REMEDY}") from error
    except KeyError as error:
        raise _not_an_equilibrium(path, f"it lacks {error}; {_REMEDY}") from error
    except (ValueError, TypeError, AttributeError, RecursionError, FlockanaError) as error:
        raise _not_an_equilibrium(path, f"{error}; {_REMEDY}") from error
    return equilibrium


def _read(path: str | Path) -> dict[str, Any]:
    """Return the data of an equilibrium file; raise unless the file is JSON of the equilibrium format."""
    try:
        data = read_json(read_text_file(path))
    except FlockanaError as error:
        raise _not_an_equilibrium(path, error) from error
    except ValueError as error:
        raise _not_an_equilibrium(path, f"it is no JSON ({error}); {_EXPECTED}") from error
    if not isinstance(data, dict) or "format" not in data:
        raise _not_an_equilibrium(path, _EXPECTED)
    if data["format"] != _FORMAT:
        raise _not_an_equilibrium(path, f"its format is {data['format']!r}; {_EXPECTED}")
    return data


def _not_an_equilibrium(path: str | Path, reason: object) -> FileError:
    return FileError(f"{path} holds no equilibrium: {reason}")


def _compare(equilibrium: Equilibrium, data: dict[str, Any]) -> None:
    """Raise unless an equilibrium's kind, links, rigid modes, energy and spectrum agree with its file."""
    exact = {"kind": equilibrium.kind, "links": len(equilibrium.links), "rigid_modes": equilibrium.rigid_modes}
    for name, value in exact.items():
        if data[name] != value:
            raise ValueError(f"it claims {name} = {data[name]!r}, but {value!r} is computed")
    potential = Potential(equilibrium.law)
    unit = potential.force_scale * potential.pair.length  # of energies: a lattice may have none but rounding
    largest = max(float(np.abs(equilibrium.hessian_eigenvalues).max(initial=0.0)), unit / potential.pair.length**2)
    stated_eigenvalues = np.array(data["hessian_eigenvalues"], dtype=np.float64)
    if stated_eigenvalues.shape != equilibrium.hessian_eigenvalues.shape or np.any(
        np.abs(stated_eigenvalues - equilibrium.hessian_eigenvalues) > _AGREE * largest
    ):
        raise ValueError("its Hessian eigenvalues are not those computed from its positions")
    if not isclose(data["energy"], equilibrium.energy, rel_tol=_AGREE, abs_tol=_AGREE * unit):
        raise ValueError(f"it claims an energy of {data['energy']}, but {equilibrium.energy} is computed")


def smallest_strained() -> Equilibrium:
    """Return the smallest known strict minimum of V with distinct agents that is not an α-lattice, recomputed."""
    # Thirteen agents, 24 links of 6.849 to 7.116 for d = 7: one more than a rigid net needs, so the lengths cannot all
    # be d. Found from random starts of 15, by taking away what its stress does not need; no smaller one turned up.
    return read_equilibrium(str(files("flockana.equilibria") / "strained13.json"))
