"""Player as parts of a page, and as a page of its own."""

from __future__ import annotations

import base64
from functools import cache
from html import escape
from importlib.resources import files
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from jinja2 import Environment

# The drawing takes what height the strip leaves of the window, or of a notebook's frame.
_WHOLE = (
    "body{margin:0;padding:.5rem;background:var(--paper)}"
    "main,#player{display:flex;flex-direction:column}main{min-height:calc(100vh - 1rem)}#player{flex:1 0 auto}"
    "#player canvas{flex:1 0 15rem;height:15rem}"
)
SCRIPTS = ("decode.js", "drawing.js", "strip.js", "player.js")


@cache
def script() -> str:
    """Return the player's JavaScript, which defines ``flockanaPlayer(element, bytes)``."""
    return "".join((files("flockana.player") / name).read_text(encoding="utf-8") for name in SCRIPTS)


@cache
def style() -> str:
    """Return the player's CSS."""
    return (files("flockana.player") / "player.css").read_text(encoding="utf-8")


def text_of(data: bytes) -> str:
    """Return bytes as Base64 text that can be embedded in an HTML page."""
    return base64.b64encode(data).decode("ascii")


def played(data: bytes) -> str:
    """Return the HTML script elements that play an encoded run in the page element ``player``."""
    start = "flockanaPlayer(document.getElementById('player'),bytesOfText(document.getElementById('run').textContent));"
    run = f'<script type="text/plain" id="run">{text_of(data)}</script>'
    return f"{run}<script>(() => {{\n{script()}{start}\n}})();</script>"


def framed(title: str, html: str, height: int) -> str:
    """Return an HTML iframe that holds a page with its scripts, for display in a notebook."""
    look = f"width:100%;height:{height}px;border:0"
    return f'<iframe title="{escape(title)}" sandbox="allow-scripts" style="{look}" srcdoc="{escape(html)}"></iframe>'


def templates() -> Environment:
    """Return the template environment of all pages, which escapes every value."""
    from jinja2 import Environment, PackageLoader, StrictUndefined

    return Environment(
        loader=PackageLoader("flockana", "."), autoescape=True, undefined=StrictUndefined, trim_blocks=True
    )


def page(data: bytes, *, title: str = "A run") -> str:
    """Return a self-contained page with the player and one run."""
    template = templates().get_template("player/page.html.j2")
    return template.render(title=title, style=style(), look=_WHOLE, code=played(data))
