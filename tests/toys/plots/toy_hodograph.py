"""A plot in one file."""

from flockana.plots.style import ensure_axes


def toy_hodograph(trajectory, *, ax=None):
    ax = ensure_axes(ax)
    for path in trajectory.p.swapaxes(0, 1):
        ax.plot(*path.T)
    ax.set(xlabel="$p_x$", ylabel="$p_y$")
    return ax
