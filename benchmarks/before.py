"""Fig. 10's run against this package's own code of before its kernels and integrators were compiled as a whole.

That code comes from the repository's history and runs in a process of its own on the same core, in turns with today's.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tarfile
import tempfile
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.precision import FINEST, SAMPLES, TOLERANCES, faster_at_equal_error, run, way_off
from benchmarks.rows import Asked, Found, Row
from benchmarks.timing import seconds_of
from flockana.scenarios import scenario

STUDY = "Fig. 10 against the code of before"
COMMIT = "2917ea8"  # the last one whose runs were stepped by scipy, over pairs in scattered order
MISSING = f"no commit {COMMIT} here: the comparison with the code of before is left out"
_RUN = f"""
import json, os, sys, time
import flockana
import numpy as np
from flockana import simulate
from flockana.scenarios import scenario
assert os.path.samefile(os.path.dirname(os.path.dirname(flockana.__file__)), "."), flockana.__file__
case = scenario("paper-flocking")
times = np.linspace(*case.t_span, {SAMPLES})
for line in sys.stdin:
    began = time.process_time()
    made = simulate(case.law, case.q0, case.p0, case.t_span, rtol=float(line), t_eval=times)
    print(json.dumps([time.process_time() - began, made.status, made.q.tolist()]), flush=True)
"""


def study(*, quick: bool) -> Found:
    """Both at nine tolerances by DOP853; every third of them where a few minutes must do."""
    root = Path(__file__).parents[1]
    found = subprocess.run(["git", "-C", str(root), "archive", COMMIT, "flockana"], capture_output=True, check=False)
    if found.returncode:
        return Found(notices=(MISSING,))
    with tempfile.TemporaryDirectory() as folder:
        with tarfile.open(fileobj=BytesIO(found.stdout)) as archive:
            archive.extractall(folder, filter="data")
        return Found(_rows(_measured(folder, TOLERANCES[:: 3 if quick else 1], rounds=2 if quick else 3)))


def _measured(folder: str, tolerances: tuple[float, ...], *, rounds: int) -> list[dict[str, Any]]:
    """Error and median CPU seconds of each code at each tolerance."""
    case = scenario("paper-flocking")
    reference, d = run(case, {"rtol": FINEST}).q, case.law.alpha.d
    around = os.environ | {"PYTHONPATH": folder, "NUMBA_CACHE_DIR": folder}
    with subprocess.Popen(
        [sys.executable, "-c", _RUN], cwd=folder, env=around, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
    ) as child:
        _before(child, tolerances[0])  # it compiles
        points = []
        for rtol in tolerances:
            turns = [
                (seconds_of(lambda rtol=rtol: run(case, {"rtol": rtol})), *_before(child, rtol)) for _ in range(rounds)
            ]
            ours, theirs = (float(np.median([turn[k] for turn in turns])) for k in range(2))
            errors = way_off(run(case, {"rtol": rtol}).q, reference, d), way_off(turns[0][2], reference, d)
            points += [
                {"method": "now", "rtol": rtol, "error": errors[0], "seconds": ours},
                {"method": "before", "rtol": rtol, "error": errors[1], "seconds": theirs},
            ]
        assert child.stdin is not None
        child.stdin.close()
    return points


def _before(child: Any, rtol: float) -> tuple[float, Any]:
    """CPU seconds and positions of a run by the code of before."""
    child.stdin.write(f"{rtol!r}\n")
    child.stdin.flush()
    seconds, status, q = json.loads(child.stdout.readline())
    assert status == "complete", status
    return seconds, np.array(q)


def _rows(points: list[dict[str, Any]]) -> list[Row]:
    rows = [
        Row(
            STUDY,
            f"{point['method']}: DOP853, rtol {point['rtol']:g}",
            150,
            1e3 * point["seconds"],
            "ms",
            note=f"farthest off by {point['error']:.2g} d",
        )
        for point in points
    ]
    taken, gains = faster_at_equal_error(points, "now", "before")
    name, worst = f"at equal error: times faster, median of {gains.size}", f"at least {gains.min():.3g}"
    value = 1e3 * float(np.median(taken))
    return [
        *rows,
        Row(STUDY, name, 150, value, "ms", f"commit {COMMIT}", float(np.median(gains)), Asked(">=", 10.0), worst),
    ]
