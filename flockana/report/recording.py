"""Page about a recording: player, measures with errors, comparison with a law, fit and verdicts."""

from collections.abc import Iterable, Sequence
from io import BytesIO
from typing import Any

import numpy as np
import xarray
from matplotlib.figure import Figure

from flockana import plots
from flockana.base.table_export import MARKS, html_table
from flockana.dynamics.trajectory import Trajectory
from flockana.player.page import played, style, templates, text_of
from flockana.player.scene import scene
from flockana.plots.recording import recorded_measure, residuals
from flockana.recorded.compare import Comparison, share_text
from flockana.recorded.fit import Fit, interval_text
from flockana.recorded.recording import Recording
from flockana.theorems import Verdict

MEASURES = ("cohesion_radius", "normalised_velocity_mismatch", "connectivity", "min_distance")
_LOOK = (
    "body{margin:0 auto;max-width:72rem;padding:1rem;background:var(--paper);color:var(--ink);"
    "font:1rem/1.5 system-ui,sans-serif}table{border-collapse:collapse;margin:.5rem 0 1.5rem;display:block;"
    "overflow-x:auto}td,th{padding:.2rem .9rem .2rem 0;border-bottom:1px solid var(--line)}img{max-width:100%}"
    "h1{font-size:1.5rem}h2{font-size:1.2rem;margin-top:2rem}#player{display:flex;flex-direction:column}"
    "#player canvas{height:26rem}figure{margin:1rem 0}"
)


def recording_page(
    rec: Recording,
    seen: xarray.Dataset,
    *,
    trajectory: Trajectory | None,
    comparison: Comparison | None = None,
    fitted: Fit | None = None,
    verdicts: Sequence[Verdict] = (),
    notes: Iterable[str] = (),
) -> str:
    """Return a self-contained page about a recording."""

    def draw(figure: Any) -> None:
        for ax, name in zip(figure.subplots(2, 2).ravel(), MEASURES, strict=True):
            recorded_measure(seen, name, ax=ax)

    def draw_residuals(figure: Any) -> None:
        residuals(comparison, ax=figure.subplots())  # type: ignore[arg-type]  # where there is one

    return (
        templates()
        .get_template("report/recording.html.j2")
        .render(
            title=f"Recording {rec.source}".strip(),
            about=repr(rec).strip("<>"),
            notes=list(notes),
            style=style(),
            look=_LOOK,
            code="" if trajectory is None else played(scene(trajectory)),
            measures=measure_rows(seen),
            measured=_image(draw),
            comparison=comparison,
            residuals=None if comparison is None else _image(draw_residuals),
            share=share_text,
            fit=fitted,
            interval=interval_text,
            verdicts=verdicts,
            table=html_table,
            marks=MARKS,
        )
    )


def measure_rows(seen: xarray.Dataset) -> list[tuple[str, str, str]]:
    """Return rows (measure, value at start, value at end) of a recording as texts, with errors."""
    rows = []
    for name in MEASURES:
        values, errors = seen[name].values, seen[f"{name}_error"].values
        texts = [f" ± {error:.2g}" if np.isfinite(error) else "" for error in errors]
        first_text, last_text = (f"{values[k]:.4g}{texts[k]}" for k in (0, -1))
        rows.append((str(seen[name].attrs["long_name"]), first_text, last_text))
    return rows


def _image(draw: Any) -> str:
    """Return a drawn figure as a PNG in a data address for an HTML page."""
    with plots.style():
        figure = Figure(figsize=(9.0, 5.2), dpi=110, layout="constrained")
        draw(figure)
        data = BytesIO()
        figure.savefig(data, format="png")
    return f"data:image/png;base64,{text_of(data.getvalue())}"
