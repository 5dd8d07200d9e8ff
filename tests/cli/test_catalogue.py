"""The catalogues are lists: what draws, derives, solves and compiles stays where it is."""

from __future__ import annotations

import subprocess
import sys

import pytest

from flockana.scenarios import scenario, scenarios
from flockana.theorems import theorems

HEAVY = (
    "numba",
    "llvmlite",
    "scipy",
    "sympy",
    "casadi",
    "matplotlib",
    "PIL",
    "xarray",
    "networkx",
    "control",
    "jinja2",
)
PROGRAM = """
import sys
from flockana.cli.main import main
try:
    main([sys.argv[1]])
except SystemExit as end:
    print(end.code, [name for name in sys.argv[2:] if name in sys.modules], file=sys.stderr)
"""


@pytest.mark.parametrize(("command", "names"), [("scenarios", scenarios), ("theorems", theorems)])
def test_a_list_names_all_and_loads_nothing_heavy(command, names):
    run = subprocess.run([sys.executable, "-c", PROGRAM, command, *HEAVY], capture_output=True, text=True, check=True)
    assert run.stderr.split("\n")[-2] == "0 []"
    assert all(f" {name} " in run.stdout for name in names())


def test_what_a_list_says_of_a_start_is_so():
    for name in scenarios():
        item = scenario(name)
        assert item.shape == item.q0.shape == item.p0.shape == scenario(name, seed=1).shape, name
