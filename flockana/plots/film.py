"""Film of a run that plays in a notebook and saves to a file."""

import os
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from flockana.dynamics.trajectory import Trajectory
from flockana.plots.animation import animate, animation, frame_count


@dataclass(frozen=True, eq=False)
class Film:
    """Film of a run: played in a notebook, saved as GIF or MP4.

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
        """Return the HTML player with its frames."""
        return str(animation(self.trajectory, **self._options).to_jshtml(fps=round(self.fps), default_mode="loop"))
