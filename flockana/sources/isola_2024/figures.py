"""Figures of a run of the MSN project's map: standard figures, and the connectivity curve."""

import numpy as np

from flockana.dynamics.trajectory import Trajectory
from flockana.measures.nets import links, printed_rank_connectivity
from flockana.report.charts import Chart, Curve, panels
from flockana.report.figures import Picture, flock_pictures
from flockana.sources.isola_2024.laws import MSNDiscretisation

_SAMPLES = 271  # every other of the project's 540 iterations


def pictures(trajectory: Trajectory) -> tuple[Picture, ...]:
    """Draw the standard figures of a run, and its connectivity measure rank(A)/n over time."""
    run = trajectory
    picks = np.unique(np.linspace(0, len(run.t) - 1, min(len(run.t), _SAMPLES)).round().astype(int))
    nets = [links(run.q[k], run.law.pair.range) for k in picks]
    curves = []
    for typeset, name in ((False, "rank(A)/n"), (True, "rank(A)/n as typeset")):
        curves.append(Curve(np.array([printed_rank_connectivity(run.n, net, typeset=typeset) for net in nets]), name))
    curves.append(Curve(run.metric("connectivity")[picks], "C = rank(L)/(n − 1)"))
    return (
        *flock_pictures(run),
        Picture(
            "The project's connectivity rank(A)/n of the adjacency matrix, with a zero diagonal and as its code is "
            "typeset (a unit diagonal but for the last agent), beside C = rank(L)/(n − 1), which is 1 exactly when the "
            "net is connected (erratum E8).",
            panels([Chart("connectivity, three ways", run.t[picks], curves)]),
        ),
    )


PICTURES = {MSNDiscretisation: pictures}
