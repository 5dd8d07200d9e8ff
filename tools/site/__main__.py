"""Write the documentation site: `python -m tools.site`; exit status 0, or 1 with what is wrong.

`--verdicts FILE` takes measured verdicts from a report's ``verdicts.json`` (by default report/verdicts.json, if there
is one); `--draft` executes no page and draws no picture of a run, for who writes text; `--external` checks links to
other sites too, which needs the network.
"""

from __future__ import annotations

import argparse
import os
import shutil
import subprocess
import sys
from pathlib import Path

from tools.site import lectures, links, mathematics, reference, theorems
from tools.site.cache import ROOT

SOURCE, SITE = ROOT / "docs", ROOT / "site"
GENERATED = SOURCE / "generated"


def generate(verdicts: Path | None, *, draft: bool = False) -> None:
    """Write docs/generated anew; a draft without pictures of runs."""
    shutil.rmtree(GENERATED, ignore_errors=True)
    GENERATED.mkdir()
    theorems.write(GENERATED / "theorems", theorems.measured(verdicts), images=not draft)
    lectures.write(GENERATED / "lectures")
    reference.write(GENERATED / "reference")
    (GENERATED / "mathematics.md").write_text(mathematics.page(), encoding="utf-8")


def build(builder: str, folder: Path, *, draft: bool = False) -> int:
    """Run Sphinx with warnings as errors; return its exit status."""
    # kernels import the checkout: lecture 11 has a proof
    environment = os.environ | {"PYTHONPATH": os.pathsep.join([str(ROOT), *filter(None, [os.getenv("PYTHONPATH")])])}
    options = ["-D", "nb_execution_mode=off"] if draft else []
    options += ["-W", "--keep-going", "-q", "-d", str(SITE / "cache" / "doctrees")]
    command = [sys.executable, "-m", "sphinx", "-b", builder, *options, str(SOURCE), str(folder)]
    return subprocess.call(command, env=environment)


def main(arguments: list[str]) -> int:
    """Generate, build and check; return the exit status."""
    parser = argparse.ArgumentParser(prog="python -m tools.site", description=(__doc__ or "").partition(":")[0])
    parser.add_argument("--verdicts", type=Path, default=None, metavar="FILE")
    parser.add_argument("--draft", action="store_true")
    parser.add_argument("--external", action="store_true")
    chosen = parser.parse_args(arguments)
    kept = ROOT / "report" / "verdicts.json"
    generate(chosen.verdicts or (kept if kept.exists() else None), draft=chosen.draft)
    html = SITE / "html"
    if build("html", html, draft=chosen.draft):
        return 1
    lost = list(links.dead(html))
    sys.stdout.write("".join(f"{line}\n" for line in lost))
    if chosen.external and build("linkcheck", SITE / "linkcheck"):
        return 1
    sys.stdout.write(f"{html / 'index.html'}\n")
    return 1 if lost else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
