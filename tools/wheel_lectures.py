"""Hook of hatch that puts the course into the wheel: lectures with checks, without solutions and lecturer's pages."""

from __future__ import annotations

import re
import shutil
import tempfile
from pathlib import Path
from typing import Any

try:
    from hatchling.builders.hooks.plugin.interface import BuildHookInterface as Hook
except ImportError:  # only a build has it
    Hook = object

_HOME = "flockana/course/lectures"
_KEPT = ("notebooks/*.toml", "notebooks/*.csv", "notebooks/own_law/*.py", "proofs/__init__.py", "proofs/proof.py")


def without_solutions(text: str) -> str:
    """Return a lecture's source without the cells that are tagged solution or facts."""
    cells = re.split(r"(?m)^(?=# %%)", text)
    return "".join(cell for cell in cells if not re.match(r'# %%.*tags=\["(?:solution|facts)"\]', cell))


def write_shipped(root: Path, folder: Path) -> list[Path]:
    """Write what the wheel holds of the course into a folder, and return the files."""
    for source in [each for pattern in _KEPT for each in root.glob(pattern)]:
        path = folder / source.relative_to(root / "notebooks" if "notebooks" in source.parts else root)
        path.parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(source, path)
    for source in (root / "notebooks").glob("*.py"):
        text = without_solutions(source.read_text(encoding="utf-8"))
        (folder / source.name).write_text(text, encoding="utf-8")
    return sorted(path for path in folder.rglob("*") if path.is_file())


class CustomBuildHook(Hook):
    """Hook of a wheel's build."""

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Add the files of the course; an editable install reads the checkout's."""
        self.folder = Path(tempfile.mkdtemp())
        for path in write_shipped(Path(self.root), self.folder) if version != "editable" else ():
            build_data["force_include"][str(path)] = f"{_HOME}/{path.relative_to(self.folder).as_posix()}"

    def finalize(self, version: str, build_data: dict[str, Any], artifact_path: str) -> None:
        """Remove what was written for the build."""
        shutil.rmtree(self.folder, ignore_errors=True)
