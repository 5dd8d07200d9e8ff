"""Which tests to ask first of a file: its own, then those of what imports it or names its theorem, nearest first."""

from __future__ import annotations

import json
import re
from functools import cache
from itertools import chain
from pathlib import Path

from .mutants import PACKAGES

LAST = ("tests/test_public_api", "tests/properties", "tests/reference")  # asked of every file
# tests of kernels that pass in seconds when these run as Python: asked first of their mutants, which compile slowly
INTERPRETED = tuple(
    f"tests/{name}.py"
    for name in (
        "kernels/test_scalars",
        "kernels/test_verlet",
        "kernels/test_paths",
        "kernels/test_sums",
        "kernels/test_sweep",
        "kernels/test_ranges",
        "kernels/test_dead_zone",
        "kernels/test_dead_zone_steps",
        "kernels/test_left_right",
        "kernels/test_rank",
        "kernels/test_tableaus",
        "kernels/test_zones",
        "measures/test_path_bounds",
        "lattice/test_crossings",
        "laws/test_minimal",
        "laws/test_directed",
        "environment/test_obstacles",
        "environment/test_zone_obstacles",
    )
)
_IMPORT = re.compile(r"^\s*from (flockana[\w.]*) import (\([^)]*\)|.+)$|^\s*import (flockana[\w.]+)", re.MULTILINE)
_LATER = re.compile(r'\benclosed_by\("\w+"(?:, "(\w+)")?\)')  # a module beside it that is loaded when asked for
_THEOREM = re.compile(r'\b(?:id=|erratum\(\s*)"([\w-]+)"')
_FIXED = "tests/adversarial/test_fixed.py"  # asks for every theorem that needs no run, by its id
_RUNS = "tests/adversarial/published_runs.json"  # what is asked of short runs, by scenario and by theorem
_OF_RUN = "tests/adversarial/test_catalogue.py::test_short_runs_say_what_was_published"
_DEFINED = re.compile(r"^(?:def|class) (\w+)|^(\w+)(?:: [^=\n]+)? = ", re.MULTILINE)


def _breadth(test: str) -> int:
    """0 for tests of the rooms that compute, 1 for others, 2 for those that run much at once."""
    room = Path(test).parts[1]
    wide = ("adversarial", "bad_input", "cli", "ensemble", "falsify", "report")
    return 0 if room in PACKAGES or _FIXED in test or _OF_RUN in test else 2 if room in wide else 1


class Nearby:
    """The import graph of a project, read from its text.

    Parameters
    ----------
    root : Path
        The project.
    """

    def __init__(self, root: Path) -> None:
        self.root = root
        sources = sorted(path for top in ("flockana", "tests") for path in (root / top).rglob("*.py"))
        self.texts = {str(path.relative_to(root)): path.read_text("utf-8") for path in sources}
        self.homes = self._homes()
        theorems = ((path, text) for path, text in self.texts.items() if path.startswith("flockana/theorems/"))
        self.ids = {name: path for path, text in theorems for name in _THEOREM.findall(text)}
        runs = root / _RUNS
        self.runs: dict[str, dict[str, object]] = json.loads(runs.read_text("utf-8")) if runs.exists() else {}
        self.users: dict[str, list[str]] = {}
        for path, text in self.texts.items():
            for used in self._used(path, text) | self._named(text if path.startswith("tests/") else ""):
                self.users.setdefault(used, []).append(path)

    def _homes(self) -> dict[str, list[str]]:
        """Where in the package a name is defined."""
        homes: dict[str, list[str]] = {}
        for path, text in self.texts.items():
            if path.startswith("flockana/"):
                for function, constant in _DEFINED.findall(text):
                    homes.setdefault(function or constant, []).append(path)
        return homes

    def _used(self, path: str, text: str) -> set[str]:
        """The files of the package that a file names; a package's names are looked up where they are defined."""
        used = set()
        for module, things, plain in _IMPORT.findall(text):
            file = (module or plain).replace(".", "/")
            used.add(f"{file}.py")
            for thing in re.findall(r"\w+", things):
                inside = [home for home in self.homes.get(thing, ()) if home.startswith(f"{file}/")]
                used |= {f"{file}/{thing}.py", *(inside if f"{file}.py" not in self.texts else ())}
        used |= {str(Path(path).with_name(f"{name or 'enclosed'}.py")) for name in _LATER.findall(text)}
        return {one for one in used if one in self.texts and one != path}

    def _named(self, text: str) -> set[str]:
        """The theorems that a test asks for by their ids."""
        return {self.ids[name] for name in re.findall(r'"([\w-]+)"', text) if name in self.ids}

    def _fixed(self, paths: list[str]) -> list[str]:
        """The theorems among some files that need no run."""
        return [name for name, path in self.ids.items() if path in paths and f'"{name}":' in self.texts.get(_FIXED, "")]

    def _short_runs(self, paths: list[str]) -> list[str]:
        """Short runs of which the theorems among some files are asked, three of each theorem."""
        mine = [name for name, path in self.ids.items() if path in paths]
        runs = [[run for run, said in self.runs.items() if name in said][:3] for name in mine]
        return list(dict.fromkeys(chain(*runs)))

    def own(self, path: str) -> list[str]:
        """The tests that are named for a file."""
        room, name = Path(path).parent.relative_to("flockana"), Path(path).stem
        inside = sorted(one for one in self.texts if one.startswith(f"tests/{room}/{name}/test_"))
        return [one for one in (f"tests/{room}/test_{name}.py",) if one in self.texts] + inside

    @cache  # noqa: B019  one of them lives as long as the command
    def order(self, path: str) -> list[str]:
        """The files to give to pytest, in order: the nearest tests, the examples of the docstrings, those for all.

        Parameters
        ----------
        path : str
            A file of the package.
        """
        levels, seen, reached = list[list[str]](), {path}, [path]
        room = f"/{Path(path).parts[1]}/"
        while reached:
            users = sorted({user for one in reached for user in self.users.get(one, ())} - seen)
            asked = [test for one in reached for test in self.own(one)]
            asked += [one for one in reached if ">>>" in self.texts[one]]
            asked += [user for user in users if Path(user).name.startswith("test_") and user != _FIXED]
            asked += [f"{_FIXED}::test_what_is_printed_and_what_is_true[{name}]" for name in self._fixed(reached)]
            asked += [f"{_OF_RUN}[{name}]" for name in self._short_runs(reached)]
            levels.append(sorted(asked, key=lambda one: (one not in self.own(path), room not in one, _breadth(one))))
            seen |= set(users)
            reached = [user for user in users if user.startswith("flockana/")]
        near, far = list(chain(*levels[:2])), list(chain(*levels[2:]))
        last = [one for start in LAST for one in sorted(self.texts) if one.startswith(start) and "/test_" in one]
        return list(dict.fromkeys([*near, *far[:6], *last, *far]))
