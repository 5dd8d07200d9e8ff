"""Certificates of basins and of tubes as JSON, for verification by `flockana check`.

Numbers are exact: decimals as text, computed positions in hexadecimal. A name of a field says which number of
`flockana.certified.basin` it is; what no machine checks stands in the file. A tube's certificate holds a path of
polynomials beside the run, of a higher order than the tube's, and its distance from it, verified by another argument.
"""

import json
from fractions import Fraction
from importlib.metadata import version
from pathlib import Path
from typing import Any

import numpy as np
from flint import arb, ctx

from flockana._version import __version__
from flockana.base.errors import ArgumentError, format_value
from flockana.base.files import write_atomic
from flockana.base.integrity_seals import with_digest
from flockana.certified.balls import ball
from flockana.certified.basin import Basin
from flockana.certified.certificate_statements import FORMAT, STATEMENTS
from flockana.certified.check_motion import number
from flockana.certified.check_tube import BITS, Run, exact
from flockana.certified.decimal_rounding import decimal, small
from flockana.certified.flow_in_balls import Flow, flow_of
from flockana.certified.pair_laws_in_series import Piece
from flockana.certified.tube import Tube
from flockana.laws.algorithm3 import Algorithm3
from flockana.laws.olfati_saber import Algorithm2

STATED = ("radius", "level", "curvature", "rate", "overshoot", "distance")
_ORDER = 26  # of the paths
_TRIES = 30  # of an error that holds itself up


def basin_certificate(basin: Basin) -> dict[str, Any]:
    """Return a basin's certificate as plain data with its digest."""
    if not isinstance(basin, Basin):
        raise ArgumentError(f"basin = {basin!r}: expected a basin, as certify(...) gives it")
    basin.ensure_unedited()
    proof = basin.proof
    u, shells, bounds, decay_bounds = proof.structure, proof.shells, proof.bounds, proof.decay
    parameters = {name: decimal(value) for name, value in vars(u.par).items()}
    gains = {name: decimal(getattr(u, name)) for name in ("c1_alpha", "c2_alpha", "c1_gamma", "c2_gamma")}
    bonds = [
        {
            "pairs": [list(pair) for pair in bond.pairs],
            "along": [decimal(row[k]) for row in shells.along],
            "across": [decimal(row[k]) for row in shells.across],
        }
        for k, bond in enumerate(shells.bonds)
    ]
    data: dict[str, Any] = {
        **head("basin"),
        "law": {"algorithm": type(basin.law).__name__, **parameters, **gains},
        "positions": [[float(x).hex() for x in row] for row in basin.rest],
        "box": decimal(proof.box),
        "bonds": bonds,
        "curvatures": [decimal(value) for value in shells.curvatures],
        "second_eigenvalue": decimal(proof.second),
        "degree": decimal(proof.degree),
        "surplus": decimal(bounds.surplus),
        "lyapunov": {name: decimal(getattr(decay_bounds, name)) for name in ("eps", "theta", "kappa", "tau")},
        **{name: decimal(getattr(basin, name)) for name in STATED},
    }
    return with_digest(data)


def head(kind: str) -> dict[str, Any]:
    """Return the first entries that all certificates of a kind share: format, statement and versions."""
    statement, prose = STATEMENTS[kind]
    version_table = {"flockana": __version__, "python-flint": version("python-flint")}
    return {"format": FORMAT, "kind": kind, "statement": statement, "prose": list(prose), "made_with": version_table}


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


def tube_certificate(tube: Tube, *, basin: Basin | None = None, weight: float = 10.0) -> dict[str, Any]:
    """Return the certificate of the run in the middle of a tube, as plain data with its digest."""
    _ensure_certifiable(tube, basin)
    with ctx.workprec(BITS):
        data = _start(tube, weight) | {"times": [_hexadecimal(arb(t)) for t in tube.t], "paths": _paths(tube)}
        run = Run.of(data)
        return with_digest(data | _followed(run, tube, data["paths"]) | _ending(tube, basin))


def write_tube_certificate(tube: Tube, path: str | Path, *, basin: Basin | None = None) -> None:
    """Write a tube's certificate to a file for `flockana check`.

    Parameters
    ----------
    tube : Tube
        Of one start, complete.
    basin : Basin, optional
        In which it ends.

    Raises
    ------
    ArgumentError
        On a tube of which there is no certificate.
    FileError
        If the file cannot be written.
    """
    write_atomic(path, json.dumps(tube_certificate(tube, basin=basin), indent=1) + "\n")


def _ensure_certifiable(tube: Tube, basin: Basin | None) -> None:
    if not isinstance(tube, Tube):
        raise ArgumentError(f"tube = {tube!r}: expected a tube, as enclose(...) gives it")
    tube.ensure_unedited()
    if not isinstance(basin, Basin | None):
        raise ArgumentError(f"basin = {basin!r}: expected a basin, as certify(...) gives it, or None")
    law: Any = tube.law
    if law.alpha.unit != 1.0 or (isinstance(law, Algorithm3) and law.beta.unit != 1.0):
        raise ArgumentError(f"law = {format_value(law)}: expected Algorithm1, 2 or 3 with unit = 1")
    if type(law) is Algorithm3 and (basin is not None or tube.law.target.harmonic.terms[1].any()):
        raise ArgumentError(f"law = {format_value(law)}: expected a γ-agent at rest under Algorithm3, and no basin")
    if tube.n < 2 or tube.status != "complete" or any(tube.stats["radius"]):
        raise ArgumentError(f"{tube!r}: expected a complete tube of two agents or more from one start, radius=0")
    if basin is not None and (tube.m > 2 or not tube.ends_in(basin)):
        raise ArgumentError("basin: expected one, in one or two dimensions, that the tube certainly ends in")


def _start(tube: Tube, weight: float) -> dict[str, Any]:
    law, gains, zero = tube.law, tube.law.gains, ["0"] * tube.m
    has_target = isinstance(law, Algorithm2 | Algorithm3)
    terms = law.target.harmonic.terms if has_target else np.zeros((5, tube.m))
    path = {"start": terms[0], "velocity": terms[1], "declared": terms[1] + terms[4]}
    decimal_values = _decimals(law.alpha, "d", "r", "eps", "h", "a", "b") | _decimals(gains, "c1_alpha", "c2_alpha")
    decimal_values |= _decimals(gains, "c1_gamma", "c2_gamma") if has_target else {"c1_gamma": "0", "c2_gamma": "0"}
    target = {name: [_decimal(x) for x in row] if has_target else zero for name, row in path.items()}
    return head("tube") | {
        "law": {"algorithm": type(law).__name__, **decimal_values, **target, **_spheres(law)},
        "q0": [[_hexadecimal(arb(x)) for x in row] for row in tube.q0.tolist()],
        "p0": [[_hexadecimal(arb(x)) for x in row] for row in tube.p0.tolist()],
        "weight": _decimal(weight),
    }


def _spheres(law: Any) -> dict[str, Any]:
    """Return the obstacles of Algorithm 3 and their β-law in the form of a certificate."""
    if not isinstance(law, Algorithm3):
        return {}
    numbers: dict[str, Any] = {f"beta_{name}": _decimal(getattr(law.beta, name)) for name in ("d", "eps", "h")}
    spheres: tuple[Any, ...] = law.obstacles
    places = [{"centre": [_decimal(y) for y in sphere.centre], "radius": _decimal(sphere.radius)} for sphere in spheres]
    return numbers | _decimals(law.gains, "c1_beta", "c2_beta") | {"spheres": places}


def _paths(tube: Tube) -> list[list[list[str]]]:
    """Return Taylor polynomials of the positions in a run's steps, each from the exact end of the one before."""
    flow, half_dimension, paths = flow_of(tube.law, tube.n, tube.m), tube.n * tube.m, []
    state = [arb(x) for x in (*tube.q0.ravel().tolist(), *tube.p0.ravel().tolist())]
    for t, end, step in zip(tube.t[:-1], tube.t[1:], tube.taken, strict=True):
        h, rows = arb(end) - arb(t), _polynomials(flow, arb(t), state, flow.pieces(step.during))
        paths.append([[_hexadecimal(c) for c in row] for row in rows[:half_dimension]])
        q = [sum((c * h**k for k, c in enumerate(row)), arb(0)) for row in rows[:half_dimension]]
        p = [sum((k * c * h ** (k - 1) for k, c in enumerate(row) if k), arb(0)) for row in rows[:half_dimension]]
        state = [x.mid() for x in (*q, *p)]
    return paths


def _polynomials(flow: Flow, t: arb, state: list[arb], pieces: tuple[Piece, ...]) -> list[list[arb]]:
    """Return polynomials of the positions in a step, cubic where a pair crosses a switching distance."""
    half = flow.n * flow.m
    if Piece.SWITCH not in pieces:
        return [[c.mid() for c in row] for row in flow.taylor(t, state, _ORDER, pieces)[:half]]
    piece_numbers = flow.pieces(state)
    u, jerk = flow.input(t, state, piece_numbers), flow.acceleration(t, state, piece_numbers)[half:]
    return [[c.mid() for c in (state[k], state[half + k], u[k] / 2, jerk[k] / 6)] for k in range(half)]


def _followed(run: Run, tube: Tube, paths: list[list[list[str]]]) -> dict[str, Any]:
    """Return verified error bounds of a run's polynomial paths, and bounds of distances, radii and energy."""
    start = state = [arb(x) for x in (*tube.q0.ravel(), *tube.p0.ravel())]
    error, errors, boxes = arb(0), [], []
    for t, end, text in zip(tube.t[:-1], tube.t[1:], paths, strict=True):
        h, path = arb(end) - arb(t), [[ball(exact(c)) for c in row] for row in text]
        error = run.jumped(state, path, error)
        stated_value = small((2 * error).max(arb("1e-28")))
        for _ in range(_TRIES):
            enclosure, box = run.grown(arb(t), h, path, error, number(stated_value))
            if enclosure < number(stated_value) < 2 * enclosure + arb(2) ** -90:
                break
            stated_value = small((arb("1.3") * enclosure).max(arb("1e-28")))
        else:
            raise ArgumentError(f"no error bound is verified at t = {t:g}: expected another weight or tube")
        errors.append(stated_value)
        boxes.append(box)
        state, error = run.at(path, h), enclosure
    return {"errors": errors} | run.stated(boxes, start)


def _ending(tube: Tube, basin: Basin | None) -> dict[str, Any]:
    """Return the certificate of the basin in which a tube ends, and the rotation of its equilibrium."""
    if basin is None:
        return {"basin": None, "turn": "0"}
    x = tube.q[-1] - tube.q[-1].mean(axis=0)
    angle = 0.0 if tube.m == 1 else float(np.angle(np.sum((x @ (1.0, 1.0j)) * np.conj(basin.rest @ (1.0, 1.0j)))))
    return {"basin": basin_certificate(basin), "turn": _decimal(round(angle, 15))}


def _decimals(parameters: Any, *names: str) -> dict[str, str]:
    return {name: _decimal(getattr(parameters, name)) for name in names}


def _decimal(x: float) -> str:
    return decimal(Fraction(repr(float(x))))


def _hexadecimal(x: arb) -> str:
    """Return an exact number as hexadecimal mantissa and exponent of 2."""
    mantissa, exponent = x.man_exp()
    return f"{int(mantissa):#x}p{int(exponent)}"
