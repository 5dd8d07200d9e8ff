"""Execute every lecture as it is delivered: written by `flockana course` to a clean folder, and run there.

`python tools/run_notebooks.py [--wheel] [--student | --solutions] [NUMBER...]` runs those whose names begin so; by
default all, of both versions, two at a time. With `--wheel` the students' version runs (a wheel has no solutions), in
the environment of `make wheel`, to which the wheel's extra is added, with no checkout on the path. A cell that fails or
warns, and a check that does not say what it should, fail the run: "right" with our solutions, "not answered" without. A
lecture that takes over 90 s of processor time, its worker processes included, is pointed out: that does not depend on
what else runs.
"""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

_TIMEOUT = 600  # seconds for one cell, and for a kernel to start
_LONGEST = 90.0  # seconds of processor time for a lecture
_CLOCK = "import os\n\nprint(sum(os.times()[:4]))"  # of the kernel and of the processes that it has waited for
_SAYS = {"student": "not answered", "solutions": "right"}


def shown(cell: Any) -> str:
    """What a cell put out, as text."""
    return "".join(out.get("text", out.get("data", {}).get("text/plain", "")) for out in cell.get("outputs", ()))


def execute(path: Path, version: str) -> tuple[str, list[str], float, float]:
    """Run one notebook where it lies; return its name, its faults, the seconds it took and those of the processor."""
    import nbformat
    from nbclient import NotebookClient

    from flockana.jit import COMPILES

    started, used, book = time.perf_counter(), 0.0, nbformat.read(path, as_version=4)
    book.cells.append(nbformat.v4.new_code_cell(_CLOCK))
    try:
        place = {"metadata": {"path": str(path.parent)}}
        NotebookClient(book, timeout=_TIMEOUT, startup_timeout=_TIMEOUT, resources=place).execute()
        used = float(shown(book.cells[-1]))
        checks = [cell for cell in book.cells if "check" in cell.metadata.get("tags", ())]
        outputs = [out.text for cell in book.cells for out in cell.get("outputs", ()) if out.get("name") == "stderr"]
        announced = re.compile(re.escape(COMPILES).replace(r"\{\}", r"\w+"))  # what the first run on a machine says
        warned = [text for text in outputs if announced.sub("", text).strip()]
        faults = [f"a check says {shown(c)!r}:\n{c.source}" for c in checks if _SAYS[version] not in shown(c)]
        faults += [f"no checks: {path.name}"] * (not checks) + [f"a warning: {text}" for text in warned]
    except Exception as error:  # a cell that fails or takes too long, a kernel that dies or does not start
        faults = [f"{type(error).__name__}: {error}"]
    return f"{path.parent.name}/{path.name}", faults, time.perf_counter() - started, used


def run(versions: list[str], numbers: list[str]) -> int:
    """Write the notebooks and run them; return the exit status."""
    failed = found = 0
    with tempfile.TemporaryDirectory() as folder, ThreadPoolExecutor(2) as pool:
        for version in versions:
            target, option = Path(folder, version), ["--solutions"] * (version == "solutions")
            subprocess.run(
                [sys.executable, "-P", "-m", "flockana", "course", str(target), *option],
                check=True,
                stdout=subprocess.DEVNULL,
                cwd=folder,
            )
            chosen = [p for p in sorted(target.glob("*.ipynb")) if not numbers or p.name.startswith(tuple(numbers))]
            for name, faults, seconds, used in pool.map(lambda path, v=version: execute(path, v), chosen):
                found, failed = found + 1, failed + bool(faults)
                times = f"{seconds:.1f} s, of the processor {used:.1f} s{', too long' * (used > _LONGEST)}"
                sys.stdout.write(f"{name}: {'FAILED' if faults else 'ok'} ({times})\n")
                sys.stdout.writelines(f"{fault}\n" for fault in faults)
                sys.stdout.flush()
    if not found:
        sys.stdout.write("no notebooks found\n")
    return 1 if failed or not found else 0


def run_from_wheel(arguments: list[str]) -> int:
    """Run this file where the wheel is installed, away from the checkout."""
    root = Path(__file__).resolve().parent.parent
    python, wheel = str(root / ".venv-wheel/bin/python"), next((root / "dist").glob("flockana-*.whl"))
    pip = [python, "-m", "pip", "--quiet", "--disable-pip-version-check"]
    subprocess.run([*pip, "install", f"{wheel}[course]", "nbclient>=0.10"], check=True)
    with tempfile.TemporaryDirectory() as folder:
        alone = shutil.copy(__file__, folder)
        plain = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
        return subprocess.run([python, alone, *arguments], cwd=folder, env=plain, check=False).returncode


def main(arguments: list[str]) -> int:
    """Run them; return the exit status."""
    if "--wheel" in arguments:
        return run_from_wheel([each for each in arguments if each != "--wheel"] + ["--student"])
    numbers = [each for each in arguments if not each.startswith("--")]
    versions = [version for version in _SAYS if f"--{version}" in arguments] or list(_SAYS)
    return run(versions, numbers)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
