"""The explorer's page, with its scripts and styles in it."""

from __future__ import annotations

import json
from functools import cache
from importlib.resources import files
from typing import Any

from flockana import player
from flockana.explore.starts import law_names
from flockana.scenarios import scenario, scenarios

_SCRIPTS = ("form.js", "handles.js", "answers.js", "explore.js")


@cache
def _text(name: str) -> str:
    return (files("flockana.explore") / name).read_text(encoding="utf-8")


def page(first: dict[str, Any], nonce: str) -> str:
    """The page."""
    kinds = {"scenario": {name: _titles()[name] for name in scenarios()}, "law": {name: name for name in law_names()}}
    if first["kind"] == "file":
        kinds["file"] = {first["name"]: first["name"]}
    data = json.dumps({"first": first, "kinds": kinds}).replace("<", "\\u003c")
    scripts = player.script() + "".join(map(_text, _SCRIPTS))
    return (
        _text("explore.html")
        .replace("/*STYLE*/", player.style() + _text("explore.css"))
        .replace("/*DATA*/", data)
        .replace("/*SCRIPT*/", scripts)
        .replace("NONCE", nonce)
    )


@cache
def _titles() -> dict[str, str]:
    return {name: scenario(name).title for name in scenarios()}
