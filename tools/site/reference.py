"""The API reference: every public name of the package and of its public rooms, one page a subject."""

from __future__ import annotations

import importlib
import inspect
from pathlib import Path

import flockana
from tools.site.words import contents, plain, table

ROOMS = ("plots", "symbolic", "stability", "lattice", "equilibria")
_TITLES = {
    "base": "Names for everybody",
    "certified": "Basins and tubes",
    "dynamics": "Runs",
    "ensemble": "Many runs",
    "environment": "γ-agents, obstacles, aliens",
    "equilibria": "Equilibria",
    "explore": "Explorer",
    "falsify": "Counterexamples",
    "interactions": "Pair laws and gains",
    "lammps": "LAMMPS",
    "laws": "Laws",
    "measures": "Measures",
    "player": "Players",
    "plots": "Films",
    "recorded": "Recorded flocks",
    "scenarios": "Scenarios and flocks",
    "stability": "Linear stability",
    "theorems": "Theorems and verdicts",
}


def pages() -> dict[str, list[tuple[str, str]]]:
    """Title of each page, and (module, name) of what stands on it."""
    found: dict[str, list[tuple[str, str]]] = {}
    for name in flockana.__all__:
        item = getattr(flockana, name)
        if inspect.ismodule(item) or not hasattr(item, "__module__"):
            continue
        room = item.__module__.split(".")[1]
        title = _TITLES.get(room, f"flockana.{room}")
        found.setdefault(title, []).append(("flockana", name))
    for room in ROOMS:
        module = importlib.import_module(f"flockana.{room}")
        found[f"flockana.{room}"] = [(module.__name__, name) for name in module.__all__]
    for module in (item for item in map(flockana.__dict__.get, flockana.__all__) if inspect.ismodule(item)):
        if module.__name__.split(".")[-1] not in ROOMS:
            own = [k for k, v in vars(module).items() if _public(k) and getattr(v, "__module__", "") == module.__name__]
            found[module.__name__] = [(module.__name__, name) for name in own]
    return found


def _public(name: str) -> bool:
    return not name.startswith("_")


def directive(module: str, name: str) -> str:
    """What Sphinx is told to print of one name."""
    item = getattr(importlib.import_module(module), name)
    if inspect.ismodule(item):
        names = [k for k, v in vars(item).items() if _public(k) and getattr(v, "__module__", "") == item.__name__]
        inner = "\n\n".join(directive(item.__name__, one) for one in names if not inspect.ismodule(getattr(item, one)))
        return f".. rubric:: {item.__name__}\n\n{inner}"
    if inspect.isclass(item):
        twice = module != "flockana" and getattr(flockana, name, None) is item  # the index leads to the first
        return f".. autoclass:: {module}.{name}\n   :members:" + ("\n   :no-index:" if twice else "")
    if callable(item):
        return f".. autofunction:: {module}.{name}"
    return f".. autodata:: {module}.{name}\n   :no-value:"


def write(folder: Path) -> None:
    """Write the pages and their index."""
    folder.mkdir(parents=True, exist_ok=True)
    names = []
    for title, entries in pages().items():
        file = "".join(c if c.isascii() and c.isalnum() else "-" for c in title.lower()).strip("-")
        names.append(file)
        body = "\n\n".join(directive(*entry) for entry in entries)
        (folder / f"{file}.rst").write_text(f"{title}\n{'=' * len(title)}\n\n{body}\n", encoding="utf-8")
    opening = (
        "# API reference\n\nEvery public name with a sentence, by subject. `flockana.NAME` is imported when it is "
        "first used. Arrays are float64 of shape (n, m); lengths and times are in your own units. "
        "[Names by task](../../by-task.md) is shorter."
    )
    sections = [
        f"## [{title}]({file}.rst)\n\n" + table(("name", "what it is"), map(_row, entries))
        for file, (title, entries) in zip(names, pages().items(), strict=True)
    ]
    listed = contents(names).replace(":maxdepth: 1", ":hidden:")
    (folder / "index.md").write_text("\n\n".join([opening, *sections, listed]) + "\n", encoding="utf-8")


def _row(entry: tuple[str, str]) -> tuple[str, str]:
    """Return a name and the first sentence of its docstring."""
    item = getattr(importlib.import_module(entry[0]), entry[1])
    first = (inspect.getdoc(item) or "").partition("\n\n")[0].replace("\n", " ")
    return f"{{py:obj}}`{entry[1]} <{'.'.join(entry)}>`", plain(first.replace("`", "")) or "—"
