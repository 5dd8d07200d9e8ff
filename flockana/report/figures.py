"""The figures of one scenario, composed from `flockana.plots` and written as images that a page can hold."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cache

import numpy as np
from matplotlib.figure import Figure

from flockana import plots
from flockana.base.modules import modules
from flockana.dynamics.trajectory import Trajectory
from flockana.plots.series import has_metric
from flockana.plots.snapshot import drawn_law
from flockana.report.image import png
from flockana.scenarios.findings import component_counts


@dataclass(frozen=True)
class Picture:
    """An image with its words.

    Parameters
    ----------
    caption : str
        What it shows and how to read it.
    source : str
        A ``data:`` address that holds the image.
    """

    caption: str
    source: str


@cache
def pictures_of_laws() -> tuple[tuple[tuple[type, ...], Callable[[Trajectory], tuple[Picture, ...]]], ...]:
    """Laws with figures of their own: (laws, pictures) of every module of this package that ends in _figures."""
    return tuple((module.LAWS, module.pictures) for module in modules("flockana.report", ending="_figures"))


def pictures(trajectory: Trajectory, instants: Sequence[float] = ()) -> tuple[Picture, ...]:
    """Draw a run: by the ``*_figures`` module that names its law among its ``LAWS``, else as any flock is drawn.

    Parameters
    ----------
    trajectory : Trajectory
        The run.
    instants : sequence of float
        Times at which its source shows the flock: they come first, the sample nearest to each.
    """
    draw = next((own for laws, own in pictures_of_laws() if isinstance(trajectory.law, laws)), flock_pictures)
    return (*((_captures(trajectory, instants),) if len(instants) else ()), *draw(trajectory))


def _captures(run: Trajectory, instants: Sequence[float]) -> Picture:
    """The flock at so many instants, in rows of three or four."""
    columns = 3 if len(instants) <= 6 else 4
    rows = -(-len(instants) // columns)

    def draw(figure: Figure) -> None:
        for k, time in enumerate(instants):
            ax = figure.add_subplot(rows, columns, k + 1, projection="3d" if run.m == 3 else None)
            plots.snapshot(run, time, ax=ax, bar=(k + 1) % columns == 0)

    shown = f"As many instants as the source shows, {len(instants)}"
    caption = f"{shown}: the sample nearest to each, drawn as in the next figure."
    return Picture(caption, png(draw, (13.0, rows * (13.0 / columns))))


def flock_pictures(trajectory: Trajectory) -> tuple[Picture, ...]:
    """Draw snapshots, paths, C R Ẽ K̃, energy with its balance, distances and speeds; among obstacles, clearance."""
    law = drawn_law(trajectory)
    linked = law.pair is not None or has_metric(trajectory, "edge_error")
    blocked = bool(law.obstacles)
    drawn = (
        Picture(
            (
                "Start, middle (of a flock that splits: where it is most split) and end. "
                if blocked
                else "Start, middle and end. "
            )
            + ("Links join agents that interact, coloured by strain (length − d)/d. " if linked else "")
            + ("Dotted lines lead to β-agents, the closest points of obstacles within r'. " if blocked else "")
            + "Arrows are velocities, scaled anew in each panel; a star is the γ-agent.",
            _png(_snapshots, trajectory, (13.0, 4.3)),
        ),
        Picture(
            "Paths of all agents; the centre of mass (solid, from circle to dot) against the γ-agent (dashed, ending "
            "in a star), where there is one, in space and over time.",
            _png(_motion, trajectory, (13.0, 4.0)),
        ),
        Picture(
            "C = 1 exactly when the net is connected; R is the largest distance from the centre of mass; Ẽ is zero "
            "when every link has length d; K̃ is zero when all velocities agree.",
            _png(_measures, trajectory, (13.0, 2.9)),
        ),
        Picture(
            "The energy H of the law (of Algorithm 2: in the frame of the centre of mass), and the residual of its "
            "balance, which is the numerical error of this run.",
            _png(_energy, trajectory, (13.0, 2.9)),
        ),
        Picture(
            "Least distance between two agents, with a lower bound that holds between the samples too; speeds of all "
            "agents.",
            _png(_distances, trajectory, (13.0, 2.9)),
        ),
    )
    if not blocked:
        return drawn
    caption = (
        "Least clearance of any agent from each obstacle, with a lower bound that holds between the samples too, and "
        "d', where repulsion begins; the number of components of the net, which leaves 1 where the flock splits."
    )
    return (*drawn, Picture(caption, _png(_clearance, trajectory, (13.0, 2.9))))


def _png(draw: Callable[[Figure, Trajectory], None], run: Trajectory, size: tuple[float, float]) -> str:
    return png(lambda figure: draw(figure, run), size)


def _snapshots(figure: Figure, run: Trajectory) -> None:
    times = run.t[[0, middle_sample(run), -1]]
    for k, time in enumerate(times.tolist()):
        ax = figure.add_subplot(1, 3, k + 1, projection="3d" if run.m == 3 else None)
        plots.snapshot(run, time, ax=ax, bar=k == 2)


def middle_sample(run: Trajectory) -> int:
    """The sample halfway in time; among obstacles the one where a flock, once connected, is most split."""
    if run.law.obstacles:
        counts = component_counts(run)
        since = int(np.argmax(counts == 1))
        if counts[since] == 1 and counts[since:].max() > 1:
            return since + int(np.argmax(counts[since:]))
    return int(np.searchsorted(run.t, 0.5 * (run.t[0] + run.t[-1])))


def _motion(figure: Figure, run: Trajectory) -> None:
    projection = "3d" if run.m == 3 else None
    plots.trajectories(run, ax=figure.add_subplot(1, 3, 1, projection=projection))
    plots.centre_path(run, ax=figure.add_subplot(1, 3, 2, projection=projection))
    plots.centre_of_mass(run, ax=figure.add_subplot(1, 3, 3))


def _measures(figure: Figure, run: Trajectory) -> None:
    plots.panel(run, axes=figure.subplots(1, 4))


def _energy(figure: Figure, run: Trajectory) -> None:
    left, right = figure.subplots(1, 2)
    plots.energy(run, ax=left)
    plots.energy_residual(run, ax=right)


def _distances(figure: Figure, run: Trajectory) -> None:
    left, right = figure.subplots(1, 2)
    plots.distances(run, ax=left)
    plots.speeds(run, ax=right)


def _clearance(figure: Figure, run: Trajectory) -> None:
    left, right = figure.subplots(1, 2)
    plots.clearances(run, ax=left)
    plots.components(run, ax=right)
