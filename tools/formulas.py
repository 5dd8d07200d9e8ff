"""Write the generated files of the package: kernels and enclosures of the pair laws (`python -m tools.formulas`)."""

from __future__ import annotations

from pathlib import Path

from flockana.symbolic.sources import sources

if __name__ == "__main__":
    for path, text in sources().items():
        (Path(__file__).parents[1] / "flockana" / path).write_text(text, "utf-8")
