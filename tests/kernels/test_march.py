"""The integrator is ordinary source: interpreted it makes the same run as compiled."""

import json
import os
import subprocess
import sys

import numpy as np
import pytest

PROGRAM = """
import json, sys
import flockana as fl
q0, p0 = [[0.0, 0.0], [30.0, 5.0], [33.0, 0.0]], [[9.0, 0.0], [0.0, 0.0], [0.0, 0.1]]
run = fl.simulate(fl.Algorithm1(), q0, p0, (0.0, 4.0), t_eval=[1.0, 4.0], **json.loads(sys.argv[1]))
print(json.dumps([run.status, run.stats["steps"], run.stats["redone"], run.q.ravel().tolist()]))
"""


@pytest.mark.parametrize("how", [{"rtol": 1e-4}, {"method": "RK4", "dt": 0.5}], ids=str)
def test_the_integrator_makes_the_same_run_without_a_compiler(how):
    (*ours, places), (*theirs, there) = (
        json.loads(
            subprocess.run(
                [sys.executable, "-c", PROGRAM, json.dumps(how)],
                env=os.environ | {"NUMBA_DISABLE_JIT": off},
                capture_output=True,
                check=True,
            ).stdout
        )
        for off in ("0", "1")
    )
    assert ours == theirs
    assert ours[2] > 0
    np.testing.assert_allclose(there, places, atol=1e-9)
