"""Films of runs: frames at equal spacing in time, in a fixed view."""

import itertools
import os
from collections.abc import Callable
from dataclasses import replace
from io import BytesIO
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.animation import AbstractMovieWriter, FFMpegWriter, FuncAnimation
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from PIL import Image
from scipy.interpolate import CubicHermiteSpline

from flockana.base.errors import ArgumentError, FileError
from flockana.base.files import atomic_write, ensure_folder_of, ensure_path, ensure_target
from flockana.base.interrupts import defer_sigint
from flockana.base.progress import progress_bar
from flockana.base.value_checks import FloatArray, TimeSpan, ensure_positive
from flockana.dynamics.predicates import ensure_run
from flockana.dynamics.trajectory import Trajectory
from flockana.plots.snapshot import drawn_law, in_view, snapshot
from flockana.plots.style import limit, style
from flockana.scenarios.flock import Flock, run_of
from flockana.scenarios.scenario import Scenario

_DPI = 100
_STILL: dict[Any, Any] = {"figure.constrained_layout.use": False}
_WIDTH, _LEAST, _MOST = 8.0, 3.2, 7.0  # inches: width, and least and greatest height of the film
_FRAMES = 20_000  # a longer film is a slip of the pen
_SUFFIXES = ".gif", ".mp4"


def equal_times(trajectory: Trajectory, count: int) -> Trajectory:
    """Return the run at equally spaced times, interpolated by cubics, without its ``extra`` series.

    Of a map, which has no state between its steps, the nearest ones, with all that its memory holds of them, each once:
    fewer than asked for where it has fewer. So of a run of one sample, that sample.
    """
    t = trajectory.t
    times = np.linspace(t[0], t[-1], count)
    if trajectory.law.is_map or len(t) == 1:
        k = np.unique(np.searchsorted(0.5 * (t[:-1] + t[1:]), times, side="right"))
        extra_series = {name: series[k] for name, series in trajectory.extra.items()}
        return replace(trajectory, t=t[k], q=trajectory.q[k], p=trajectory.p[k], u=trajectory.u[k], extra=extra_series)
    # an agent that hits an obstacle brakes within less than a sample: both cubics follow it, with no overshoot
    q = CubicHermiteSpline(t, trajectory.q, trajectory.p)(times)
    p = CubicHermiteSpline(t, trajectory.p, trajectory.u)(times)
    u = CubicHermiteSpline(t, trajectory.p, trajectory.u).derivative()(times)
    return replace(trajectory, t=times, q=q, p=p, u=u, extra={})


def animation(
    trajectory: Trajectory, *, seconds: float = 10.0, fps: float = 15.0, velocities: bool = False, ranges: bool = False
) -> FuncAnimation:
    """Return a matplotlib animation of `snapshot`s, shown in notebooks by ``to_jshtml()``.

    Parameters
    ----------
    ranges : bool
        Draw circles at the range of interaction about the agents, in the plane.
    """
    ensure_run(trajectory)
    frames = frame_count(seconds, fps)
    film, view_box = equal_times(trajectory, frames), film_view(trajectory)
    times = np.linspace(trajectory.t[0], trajectory.t[-1], frames)  # of a map, some frames may show the same step
    # outside the style, whose layout engine would fit each frame anew and make the view jitter
    figure = Figure(figsize=film_size(view_box), dpi=_DPI)
    FigureCanvasAgg(figure)
    with style():
        ax: Any = figure.add_subplot(projection="3d" if trajectory.m == 3 else None)
        height = film_size(view_box)[1]
        edges = (0.0, 0.0, 0.95, 0.95) if trajectory.m == 3 else (0.09, 0.6 / height, 0.98, 1.0 - 0.35 / height)
        figure.subplots_adjust(*edges)

    def draw(k: int) -> list[Any]:
        with style():
            ax.clear()
            snapshot(film, float(times[k]), ax=ax, velocities=velocities, bar=False, ranges=ranges)
        _fix_view(ax, view_box)
        return []

    return FuncAnimation(figure, draw, frames=frames, init_func=lambda: [], interval=1000.0 / fps, repeat=False)


def animate(
    trajectory: Trajectory | Flock | Scenario | str | None = None,
    path: str | os.PathLike[str] = "",
    *,
    law: Any = None,
    q0: Any = None,
    p0: Any = None,
    t_span: TimeSpan | None = None,
    seed: int = 0,
    seconds: float = 10.0,
    fps: float = 15.0,
    velocities: bool = False,
    ranges: bool = False,
    progress: bool | Callable[[int, int], None] = True,
) -> Path:
    """Write a film of a run: GIF always, MP4 where the program ffmpeg is installed.

    Parameters
    ----------
    trajectory : Trajectory, Flock, Scenario or str, optional
        The run, or what is simulated first: a flock, a scenario or its name.
    law, q0, p0, t_span : optional
        Instead of it: the parts of a `Flock`.
    seed : int
        Seed of a start that is drawn.
    path : path-like
        File to write, ``.gif`` or ``.mp4``; an existing one is replaced only when the new one is whole.
    fps : float
        Frames per second.
    ranges : bool
        Draw circles at the range of interaction about the agents, in the plane.
    progress : bool or callable
        Show a bar on a terminal; or a function that is told the number of frames drawn and their total.
    """
    target = ensure_film(path, seconds=seconds, fps=fps)
    run = run_of(trajectory, law=law, q0=q0, p0=p0, t_span=t_span, seed=seed)
    film = animation(run, seconds=seconds, fps=fps, velocities=velocities, ranges=ranges)
    writer = GifWriter(fps=fps) if target.suffix.lower() == ".gif" else FFMpegWriter(fps=fps)  # type: ignore[arg-type]
    # Ctrl-C is heard between frames: before the first one the writer has nothing to end, and a callback may swallow it.
    # Saving a figure asks for a layout anew, and one that fits each frame by itself makes the view tremble.
    callback, bar_shown = (progress, False) if callable(progress) else (None, progress)
    bar = progress_bar(frame_count(seconds, fps), enabled=bar_shown)
    with atomic_write(target) as partial, defer_sigint() as came, style(), mpl.rc_context(_STILL), bar as advance:

        def drawn(k: int, total: int) -> None:
            if came:
                raise KeyboardInterrupt
            advance(k + 1, "drawing")
            if callback is not None:
                callback(k + 1, total)

        film.save(partial, writer, dpi=_DPI, progress_callback=drawn)
    return target


def ensure_film(path: str | os.PathLike[str], *, seconds: float, fps: float) -> Path:
    """Raise unless a film of this name, length and rate can be written."""
    target = ensure_path(path, action="write")
    frame_count(seconds, fps)
    if target.suffix.lower() not in _SUFFIXES:
        raise ArgumentError(f"{target}: expected a file name that ends in .gif or .mp4")
    if os.path.isdir(target):
        raise ArgumentError(f"{target} is a folder: expected a file name")
    ensure_target(target)
    if target.suffix.lower() == ".mp4" and not FFMpegWriter.isAvailable():
        raise FileError(f"cannot write {target}: MP4 needs the program ffmpeg; install it, or write a .gif")
    return ensure_folder_of(target)


def frame_count(seconds: float, fps: float) -> int:
    """Return the number of frames of a film, at least 1."""
    frames = ensure_positive("seconds", seconds) * ensure_positive("fps", fps)
    if fps > 50.0 or frames > _FRAMES:
        raise ArgumentError(
            f"seconds = {seconds:g} at fps = {fps:g}: expected at most 50 frames per second and {_FRAMES} in all"
        )
    return max(1, round(frames))


def film_view(trajectory: Trajectory) -> FloatArray:
    """Return opposite corners of a box around the whole film, with a margin."""
    points = in_view(drawn_law(trajectory), trajectory)
    low, high = points.min(axis=0), points.max(axis=0)
    margin = 0.04 * float((high - low).max()) or 1.0
    return np.array([low - margin, high + margin])


def film_size(view: FloatArray) -> tuple[float, float]:
    """Return a figure size in inches that suits the view, in even numbers of pixels as MP4 requires."""
    extent = view[1] - view[0]
    if extent.size == 3:
        return 6.4, 5.6
    height = 1.0 + (_WIDTH * float(extent[1] / extent[0]) if extent.size == 2 else 0.0)
    return _WIDTH, round(50.0 * min(max(height, _LEAST), _MOST)) / 50.0


def _fix_view(ax: Any, view: FloatArray) -> None:
    """Fix the view of the axes in every frame."""
    low, high = view
    if low.size == 3:
        ax.set_box_aspect(None, zoom=0.95)
        midpoint, half_width = 0.5 * (low + high), 0.5 * float((high - low).max())
        low, high = midpoint - half_width, midpoint + half_width
    limit(ax, low, high)
    if low.size == 2:
        ax.set_aspect("equal", adjustable="box")


def durations(frames: int, fps: float) -> list[int]:
    """Return the duration of each GIF frame in milliseconds, whole hundredths of a second with the right sum."""
    frame_times = [round(100.0 * k / fps) for k in range(frames + 1)]
    return [10 * (end - start) for start, end in itertools.pairwise(frame_times)]


class GifWriter(AbstractMovieWriter):
    """Writer that collects frames and saves them as a GIF that repeats."""

    def setup(self, fig: Any, outfile: Any, dpi: float | None = None) -> None:
        """Begin a film of a figure with no frames yet, for output to a file."""
        super().setup(fig, outfile, dpi=dpi)
        self._images: list[Image.Image] = []

    def grab_frame(self, **savefig_kwargs: Any) -> None:
        """Render the figure and append the picture as the next frame of the film."""
        with BytesIO() as data:
            self.fig.savefig(data, **{**savefig_kwargs, "format": "rgba", "dpi": self.dpi})
            frame = Image.frombytes("RGBA", self.frame_size, data.getvalue())
        self._images.append(frame.convert("RGB"))

    def finish(self) -> None:
        """Write the collected frames to the GIF file."""
        first_image, *later_images = self._images
        times = durations(len(self._images), self.fps)
        first_image.save(self.outfile, "GIF", save_all=True, append_images=later_images, duration=times, loop=0)
