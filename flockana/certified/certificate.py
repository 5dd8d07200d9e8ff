"""Basin certificates as JSON, for verification by `flockana check`.

Numbers are exact: decimals as text, computed positions in hexadecimal. A name of a field says which number of
`flockana.certified.basin` it is; what no machine checks stands in the file.
"""

import json
from importlib.metadata import version
from pathlib import Path
from typing import Any

from flockana._version import __version__
from flockana.base.errors import ArgumentError
from flockana.base.files import write_atomic
from flockana.base.seals import with_digest
from flockana.certified.basin import Basin
from flockana.certified.decimals import decimal, format_decimal
from flockana.certified.statements import FORMAT, STATEMENTS


def basin_certificate(basin: Basin) -> dict[str, Any]:
    """Return a basin's certificate as plain data with its digest."""
    if not isinstance(basin, Basin):
        raise ArgumentError(f"basin = {basin!r}: expected a basin, as certify(...) gives it")
    basin.ensure_unedited()
    proof = basin.proof
    u, shells, bounds, found = proof.structure, proof.shells, proof.bounds, proof.decay
    parameters = {name: format_decimal(getattr(u.par, name)) for name in ("d", "r", "eps", "h", "a", "b")}
    gains = {name: format_decimal(getattr(u, name)) for name in ("c1_alpha", "c2_alpha", "c1_gamma", "c2_gamma")}
    bonds = [
        {
            "pairs": [list(pair) for pair in bond.pairs],
            "along": [format_decimal(row[k]) for row in shells.along],
            "across": [format_decimal(row[k]) for row in shells.across],
        }
        for k, bond in enumerate(shells.bonds)
    ]
    data: dict[str, Any] = {
        **head("basin"),
        "law": {"algorithm": type(basin.law).__name__, **parameters, **gains},
        "positions": [[float(x).hex() for x in row] for row in basin.rest],
        "box": format_decimal(proof.box),
        "bonds": bonds,
        "curvatures": [format_decimal(value) for value in shells.curvatures],
        "second_eigenvalue": format_decimal(proof.second),
        "degree": format_decimal(proof.degree),
        "surplus": format_decimal(bounds.surplus),
        "lyapunov": {name: format_decimal(getattr(found, name)) for name in ("eps", "theta", "kappa", "tau")},
        **{name: decimal(getattr(basin, name)) for name in STATED},
    }
    return with_digest(data)


def head(kind: str) -> dict[str, Any]:
    """Return what every certificate of a kind begins with."""
    statement, prose = STATEMENTS[kind]
    made_with = {"flockana": __version__, "python-flint": version("python-flint")}
    return {"format": FORMAT, "kind": kind, "statement": statement, "prose": list(prose), "made_with": made_with}


STATED = ("radius", "level", "curvature", "rate", "overshoot", "distance")


def write_certificate(basin: Basin, path: str | Path) -> None:
    """Write a basin's certificate to a file for `flockana check`.

    Parameters
    ----------
    basin : Basin
        Of `certify`.

    Raises
    ------
    ArgumentError
        If it is no basin as `certify` returned it.
    FileError
        If the file cannot be written.
    """
    write_atomic(path, json.dumps(basin_certificate(basin), indent=1) + "\n")
