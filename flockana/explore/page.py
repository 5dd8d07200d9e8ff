"""HTML page of the explorer, with its scripts and styles inlined."""

import json
from functools import cache
from importlib.resources import files
from typing import Any

from flockana.explore.page_starts import law_names
from flockana.player.page import script, style, templates
from flockana.report.catalogues import scenario_entries

_SCRIPTS = ("form.js", "handles.js", "answers.js", "history.js", "explore.js")


@cache
def _text(name: str) -> str:
    return (files("flockana.explore") / name).read_text(encoding="utf-8")


def page(first: dict[str, Any], nonce: str) -> str:
    """Return the HTML of the explorer's page, with its scripts and styles inlined."""
    scenarios: dict[str, dict[str, str]] = {}  # titles by source and name
    for entry in scenario_entries():
        scenarios.setdefault(entry["source"], {})[entry["name"]] = entry["title"]
    groups = [{"label": source_name, "kind": "scenario", "names": names} for source_name, names in scenarios.items()]
    groups.append({"label": "Laws, with a flock at random", "kind": "law", "names": dict.fromkeys(law_names(), "")})
    if first["kind"] == "file":
        groups.append({"label": "File", "kind": "file", "names": {first["name"]: ""}})
    data = json.dumps({"first": first, "groups": groups}).replace("<", "\\u003c")
    scripts = script() + "".join(map(_text, _SCRIPTS))
    page_style = style() + _text("explore.css")
    template = templates().get_template("explore/explore.html.j2")
    return template.render(style=page_style, data=data, scripts=scripts, nonce=nonce)
