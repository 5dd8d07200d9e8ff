"""The run of a page as a file."""

import tempfile
from pathlib import Path
from typing import Any

from flockana.dynamics.simulate import simulate
from flockana.explore.case import Case


def run_file(asked: Any) -> bytes:
    """Return the run of a case as netCDF.

    Examples
    --------
    >>> run_file({"kind": "scenario", "name": "hexagon", "duration": 0.1})[1:4]
    b'HDF'
    """
    parts = Case.of(asked).parts
    run = parts.recorded or simulate(parts.law, parts.q0, parts.p0, parts.t_span, **parts.options)
    with tempfile.TemporaryDirectory(prefix="flockana-") as folder:
        return run.save(Path(folder) / "run.nc").read_bytes()
