"""Internal links of built pages: each must lead to a file, and to an element of it where it names one."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit


class _Page(HTMLParser):
    """Ids, and addresses that are pointed to."""

    def __init__(self) -> None:
        super().__init__()
        self.ids, self.targets = set[str](), list[str]()

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        for name, value in attrs:
            if value is None:
                continue
            if name == "id" or (name == "name" and tag == "a"):
                self.ids.add(value)
            elif name in ("href", "src"):
                self.targets.append(value)


@cache
def _read(file: Path) -> _Page:
    page = _Page()
    page.feed(file.read_text(encoding="utf-8"))
    return page


def dead(folder: Path) -> Iterator[str]:
    """Links of the pages in a folder that lead nowhere, one line each."""
    pages = (file for file in folder.rglob("*.html") if "_static" not in file.relative_to(folder).parts)  # templates
    for file in sorted(pages):
        for target in _read(file).targets:
            parts = urlsplit(target)
            if parts.scheme or parts.netloc or target in ("", "#"):
                continue
            goal = (file.parent / unquote(parts.path)).resolve() if parts.path else file
            goal = goal / "index.html" if goal.is_dir() else goal
            names = {parts.fragment, unquote(parts.fragment)}  # a browser tries both
            if not goal.is_file():
                yield f"{file.relative_to(folder)}: {target} is no file"
            elif parts.fragment and goal.suffix == ".html" and not names & _read(goal).ids:
                yield f"{file.relative_to(folder)}: {target} names no element"
