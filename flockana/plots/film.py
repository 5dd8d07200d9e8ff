"""Film of a run that plays in a notebook and saves to a file."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from flockana.plots.animation import animate, animation, frame_count

if TYPE_CHECKING:
    from flockana.dynamics.trajectory import Trajectory


@dataclass(frozen=True, eq=False)
class Film:
    """Film of a run: played in a notebook, saved as GIF or MP4.

    Parameters
    ----------
    ranges : bool
        Draw circles at the range of interaction about the agents, in the plane.

    Raises
    ------
    ArgumentError
        If seconds or fps is not positive, or they ask for too many frames.
    """

    trajectory: Trajectory
    seconds: float = 10.0
    fps: float = 15.0
    velocities: bool = False
    ranges: bool = False

    def __post_init__(self) -> None:
        frame_count(self.seconds, self.fps)

    def save(self, path: str | os.PathLike[str]) -> Path:
        """Write the film; an existing file is replaced only once the new one is complete.

        Parameters
        ----------
        path : path-like
            ``.gif``, or ``.mp4`` where the program ffmpeg is installed.

        Raises
        ------
        ArgumentError, FileError
            As `flockana.plots.animate`.
        """
        return animate(
            self.trajectory,
            path,
            seconds=self.seconds,
            fps=self.fps,
            velocities=self.velocities,
            ranges=self.ranges,
        )

    def _repr_html_(self) -> str:
        """Return the HTML player with its frames."""
        film = animation(
            self.trajectory, seconds=self.seconds, fps=self.fps, velocities=self.velocities, ranges=self.ranges
        )
        return str(film.to_jshtml(fps=round(self.fps), default_mode="loop"))
