"""Drawn figure as SVG in the page's own colours, with searchable text."""

import re
from collections.abc import Callable
from html import escape
from io import StringIO
from types import ModuleType
from typing import Any

_MEASURED_DPI = 72  # that of SVG: texts are as long where they are measured as where they are drawn
_COLOURS = {
    "#222222": "--ink",
    "#000000": "--ink",
    "#6b6b6b": "--muted",
    "#cccccc": "--line",
    "#d9d9d9": "--faint",
    "#ececec": "--faint",
    "#ffffff": "--paper",
    "#0072b2": "--blue",
    "#e69f00": "--orange",
    "#009e73": "--green",
    "#d55e00": "--vermillion",
    "#cc79a7": "--purple",
}  # of plots.style, by what the page calls them
_LONG = 400  # characters of a path; markers, which are small and used often, have fewer
IDS = "FIGURE-"  # begins every id of a figure; the page puts a number in its place


def plots() -> ModuleType:
    """Return the plots package, imported at first use as it loads matplotlib."""
    from flockana import plots

    return plots


def svg(draw: Callable[[Any], object], size: tuple[float, float]) -> str:
    """Return a figure in flockana's style as an ``<svg>`` element."""
    import matplotlib as mpl
    from matplotlib.backends.backend_svg import FigureCanvasSVG

    # the height of titles is given, else matplotlib asks all axes where it may stand
    with plots().style(), mpl.rc_context({"axes.titley": 1.0, "svg.fonttype": "none", "path.simplify_threshold": 0.3}):
        figure = placed(draw, size, _MEASURED_DPI).figure
        text = StringIO()
        canvas: Any = FigureCanvasSVG(figure)
        canvas.print_svg(text, metadata={"Date": None})
    return _adapt_svg(text.getvalue())


def placed(draw: Callable[[Any], object], size: tuple[float, float], dpi: float) -> Any:
    """Return the canvas of a drawn figure, laid out so that texts beside the axes fit in."""
    from matplotlib import rcParams
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    from flockana.plots.axis_scales import plain_scales

    figure: Any = Figure(figsize=size, dpi=dpi, layout="constrained")  # not pyplot's: nothing to close
    canvas: Any = FigureCanvasAgg(figure)
    draw(figure)
    for ax, scales in plain_scales(figure).items():
        top_margin = max(scale.room(canvas.get_renderer())[3] for scale in scales)
        for side in ("left", "center", "right"):
            if title := ax.get_title(side):  # above what else is there
                ax.set_title(title, loc=side, pad=rcParams["axes.titlepad"] + top_margin * 72.0 / dpi)
    figure.get_layout_engine().execute(figure)
    figure.set_layout_engine("none")
    return canvas


def _adapt_svg(text: str) -> str:
    """Adapt matplotlib's SVG to the page: no prologue, unique ids, named colours, fewer digits."""
    text = text[text.index("<svg") :]
    text = re.sub(r"<metadata>.*?</metadata>|<!--.*?-->|<style.*?</style>", "", text, flags=re.DOTALL)
    box = re.search(r'viewBox="[^"]*"', text)
    text = re.sub(r"<svg[^>]*>", f'<svg {box.group(0) if box else ""} class="drawn">', text, count=1)
    names_used = set(re.findall(r'(?:href="#|url\(#)([^")]+)', text))
    text = re.sub(r' id="([^"]*)"', lambda m: f' id="{IDS}{m[1]}"' if m[1] in names_used else "", text)
    text = re.sub(r'(href="#|url\(#)', rf"\g<1>{IDS}", text).replace("xlink:href", "href")
    text = re.sub(r"#[0-9a-f]{6}\b", lambda m: f"var({_COLOURS[m[0]]})" if m[0] in _COLOURS else m[0], text)
    text = re.sub(r"font-family: [^;\"]*;? ?", "", text)  # the page has one
    text = re.sub(r"font: ([^;\"]*?)(\d+(?:\.\d+)?)px [^;\"]*", r"font: \1\2px system-ui, sans-serif", text)
    text = re.sub(r"<[^>]*>", lambda tag: re.sub(r"(\d+\.\d\d)\d+", r"\1", tag[0]), text)  # labels keep theirs
    text = re.sub(r"\s*\n\s*", " ", text)
    return re.sub(r' d="([^"]*)"', lambda m: f' d="{_short(m[1])}"', text)


def _short(path: str) -> str:
    """Shorten SVG path data: drop invisible digits and repeated points."""
    if len(path) > _LONG:
        path = re.sub(r"(\d+\.\d)\d+", r"\1", path)
    path = re.sub(r"(L \S+ \S+ ?)\1+", r"\1", path)
    path = re.sub(r"(\.\d*?)0+(?=\D|$)", r"\1", path)
    return re.sub(r"\.(?=\D|$)| (?=[A-Za-z])|(?<=[A-Za-z]) | $", "", path)


def named(source: str, caption: str, number: int) -> str:
    """Return a figure's SVG with ids unique in the page and an accessible label."""
    label = escape(caption, quote=True)
    return source.replace(IDS, f"f{number}-").replace('class="drawn"', f'class="drawn" role="img" aria-label="{label}"')
