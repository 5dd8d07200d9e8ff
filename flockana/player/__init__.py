"""Interactive player of runs, for notebooks and the report."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from flockana.base.errors import ArgumentError
from flockana.base.files import write_atomic
from flockana.base.value_checks import ensure_count, normalise
from flockana.dynamics.trajectory import Trajectory
from flockana.player.marked_instants import marks_of
from flockana.player.page import framed, page, script, style
from flockana.player.scene import scene
from flockana.theorems import Verdict

__all__ = ["Player", "marks_of", "page", "scene", "script", "style"]


@dataclass(frozen=True, eq=False)
class Player:
    """Interactive player of a run in a notebook, kept in HTML exports."""

    trajectory: Trajectory
    height: int = 760  # of the frame in a notebook, in pixels
    # numbers of places and velocities that are kept at most; of a longer run some samples are left out
    values: int = 240_000
    verdicts: Sequence[Verdict] = ()  # on the run: the instants that their claims point to are marked

    def __post_init__(self) -> None:
        normalise(self, ensure_count, "height", "values")

    def __repr__(self) -> str:
        """Return a one-line description of the player and its run."""
        return f"<Player of {self.trajectory!r}>"

    def html(self) -> str:
        """Self-contained page that plays the run."""
        return page(self._scene())

    def _scene(self) -> bytes:
        return scene(self.trajectory, values=self.values, marks=marks_of(self.trajectory, self.verdicts))

    def save(self, path: str) -> Path:
        """Write the player as a page; an existing file is replaced only once the new one is complete."""
        return write_atomic(path, self.html())

    def _repr_html_(self) -> str:
        return framed("A run", self.html(), self.height)

    def widget(self) -> Any:
        """Return a widget whose ``time`` can be read and set; needs flockana[notebook].

        A notebook with it that is exported to HTML fetches what shows widgets from the network; of the player itself
        the export needs nothing.
        """
        try:
            import anywidget
            import traitlets
        except ImportError:
            raise ArgumentError(
                "a widget needs anywidget: expected it to be installed; run pip install 'flockana[notebook]', or show "
                "run.player() itself, which needs nothing"
            ) from None
        source_text = Path(__file__).with_name("widget.js").read_text(encoding="utf-8")
        fields = {"_esm": script() + source_text, "_css": style()}
        fields |= {"data": traitlets.Bytes().tag(sync=True), "time": traitlets.Float(0.0).tag(sync=True)}
        kind = type("RunWidget", (anywidget.AnyWidget,), fields)
        return kind(data=self._scene(), time=float(self.trajectory.t[0]))
