"""The α-law's own text for a GPU (tests/on_a_gpu.py): PTX without a device, and sums in the simulator."""

import json
import os
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

import numpy as np
import pytest

from tests.on_a_gpu import flock

PROGRAM = Path(__file__).with_name("on_a_gpu.py")


def results_of(what, **environment):
    """Return what the program prints, as data."""
    command, surroundings = [sys.executable, str(PROGRAM), what], os.environ | environment
    return json.loads(subprocess.run(command, env=surroundings, capture_output=True, text=True, check=True).stdout)


def test_sums_over_all_neighbours_of_each_agent_are_those_of_the_engine():
    law, q, p, _, _ = flock()
    simulated = results_of("sums", NUMBA_ENABLE_CUDASIM="1")
    u, dissipation = law.forces(q, p, stiffness=2.0, damping=3.0)
    np.testing.assert_allclose(simulated["u"], u, rtol=0.0, atol=1e-13 * np.abs(u).max())
    assert simulated["dissipation"] == pytest.approx(dissipation, rel=1e-13)


@pytest.mark.skipif(find_spec("numba_cuda") is None, reason="needs flockana[gpu]; .ci/run installs it")
def test_scalar_functions_and_the_sum_compile_to_ptx_that_allocates_and_raises_nothing():
    texts = results_of("ptx")
    functions = {f"{name}_alpha" for name in ("norm", "stress", "phi", "adjacency", "psi")}
    assert set(texts) == {*functions, "phi_alpha_slope", "sums"}
    assert ".entry" in texts["sums"]
    assert [name for name, text in texts.items() if ".extern" in text or "trap" in text] == []
