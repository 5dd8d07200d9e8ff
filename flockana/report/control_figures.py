"""Step response, root locus, norms and state-space data for the report."""

import base64
import json
from dataclasses import dataclass
from math import pi
from typing import Any

import numpy as np

from flockana.interactions import Gains
from flockana.laws import Algorithm1
from flockana.report.charts import Chart, Curve, panels
from flockana.report.figures import Picture
from flockana.report.svg_figures import plots, svg
from flockana.stability import Linearisation
from flockana.stability.centre_transfer import CentreOfMass
from flockana.stability.gain_sweeps import centre_locus
from flockana.stability.law_studies import norms_against_size

_SIZES = (3, 7, 12, 19)


@dataclass(frozen=True)
class Download:
    """File embedded in the report page for download: name, description and data address."""

    name: str
    words: str  # what is in it
    address: str  # a ``data:`` address that holds it


def control_pictures() -> tuple[Picture, ...]:
    """Return step response and root locus of the centre of mass, and norms against size, as pictures."""
    gains = Gains()
    centre = CentreOfMass(gains)
    t = np.linspace(0.0, 12.0 * pi / centre.natural_frequency / 2.0, 300)
    response = Curve(np.ravel(centre.step_response(t).y))
    step = Chart("centre of mass after a unit step of the γ-agent", t, (response,), levels=((1.0, "γ-agent"),))
    locus, _ = centre_locus(gains, "c1_gamma", np.linspace(0.0, 3.0 * gains.c1_gamma, 61))
    table = norms_against_size(Algorithm1(), _SIZES)

    def roots(figure: Any) -> None:
        axes = figure.subplots(1, 2)
        plots().root_locus(locus, ax=axes[0])
        plots().norms(table, ax=axes[1])

    rows = "; ".join(
        f"n = {n}: H₂ {h2:.4g}, H∞ {hinf:.4g} at ω = {peak:.3g}"
        for n, h2, hinf, peak in zip(table.sizes, table.h2, table.hinf, table.peak, strict=True)
    )
    return (
        Picture(
            f"Step response of the centre of mass (c1γ = {gains.c1_gamma:.4g}, c2γ = {gains.c2_gamma:.4g}: "
            f"ω_n = {centre.natural_frequency:.4g}, ζ = {centre.damping_ratio:.4g}).",
            panels([step]),
        ),
        Picture(
            "Left: root locus of the centre of mass over c1γ. Right: norms from forces on the agents to the shape of "
            f"relaxed hexagonal flocks under Algorithm 1, against their size ({rows}).",
            svg(roots, (9.0, 3.6)),
        ),
    )


def state_space(flock: Linearisation, name: str, words: str) -> Download:
    """Return a linearised flock as JSON: entries of A in the order (δq, δp), agent by agent."""
    matrix = flock.A_sparse.tocoo()
    is_nonzero = np.abs(matrix.data) > 0.0
    columns = (values[is_nonzero].tolist() for values in (matrix.row, matrix.col, matrix.data))
    entries = [list(entry) for entry in zip(*columns, strict=True)]
    data = {
        "what": words,
        "state": "(q.ravel(), p.ravel()), deviations from the equilibrium",
        "input": "B = [0; I]: a force on each agent",
        "q": flock.q.tolist(),
        "A_shape": list(matrix.shape),
        "A_row_column_value": entries,
    }
    text = base64.b64encode(json.dumps(data, separators=(",", ":")).encode("utf-8")).decode("ascii")
    return Download(name, words, f"data:application/json;base64,{text}")
