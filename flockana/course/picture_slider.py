"""Precomputed pictures for sliders and films, usable in notebooks and their HTML.

No kernel has to answer a slider, so that lectures run without widgets, headless too, and keep working when exported.
"""

import base64
import io
import json
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from html import escape
from typing import Any

from flockana.base.errors import ArgumentError
from flockana.base.value_checks import ensure_positive
from flockana.player.page import framed

_DPI = 90
_COLOURS = 64  # of a picture: enough for lines and a colour bar, and a third of the bytes
_PAGE = """<!doctype html><meta charset="utf-8"><title>{title}</title>
<style>body{{margin:0;font:14px sans-serif}}img{{display:block;width:100%;max-width:{width}px}}
label{{display:flex;gap:.6em;align-items:center;max-width:{width}px}}input{{flex:1}}</style>
<img alt="{title}" src="{first}"><label>{play}<span>{name}</span>
<input type="range" min="0" max="{last}" value="{start}" aria-label="{name}"><output>{shown}</output></label>
<noscript>Allow scripts in this frame to move the picture.</noscript>
<script>
const pictures = {pictures}, texts = {texts}, seconds = {seconds};
const [image, input, output, button] = ["img", "input", "output", "button"].map(n => document.querySelector(n));
const show = k => {{ input.value = k; image.src = pictures[k]; output.value = texts[k];
  input.setAttribute("aria-valuetext", texts[k]); image.alt = {title_js} + ", " + texts[k]; }};
let timer = null;
const stop = () => {{ clearInterval(timer); timer = null; if (button) button.textContent = "Play"; }};
input.oninput = () => {{ stop(); show(+input.value); }};
if (button) button.onclick = () => {{
  if (timer) return stop();
  button.textContent = "Pause";
  timer = setInterval(() => show((+input.value + 1) % pictures.length), 1000 * seconds / pictures.length);
}};
</script>"""


@dataclass(frozen=True, eq=False)
class Frames:
    """Slider over a sequence of pictures."""

    pictures: tuple[bytes, ...]  # as PNG
    texts: tuple[str, ...]  # the values, as they are shown
    name: str  # what is moved
    title: str  # what is to be seen, for those who cannot see it
    size: tuple[int, int]  # width and height in pixels
    start: int = 0  # which picture is shown first
    seconds: float = 0.0  # of a film; 0 for a slider

    def __repr__(self) -> str:
        """Return a one-line description of the picture slider."""
        return f"<{len(self.pictures)} pictures of {self.title}, {self.name} from {self.texts[0]} to {self.texts[-1]}>"

    def html(self) -> str:
        """Return the slider with its pictures as a self-contained HTML page."""
        sources = ["data:image/png;base64," + base64.b64encode(picture).decode() for picture in self.pictures]
        return _PAGE.format(
            title=escape(self.title),
            title_js=_as_script(self.title),
            name=escape(self.name),
            play='<button type="button">Play</button>' if self.seconds else "",
            first=sources[self.start],
            last=len(sources) - 1,
            start=self.start,
            shown=escape(self.texts[self.start]),
            width=self.size[0],
            pictures=_as_script(sources),
            texts=_as_script(self.texts),
            seconds=self.seconds,
        )

    def _repr_html_(self) -> str:
        return framed(self.title, self.html(), self.size[1] + 40)


def _as_script(value: Any) -> str:
    """Return data as a JSON literal that cannot end the HTML script element around it."""
    return json.dumps(value).replace("<", "\\u003c")


def slider(
    draw: Callable[[Any, Any], object],
    values: Sequence[Any],
    *,
    name: str,
    title: str,
    size: tuple[float, float] = (6.0, 3.6),
    start: int = 0,
    seconds: float = 0.0,
) -> Frames:
    """Return a slider over a sequence of pictures; with `seconds`, one that also plays, as `film` does.

    Examples
    --------
    >>> slider(lambda ax, a: ax.plot([0, 1], [0, a]), [1, 2, 3], name="a", title="a line of slope a")
    <3 pictures of a line of slope a, a from 1 to 3>
    """
    from matplotlib import pyplot as plt

    from flockana.plots import subplots

    if len(values) < 2 or not 0 <= start < len(values):
        raise ArgumentError(f"{len(values)} values, start = {start}: expected at least two values, start one of them")
    figure, ax = subplots(size=size)
    pictures: list[bytes] = []
    for value in values:
        ax.clear()
        draw(ax, value)
        if not pictures:  # the same margins in every picture
            figure.canvas.draw()
            figure.set_layout_engine("none")
        pictures.append(_png(figure))
    plt.close(figure)
    texts = tuple(item if isinstance(item, str) else f"{item:.4g}" for item in values)
    pixels = round(size[0] * _DPI), round(size[1] * _DPI)
    return Frames(tuple(pictures), texts, name, title, pixels, start, seconds)


def film(
    draw: Callable[[Any, Any], object], values: Sequence[Any], *, name: str, title: str, seconds: float = 6.0
) -> Frames:
    """Return a player over a sequence of pictures."""
    return slider(draw, values, name=name, title=title, seconds=ensure_positive("seconds", seconds))


def _png(figure: Any) -> bytes:
    from PIL import Image

    full_image, small_image = io.BytesIO(), io.BytesIO()
    figure.savefig(full_image, format="png", dpi=_DPI, bbox_inches=None)
    Image.open(full_image).convert("RGB").quantize(_COLOURS).save(small_image, format="png", optimize=True)
    return small_image.getvalue()
