"""Report section on linearised stability."""

from collections import namedtuple
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from math import pi
from types import SimpleNamespace
from typing import Any

import numpy as np

from flockana.environment import CircleTarget, SineTarget, StaticTarget
from flockana.equilibria import find_equilibrium
from flockana.lattice import hexagonal_patch
from flockana.laws import Algorithm1, Algorithm2
from flockana.report.control_figures import Download, control_pictures, state_space
from flockana.report.figures import Picture, drawn
from flockana.report.page_data import Page
from flockana.report.section_request import DECAYS, LINEARISED, MARGINS
from flockana.report.svg_figures import plots, svg
from flockana.scenarios import scenario, scenarios
from flockana.stability import Linearisation, linearise
from flockana.stability.centre_path import path_and_factor
from flockana.stability.centre_transfer import CentreOfMass
from flockana.theorems import Verdict

_LONGER = (
    "At n = 30 a longer search than this report's (module flockana.stability.design) gave rates of 1.740 with common "
    "gains and 2.061 with gains per agent, 18 % faster, if the rotation counts, and 2.236 and 2.247, 0.5 %, if not"
)


# A row of the table of decay rates, as text: an equilibrium and its slowest mode, and the status of the verdict.
Row = namedtuple(
    "Row", "name mode n frequency predicted measured error difference random_linear random_measured status"
)
_FORMATS = {"mode": "", "n": "", "frequency": ".3f", "predicted": ".5f", "measured": ".5f", "error": ".0e"}


@dataclass(frozen=True)
class LinearisedFlocks:
    """Pictures and state-space files of linearised flocks for the report, independent of the verdicts."""

    poles: tuple[Picture, ...]  # poles and modes of a flock under each algorithm
    control: tuple[Picture, ...]  # step response, root locus and norms
    downloads: tuple[Download, ...]  # state spaces
    name = LINEARISED  # of the task that makes the section


NO_FLOCKS = LinearisedFlocks((), (), ())


@dataclass(frozen=True)
class StabilitySection:
    """Report section on linearised stability: poles, decay rates, linear range and delay margins."""

    flocks: LinearisedFlocks  # pictures and data of flocks under the algorithms
    rows: tuple[Row, ...]
    pictures: tuple[Picture, ...]  # linear range and Bode plot, where their verdicts are at hand
    margins: tuple[str, ...]  # findings on delays and gains


def stability_section(pages: Iterable[Page], flocks: LinearisedFlocks = NO_FLOCKS) -> StabilitySection | None:
    """Return the section on linearised stability from the verdicts; None without any."""
    verdicts = [(page.name, finding.verdict) for page in pages for finding in page.findings]
    decay_verdicts = [(name, v) for name, v in verdicts if v.theorem in DECAYS]
    margins = [v for _, v in verdicts if v.theorem in MARGINS]
    if not decay_verdicts and not margins:
        return None
    pictures = (_range([v for _, v in decay_verdicts]), bode_picture(verdicts), _steps(margins))
    margin_texts = [claim.detail for v in margins for claim in v.claims]
    if any(v.theorem == "heterogeneous-gains" for v in margins):
        margin_texts.append(_LONGER)
    rows = tuple(row for name, v in decay_verdicts for row in _rows(name, v))
    return StabilitySection(flocks, rows, tuple(filter(None, pictures)), tuple(margin_texts))


def linearised_flocks() -> LinearisedFlocks:
    """Return pictures and data of linearised flocks for the report's section on stability."""
    flocks = _flocks()
    files = {name: f"{name}.json".lower().replace(" ", "-") for name, _ in flocks}
    spaces = tuple(state_space(flock, files[name], f"19 agents, {name}") for name, flock in flocks)
    return LinearisedFlocks(flock_pictures(flocks), control_pictures(), spaces)


def _rows(name: str, verdict: Verdict) -> list[Row]:
    claim = next((c for c in verdict.claims if c.name == "decay" and c.computed), None)
    if claim is None:
        return []
    terminal = verdict.theorem == DECAYS[1]
    return [
        Row._make(
            (
                f"{name}, last state" if terminal else label,
                *(f"{decay[key]:{number_format}}" for key, number_format in _FORMATS.items()),
                f"{abs(decay['measured'] / decay['predicted'] - 1.0):.0e}",
                *(f"{decay[f'random, {kind}']:.5f}" for kind in ("linear", "measured")),
                claim.status,
            )
        )
        for label, decay in claim.computed.items()
    ]


def _flocks() -> list[tuple[str, Linearisation]]:
    """Return the linearisations of a hexagon of 19 agents at equilibrium under Algorithms 1 and 2, with names."""
    laws: dict[str, Any] = {"Algorithm 1": Algorithm1(), "Algorithm 2": Algorithm2(target=StaticTarget((0.0, 0.0)))}
    patch = hexagonal_patch(2, 7.0)
    return [(name, linearise(law, find_equilibrium(law, patch))) for name, law in laws.items()]


def flock_pictures(flocks: Iterable[tuple[str, Linearisation]]) -> tuple[Picture, ...]:
    """Return pictures of the poles and the three slowest shape modes of linearised flocks, by law."""
    pictures = []
    for kind, flock in flocks:
        zero = ", ".join(mode.name for mode in flock.zero_modes)
        text = (
            f"Poles and slowest modes of the shape of a hexagon of 19 under {kind}. Zero modes, not counted: {zero}. "
            f"Spectral abscissa {flock.spectral_abscissa:.4f}, of the shape {-flock.structural_decay_rate:.4f}, per "
            "time unit. Arrows: displacements at one instant; orange: the path of an agent in the undamped mode."
        )
        pictures.append(Picture(text, svg(lambda figure, f=flock: _poles_and_modes(figure, f), (13.0, 3.9))))  # type: ignore[misc]
    return tuple(pictures)


def _poles_and_modes(figure: Any, flock: Linearisation) -> None:
    axes: Any = figure.subplots(1, 4, width_ratios=(1.25, 1.0, 1.0, 1.0))
    plots().pole_map(flock.eigenvalues, ax=axes[0])
    shapes = [mode for mode in flock.modes if not mode.name.startswith("translation")]
    for ax, mode in zip(axes[1:], shapes, strict=False):
        plots().mode_shape(flock.q, flock.links, mode.shape, ax=ax, title=plots().mode_title(mode))


def _range(verdicts: Sequence[Verdict]) -> Picture | None:
    claim = next((c for v in verdicts for c in v.claims if c.name == "range" and c.computed), None)
    if claim is None:
        return None
    keys = "amplitudes", "deviations", "net changes"
    curves = {name: tuple(curve[key] for key in keys) for name, curve in claim.computed.items()}
    bend_ratio = claim.witness["σ₁ bends at"]
    exponents = ", ".join(f"{curve['exponent']:.3f}" for curve in claim.computed.values())
    text = (
        "How far the linearisation holds: largest distance ever between a run and the linear motion of its slowest "
        f"mode, over the initial displacement. It grows with the displacement, the distance itself as its square "
        f"(exponents {exponents}), until σ₁ saturates: a link that is off by {bend_ratio:.2g} d no longer pulls in "
        "proportion. White marks: a link formed or broke on the way."
    )
    return drawn(text, (6.5, 4.0), plots().linear_range, curves, marks={"σ₁ bends": bend_ratio})


def _steps(verdicts: Sequence[Verdict]) -> Picture | None:
    """Draw the ratios of the largest stable time steps to the sources' time steps; None without verdicts."""
    claims = [c for v in verdicts if v.theorem == "sampling-margins" for c in v.claims if c.computed]
    if not claims:
        return None
    steps = {c.name: (c.computed["margin"], c.computed["dt"]) for c in claims}
    text = "Margins of the sources: the largest step for which the linearised map is stable, over the source's step."
    return drawn(text, (6.5, 3.0), plots().step_margins, steps)


def bode_picture(verdicts: Sequence[tuple[str, Verdict]]) -> Picture | None:
    """Draw the response to the project's γ-agent with its printed and true p_r, and measured gains."""
    points, centres, words = {}, {}, []
    for name, verdict in verdicts:
        if verdict.theorem != "E12" or name not in scenarios():
            continue
        law: Any = scenario(name).law
        path, factor = path_and_factor(law.target)
        claims = {claim.name: claim for claim in verdict.claims}
        if not isinstance(path, SineTarget | CircleTarget) or claims["predicted"].computed is None:
            continue
        omega = 2.0 * pi * path.frequency
        for kind, label, f in (("predicted", "as handed over", factor), ("consistent", "true", 1.0)):
            points[f"{name}, p_r {label}"] = (omega, float(claims[kind].computed))
            centres[f"p_r = {f:.3g} dq_r/dt"] = CentreOfMass(law.gains, f)
            measured_value, predicted_value = claims[kind].computed, claims[kind].stated
            words.append(f"{name}, p_r {label}: {measured_value:.4f} measured, {predicted_value:.4f} predicted")
    if not points:
        return None
    omegas = np.geomspace(0.3, 30.0, 200)  # drawn by the formula, without python-control
    signals = {"omega": omegas, "input_labels": ["q_r"], "output_labels": ["q_c"]}
    responses = {name: SimpleNamespace(complex=x.response(omegas), **signals) for name, x in centres.items()}

    def draw(figure: Any) -> None:
        axes = plots().bode(responses, ax=figure.subplots(2, 1, sharex=True))
        plots().measured_gains(points, ax=axes[0])

    centre = next(iter(centres.values()))
    text = (
        f"From γ-agent to centre of mass (MSN gains: ω_n = {centre.natural_frequency:.3f}, ζ = "
        f"{centre.damping_ratio:.3g}), with ratios measured from the runs (E12). " + "; ".join(words) + "."
    )
    return Picture(text, svg(draw, (6.5, 4.8)))
