"""Page about a recording: player, measures with errors, comparison with a law, fit and verdicts."""

from collections.abc import Iterable, Sequence
from html import escape
from io import BytesIO
from typing import Any

import numpy as np
import xarray
from matplotlib.figure import Figure

from flockana import plots
from flockana.base.tables import html_table
from flockana.dynamics.trajectory import Trajectory
from flockana.player.page import played, style, text_of
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
    """Return a page that needs no other file."""
    title = f"Recording {rec.source}".strip()
    parts = [f"<h1>{escape(title)}</h1>", f"<p>{escape(repr(rec).strip('<>'))}.</p>"]
    parts += [f"<p>{escape(note)}</p>" for note in notes]

    def draw(figure: Any) -> None:
        for ax, name in zip(figure.subplots(2, 2).ravel(), MEASURES, strict=True):
            recorded_measure(seen, name, ax=ax)

    if trajectory is not None:
        parts.append('<h2>The flock</h2><div id="player"></div>')
    parts.append(f"<h2>Measures</h2>{_figure('Measures over time', draw)}")
    parts.append(html_table(measure_rows(seen), ("measure", "at the start", "at the end")))
    if comparison is not None:
        parts += _compared(comparison)
    if fitted is not None:
        rows = [(name, f"{fitted.values[name]:.4g}", interval_text(*ends)) for name, ends in fitted.intervals.items()]
        parts.append("<h2>Fit</h2>" + html_table(rows, ("parameter", "value", "95 % interval")))
        parts += [f"<p>{escape(text)}</p>" for text in (*fitted.unidentifiable, *fitted.doubts)]
    for verdict in verdicts:
        rows_: list[tuple[str, str, str]] = [(f"given: {h.name}", h.status, h.detail) for h in verdict.hypotheses]
        rows_ += [(c.name, c.status, c.detail) for c in verdict.claims]
        parts.append(f"<h2>{escape(verdict.theorem)}: {escape(verdict.status)}</h2><p>{escape(verdict.subject)}</p>")
        parts.append(html_table(rows_, ("claim", "status", "detail")))
    return _page(title, "".join(parts), trajectory)


def measure_rows(seen: xarray.Dataset) -> list[tuple[str, str, str]]:
    """Return (measure, value at the start, at the end) with errors, as texts."""
    rows = []
    for name in MEASURES:
        values, errors = seen[name].values, seen[f"{name}_error"].values
        known = [f" ± {error:.2g}" if np.isfinite(error) else "" for error in errors]
        first, last = (f"{values[k]:.4g}{known[k]}" for k in (0, -1))
        rows.append((str(seen[name].attrs["long_name"]), first, last))
    return rows


def _compared(comparison: Comparison) -> list[str]:
    name = type(comparison.law).__name__
    own, refitted = share_text(comparison.explained), share_text(comparison.explained_refitted)
    parts = [
        f"<h2>Against {escape(name)}</h2><p>It explains {own} of the recorded accelerations "
        f"(from {comparison.basis}), and {refitted} with gains as the recording has them.</p>"
    ]
    if comparison.findings:
        parts.append("<ul>" + "".join(f"<li>{escape(text)}</li>" for text in comparison.findings) + "</ul>")
    rows = [(s.text, s.symbol, f"{s.found:.4g}", f"{s.stated:.4g}", f"{s.share:.1%}") for s in comparison.shares]
    parts.append(html_table(rows, ("part", "gain", "here", "in the law", "share")))
    parts.append(_figure("Residual by agent and time", lambda figure: residuals(comparison, ax=figure.subplots())))
    return parts


def _figure(caption: str, draw: Any) -> str:
    """A figure as a PNG in the page."""
    with plots.style():
        figure = Figure(figsize=(9.0, 5.2), dpi=110, layout="constrained")
        draw(figure)
        data = BytesIO()
        figure.savefig(data, format="png")
    return f'<figure><img alt="{escape(caption)}" src="data:image/png;base64,{text_of(data.getvalue())}"></figure>'


def _page(title: str, body: str, trajectory: Trajectory | None) -> str:
    code = ""
    if trajectory is not None:
        code = played(scene(trajectory))
    return (
        f'<!doctype html><html lang="en"><head><meta charset="utf-8"><title>{escape(title)}</title>'
        '<meta name="viewport" content="width=device-width, initial-scale=1">'
        f"<style>{style()}\n{_LOOK}</style></head><body><main>{body}</main>{code}</body></html>\n"
    )
