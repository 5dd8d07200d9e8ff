"""The toy law's own figure in a report."""

from flockana.sources.toy_2026.laws import ToySwarm

from flockana import plots
from flockana.report.figures import Picture
from flockana.report.svg_figures import svg


def pictures(trajectory):
    return (Picture("Largest speed.", svg(lambda f: plots.measure(trajectory, "toy_speed", ax=f.subplots()), (4, 3))),)


PICTURES = {ToySwarm: pictures}
