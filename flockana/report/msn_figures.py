"""The figures of a run of the MSN project's own map: those of any flock, and its curve of connectivity."""

from __future__ import annotations

from matplotlib.figure import Figure

from flockana import plots
from flockana.dynamics.trajectory import Trajectory
from flockana.laws.msn import MSNDiscretisation
from flockana.report.figures import Picture, flock_pictures
from flockana.report.image import png

LAWS = (MSNDiscretisation,)


def pictures(trajectory: Trajectory) -> tuple[Picture, ...]:
    """Draw what is drawn of any flock, and rank(A)/n over time."""

    def draw(figure: Figure) -> None:
        plots.rank_connectivity(trajectory, ax=figure.subplots())

    return (
        *flock_pictures(trajectory),
        Picture(
            "The project's connectivity rank(A)/n of the adjacency matrix, with a zero diagonal and as its code is "
            "typeset (a unit diagonal but for the last agent), beside C = rank(L)/(n − 1), which is 1 exactly when the "
            "net is connected (erratum E8).",
            png(draw, (13.0, 3.2)),
        ),
    )
