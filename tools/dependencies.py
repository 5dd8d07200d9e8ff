"""Lower bounds of the dependencies as constraints for pip: `python tools/dependencies.py > lowest.txt`.

`>=x` becomes `==x` for all that flockana, its tests and its lectures need. What these need in their turn is left to
pip, which takes the newest: so it is with a user whose lock file is old.
"""

from __future__ import annotations

import re
import sys
import tomllib
from collections.abc import Iterable
from pathlib import Path

PROJECT = Path(__file__).resolve().parent.parent / "pyproject.toml"
EXTRAS = ("test", "cluster", "proofs", "course")  # what tests and lectures run on; linters are no part of it
_BOUND = re.compile(r"^([A-Za-z0-9._-]+)>=([0-9.]+)(?:,<[0-9.]+)?$")


def pinned(requirements: Iterable[str]) -> list[str]:
    """Each requirement ``name>=x`` as ``name==x``.

    >>> pinned(["numpy>=2.0"])
    ['numpy==2.0']
    """
    found = []
    for text in requirements:
        match = _BOUND.match(text)
        if match is None:
            wanted = "NAME>=VERSION or NAME>=VERSION,<VERSION"
            raise ValueError(f"{text!r} in pyproject.toml: expected {wanted}, so that the bound can be tested")
        found.append("{}=={}".format(*match.groups()))
    return found


def lowest(path: Path = PROJECT) -> list[str]:
    """The constraints that hold every direct dependency at its lower bound."""
    project = tomllib.loads(path.read_text())["project"]
    extras = project["optional-dependencies"]
    return pinned(dict.fromkeys([*project["dependencies"], *(one for name in EXTRAS for one in extras[name])]))


if __name__ == "__main__":
    sys.stdout.write("".join(f"{line}\n" for line in lowest()))
