"""Which tests to ask first of a file: its own, then those of what imports it, nearest first."""

from __future__ import annotations

import re
from functools import cache
from pathlib import Path

LAST = ("tests/properties", "tests/reference")  # asked of every file, at the end
_IMPORT = re.compile(r"^\s*from (flockana[\w.]*) import (\([^)]*\)|.+)$|^\s*import (flockana[\w.]+)", re.MULTILINE)
_DEFINED = re.compile(r"^(?:def|class) (\w+)|^(\w+)(?:: [^=\n]+)? = ", re.MULTILINE)


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
        self.users: dict[str, list[str]] = {}
        for path, text in self.texts.items():
            for used in self._used(path, text):
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
        return {one for one in used if one in self.texts and one != path}

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
        found, seen, reached = list[str](), {path}, [path]
        while reached:
            asked = [test for one in reached for test in self.own(one)]
            users = sorted({user for one in reached for user in self.users.get(one, ())} - seen)
            asked += [user for user in users if Path(user).name.startswith("test_")]
            examples = [one for one in reached if one.startswith("flockana/") and ">>>" in self.texts[one]]
            found += [one for one in (*asked, *examples) if one not in found]
            seen |= set(users)
            reached = [user for user in users if user.startswith("flockana/")]
        room = Path(path).parts[1]
        near = [one for one in found if one.startswith((f"tests/{room}/", f"flockana/{room}/"))]
        last = sorted(one for one in self.texts if one.startswith(LAST) and "/test_" in one)
        first = [one for one in found if one in self.own(path) or one == path]
        far = [one for one in found if one not in near]
        return list(dict.fromkeys([*first, *near, *far[:6], *last, *far]))
