"""The toy law's own figure in a report."""

from flockana.laws.toy_swarm import ToySwarm

from flockana import plots
from flockana.report.figures import Picture
from flockana.report.image import svg

LAWS = (ToySwarm,)


def pictures(trajectory):
    return (Picture("Largest speed.", svg(lambda f: plots.measure(trajectory, "toy_speed", ax=f.subplots()), (4, 3))),)
