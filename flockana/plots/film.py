"""Film of a run that saves to a file; a notebook shows the run in the player."""

import os
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from flockana.dynamics.trajectory import Trajectory
from flockana.plots.animation import animate, frame_count


@dataclass(frozen=True, eq=False)
class Film:
    """Film of a run: a notebook plays the run, `save` writes GIF or MP4.

    Parameters
    ----------
    ranges : bool
        Draw circles at the range of interaction about the agents, in the plane.
    """

    trajectory: Trajectory
    seconds: float = 10.0
    fps: float = 15.0
    velocities: bool = False
    ranges: bool = False

    def __post_init__(self) -> None:
        frame_count(self.seconds, self.fps)

    def __repr__(self) -> str:
        return f"<Film of {self.trajectory!r}, {self.seconds:g} s; .save(path) writes it>"

    @property
    def _options(self) -> dict[str, Any]:
        return {key: value for key, value in vars(self).items() if key != "trajectory"}

    def save(self, path: str | os.PathLike[str]) -> Path:
        """Write the film; an existing file is replaced only once the new one is complete.

        Parameters
        ----------
        path : path-like
            ``.gif``, or ``.mp4`` where the program ffmpeg is installed.
        """
        return animate(self.trajectory, path, **self._options)

    def _repr_html_(self) -> str:
        """Return the HTML of the interactive player of the film's run, for a notebook."""
        return str(self.trajectory.player()._repr_html_())
