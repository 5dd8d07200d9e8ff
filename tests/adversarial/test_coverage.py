"""Every theorem is attacked, and oracles call none of the library's formulas."""

import ast
from importlib import import_module
from pathlib import Path

from flockana import theorems

HERE = Path(__file__).parent


def test_every_theorem_has_planted_truths():
    modules = [import_module(f"tests.adversarial.{path.stem}") for path in HERE.glob("test_*.py")]
    assert {name for module in modules for name in getattr(module, "THEOREMS", ())} == set(theorems())


def test_the_truth_is_written_from_the_mathematics():
    tree = ast.parse((HERE / "truth.py").read_text(encoding="utf-8"))
    modules = {n.module or "" for n in ast.walk(tree) if isinstance(n, ast.ImportFrom)}
    modules |= {alias.name for n in ast.walk(tree) if isinstance(n, ast.Import) for alias in n.names}
    assert not {name for name in modules if name.split(".")[0] == "flockana"}
