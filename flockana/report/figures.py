"""Figures of one scenario as SVG: the flock at some instants, and curves over time."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np

from flockana.base.module_discovery import source_modules
from flockana.base.value_checks import FloatArray
from flockana.base.vector_norms import lengths
from flockana.dynamics.trajectory import Trajectory
from flockana.report.charts import Chart, Curve, panels
from flockana.report.flock_stills import stills
from flockana.report.svg_figures import svg
from flockana.scenarios.report_claims import PANEL, component_counts, has_metric


@dataclass(frozen=True)
class Picture:
    """Figure with its caption."""

    caption: str  # what it shows and how to read it
    source: str  # SVG elements, in HTML, in the page's own colours


def drawn(caption: str, size: tuple[float, float], draw: Callable[..., object], *given: Any, **options: Any) -> Picture:
    """Return a picture with a caption, drawn by a plot function on one set of axes."""
    return Picture(caption, svg(lambda figure: draw(*given, ax=figure.subplots(), **options), size))


@cache
def pictures_of_laws() -> dict[type, Callable[[Trajectory], tuple[Picture, ...]]]:
    """Return the functions that draw pictures of a run, by law, from the sources' `PICTURES`."""
    return {law: draw for module in source_modules("figures") for law, draw in module.PICTURES.items()}


def pictures(trajectory: Trajectory, instants: Sequence[float] = ()) -> tuple[Picture, ...]:
    """Draw a run with its law's own pictures, or with the standard ones."""
    laws = trajectory.law, trajectory.law.continuous  # of a map that steps another law, that one's figures will do
    draws = (draw for law in laws for kind, draw in pictures_of_laws().items() if isinstance(law, kind))
    draw = next(draws, flock_pictures)
    if not len(instants):
        return draw(trajectory)
    caption = f"The {len(instants)} instants that the source shows: the sample nearest to each. {_WORDS}"
    return (Picture(caption, stills(trajectory, instants)), *draw(trajectory))


_WORDS = "Links shorter than desired by more than a tenth are blue, longer ones orange; a star is a γ-agent."


def flock_pictures(trajectory: Trajectory) -> tuple[Picture, ...]:
    """Draw the flock at its start, middle and end; its measures; energy, distances, speeds and control effort."""
    run, times = trajectory, trajectory.t[[0, middle_sample(trajectory), -1]].tolist()
    has_obstacles = bool((run.law.continuous or run.law).obstacles)
    middle_text = "middle (of a flock that splits: where it is most split)" if has_obstacles else "middle"
    pictures_made = [
        Picture(f"Start, {middle_text} and end. {_WORDS}", stills(run, times)),
        Picture(
            "C = 1 exactly when the net is connected; R is the largest distance from the centre of mass; Ẽ is zero "
            "when every link has length d; K̃ is zero when all velocities agree.",
            panels([measured(run, name) for name in PANEL if has_metric(run, name)]),
        ),
        Picture(
            "The energy H of the law (of Algorithm 2: in the frame of the centre of mass), the residual of its "
            "balance, which is the numerical error of this run; least distance of two agents, with a lower bound that "
            "holds between the samples too; speeds; control effort, the greatest and the mean ‖u‖ of an agent.",
            panels([*_energy(run), _distances(run), speeds(run), effort(run)]),
        ),
    ]
    if has_obstacles:
        words = (
            "Least clearance of any agent from an obstacle; the number of components of the net, which is above 1 "
            "where the flock splits."
        )
        pictures_made.append(Picture(words, panels(_clearances(run))))
    return tuple(pictures_made)


def measured(run: Trajectory, name: str) -> Chart:
    """Return the chart of one metric of a run."""
    measure = run.measure(name)
    return Chart(measure.label, run.t, (Curve(run.metric(name)),), bool(measure.logarithmic))


def speeds(run: Trajectory, levels: Sequence[tuple[float, str]] = ()) -> Chart:
    """Return the chart of greatest, mean and least speed over time."""
    return Chart("speeds (length/time)", run.t, spread(lengths(run.p)), levels=levels)


def effort(run: Trajectory, levels: Sequence[tuple[float, str]] = ()) -> Chart:
    """Return the chart of greatest and mean control effort ‖u‖ over time."""
    return Chart("control effort ‖u‖ (length/time²)", run.t, spread(lengths(run.u))[:2], levels=levels)


def spread(values: FloatArray) -> tuple[Curve, ...]:
    """Return three curves over time: greatest, mean and least value over the agents."""
    statistics = {"greatest": values.max(axis=1), "mean": values.mean(axis=1), "least": values.min(axis=1)}
    return tuple(Curve(series, name) for name, series in statistics.items())


def middle_sample(run: Trajectory) -> int:
    """Return the index of the middle sample; among obstacles, the most split sample of a connected flock."""
    if run.law.obstacles:
        counts = component_counts(run)
        first_sample = int(np.argmax(counts == 1))
        if counts[first_sample] == 1 and counts[first_sample:].max() > 1:
            return first_sample + int(np.argmax(counts[first_sample:]))
    return int(np.searchsorted(run.t, 0.5 * (run.t[0] + run.t[-1])))


def _energy(run: Trajectory) -> list[Chart]:
    if not np.isfinite(energy := run.energy()).any():
        return []
    charts = [Chart("energy H", run.t, (Curve(energy),))]
    if "work" in run.extra:
        charts.append(Chart("residual of the energy balance", run.t, (Curve(run.energy_residual),)))
    return charts


def _distances(run: Trajectory) -> Chart:
    curves = [Curve(run.metric("min_distance"), "at the samples")] if has_metric(run, "min_distance") else []
    bound = np.full(len(run.t), run.min_distance())
    return Chart("least distance (length)", run.t, (*curves, Curve(bound, "bound for all times")))


def _clearances(run: Trajectory) -> list[Chart]:
    law = run.law.continuous or run.law
    flat_positions = run.q.reshape(-1, run.m)
    apart = [obstacle.clearance(flat_positions).reshape(run.q.shape[:2]).min(axis=1) for obstacle in law.obstacles]
    levels = [(run.clearance().lower, "lower bound for all times")]
    if law.obstacle_field is not None:
        levels.append((float(law.obstacle_field.beta.d), "d'"))
    clearance_chart = Chart("least clearance (length)", run.t, (Curve(np.min(apart, axis=0)),), levels=levels)
    return [clearance_chart, Chart("components of the net", run.t, (Curve(component_counts(run).astype(float)),))]
