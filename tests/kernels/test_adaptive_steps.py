"""The integrator is ordinary source: interpreted it makes the same run as compiled."""

import json
import os
import subprocess
import sys

import numpy as np

PROGRAM = """
import json
import flockana as fl

def made(how):
    q0, p0 = [[0.0, 0.0], [30.0, 5.0], [33.0, 0.0]], [[9.0, 0.0], [0.0, 0.0], [0.0, 0.1]]
    run = fl.simulate(fl.Algorithm1(), q0, p0, (0.0, 4.0), t_eval=[1.0, 4.0], **how)
    return [run.status, run.stats["steps"], run.stats["redone"], run.q.ravel().tolist()]

found = [made(how) for how in ({"rtol": 1e-4}, {"method": "RK4", "dt": 0.5})]
"""


def test_the_integrator_makes_the_same_run_without_a_compiler():
    exec(PROGRAM, here := {})
    command = [sys.executable, "-c", PROGRAM + "print(json.dumps(found))"]
    other = subprocess.run(command, env=os.environ | {"NUMBA_DISABLE_JIT": "1"}, capture_output=True, check=True)
    for (*ours, places), (*theirs, there) in zip(here["found"], json.loads(other.stdout), strict=True):
        assert ours == theirs
        assert ours[2] > 0
        np.testing.assert_allclose(there, places, atol=1e-9)
