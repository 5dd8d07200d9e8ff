"""Write the documentation site: `python -m tools.site`; exit status 0, or 1 with what is wrong.

It carries the report of `make verify` (report/), or writes one if there is none; `--report FOLDER` takes another.
`--draft` executes no page, runs no scenario and makes no report, for who writes text; `--external` checks links to
other sites too, which needs the network.
"""

from __future__ import annotations

import argparse
import os
import shutil
import subprocess
import sys
import time
from pathlib import Path

from tools.site import lectures, links, mathematics, proofs, reference, scenarios, slides, theorems, verdicts
from tools.site.cache import ROOT

SOURCE, SITE = ROOT / "docs", ROOT / "site"
GENERATED = SOURCE / "generated"
_STARTED = time.monotonic()


def generate(report: Path | None) -> None:
    """Write docs/generated anew; without a report, a draft without pictures of runs."""
    shutil.rmtree(GENERATED, ignore_errors=True)
    extra, found = GENERATED / "extra", verdicts.measured(None if report is None else report / "verdicts.json")
    full = {"images": report is not None, "report": report is not None}
    extra.mkdir(parents=True)
    if report is not None:
        (extra / "report").mkdir()
        for name in ("index.html", "verdicts.json"):
            shutil.copy(report / name, extra / "report")
    _tell("pages of scenarios, with their runs")
    scenarios.write(GENERATED / "scenarios", extra, found, **full)
    (GENERATED / "first.md").write_text(scenarios.first(images=report is not None), encoding="utf-8")
    _tell("pages of theorems, lectures and names")
    theorems.write(GENERATED / "theorems", found, **full)
    lectures.write(GENERATED / "lectures")
    reference.write(GENERATED / "reference")
    (GENERATED / "mathematics.md").write_text(mathematics.page(), encoding="utf-8")


def _tell(text: str) -> None:
    """Print what comes next, with the time since the start."""
    sys.stdout.write(f"{time.monotonic() - _STARTED:6.0f} s  {text}\n")
    sys.stdout.flush()


def build(builder: str, folder: Path, *, draft: bool = False) -> int:
    """Run Sphinx with warnings as errors; return its exit status."""
    # kernels import the checkout: lecture 11 has a proof
    environment = os.environ | {"PYTHONPATH": os.pathsep.join([str(ROOT), *filter(None, [os.getenv("PYTHONPATH")])])}
    options = ["-D", "nb_execution_mode=off"] if draft else []
    options += ["-W", "--keep-going", "-d", str(SITE / "cache" / "doctrees")]
    command = [sys.executable, "-m", "sphinx", "-b", builder, *options, str(SOURCE), str(folder)]
    return subprocess.call(command, env=environment)


def main(arguments: list[str]) -> int:
    """Generate, build and check; return the exit status."""
    parser = argparse.ArgumentParser(prog="python -m tools.site", description=(__doc__ or "").partition(":")[0])
    parser.add_argument("--report", type=Path, default=None, metavar="FOLDER")
    parser.add_argument("--draft", action="store_true")
    parser.add_argument("--external", action="store_true")
    chosen = parser.parse_args(arguments)
    _tell("proofs whose code has changed")
    false = [name for name, found in proofs.outcomes().items() if found["status"] != "proved"]
    if false:
        sys.stdout.write(f"not proved: {', '.join(false)}; run python -m proofs {' '.join(false)}\n")
        return 1
    generate(None if chosen.draft else chosen.report or verdicts.report())
    _tell("the site, with its lectures and how-tos executed: minutes" if not chosen.draft else "the site")
    html = SITE / "html"
    shutil.rmtree(html, ignore_errors=True)  # with it what an older build left
    if build("html", html, draft=chosen.draft):
        return 1
    slides.write(html / "slides", None if chosen.draft else SITE / "jupyter_execute" / "generated" / "lectures")
    lost = list(links.dead(html))
    sys.stdout.write("".join(f"{line}\n" for line in lost))
    if chosen.external and build("linkcheck", SITE / "linkcheck"):
        return 1
    sys.stdout.write(f"{html / 'index.html'}\n")
    return 1 if lost else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
