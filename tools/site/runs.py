"""Every scenario of the catalogue as it ran: stills as image files, and a page that plays it."""

from __future__ import annotations

import base64
import re
from typing import Any

from flockana.player.page import page as player_page
from flockana.report.flock_stills import stills
from flockana.report.page_data import scenario_page
from flockana.scenarios import scenario
from tools.site.cache import kept

STILL = re.compile(r'<p class="axis">(.*?)</p>(<svg .*?</svg>)', re.DOTALL)
_LOOK = """<style>
.agents { fill:none; stroke:#1d1f21; stroke-linecap:round; } .link { fill:none; stroke:#5f6368; stroke-width:1.2; }
.link.short { stroke:#0072b2; } .link.long { stroke:#8f6200; } .solid { fill:#e3e3dd; stroke:#5f6368; }
.box { fill:none; stroke:#5f6368; } .target { fill:#c65300; } .alien { stroke:#c65300; stroke-width:4; fill:none; }
</style>"""  # the report's colours on white: an image knows nothing of the page around it


def ran(name: str) -> dict[str, Any]:
    """Facts, stills (label, image), the end and the playing page of a scenario; run where the library has changed."""
    return kept("runs", name, ("flockana",), lambda: _ran(name))


def _ran(name: str) -> dict[str, Any]:
    case = scenario(name)
    run = case.run()
    told = scenario_page(case, run, ())
    drawn = next((STILL.findall(p.source) for p in told.pictures if STILL.search(p.source)), None)
    drawn = drawn or STILL.findall(stills(run, [run.t[0], run.t[-1]]))
    play = player_page(base64.b64decode(told.play), title=f"{name}: {case.title}") if told.play else ""
    return {
        "facts": [list(fact) for fact in told.facts],
        "stills": [[label, image(svg)] for label, svg in drawn],
        "end": image(STILL.findall(stills(run, [run.t[-1]]))[0][1]),  # on a scale of its own
        "play": play,
    }


def image(svg: str) -> str:
    """An SVG element of a page as a file of its own.

    Examples
    --------
    >>> image('<svg viewBox="0 0 1 1"><path d="M0 0"/></svg>').startswith('<svg xmlns="http://www.w3.org/2000/svg"')
    True
    """
    text = svg.replace("<svg ", '<svg xmlns="http://www.w3.org/2000/svg" ', 1)
    return text.replace(">", f">{_LOOK}", 1)
