"""Player as parts of a page, and as a page of its own."""

import base64
from functools import cache
from html import escape
from importlib.resources import files

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
    """Return bytes as text that a page can hold.

    Examples
    --------
    >>> text_of(b"FLK1")
    'RkxLMQ=='
    """
    return base64.b64encode(data).decode("ascii")


def played(data: bytes) -> str:
    """Return the elements of a page that play a run in its element ``player``."""
    start = "flockanaPlayer(document.getElementById('player'),bytesOfText(document.getElementById('run').textContent));"
    run = f'<script type="text/plain" id="run">{text_of(data)}</script>'
    return f"{run}<script>(() => {{\n{script()}{start}\n}})();</script>"


def framed(title: str, html: str, height: int) -> str:
    """Return an element that holds a page with scripts, for a notebook."""
    look = f"width:100%;height:{height}px;border:0"
    return f'<iframe title="{escape(title)}" sandbox="allow-scripts" style="{look}" srcdoc="{escape(html)}"></iframe>'


def page(data: bytes, *, title: str = "A run") -> str:
    """Return a self-contained page with the player and one run."""
    return (
        f'<!doctype html><html lang="en"><head><meta charset="utf-8"><title>{escape(title)}</title>'
        '<link rel="icon" href="data:,">'
        '<meta name="viewport" content="width=device-width, initial-scale=1">'
        f"<style>{style()}\n{_WHOLE}</style></head>"
        f'<body><main><h1 class="fp-hidden">{escape(title)}</h1><div id="player"></div></main>'
        f"{played(data)}</body></html>"
    )
