"""Import of a LAMMPS dump as a `Trajectory`, with its distance from a law."""

import os
from pathlib import Path
from typing import Any

import numpy as np

from flockana.base.errors import ArgumentError
from flockana.base.files import ensure_path
from flockana.base.value_checks import FloatArray, ensure_finite_scalar, ensure_positive
from flockana.dynamics.trajectory import Trajectory
from flockana.laws.discrete import ensure_law
from flockana.recorded.reading.lammps_dumps import read_dump


def read_lammps(
    path: str | os.PathLike[str], law: Any, *, start: float = 0.0, dt: float | None = None, m: int | None = None
) -> Trajectory:
    """Read a text dump of style custom (id, x ..., vx ..., and fx ... if it is there) as a run of a law.

    Places are xu ... where the dump has them, else x ..., which LAMMPS wraps into a periodic box and ix ... unwraps.

    What LAMMPS integrated need not be the law, and the run says so: ``extra["force_residual"]`` is the largest
    difference between LAMMPS's forces and the law's inputs at a sample, relative to the largest input of the law in the
    run (only if the dump has forces), and `Trajectory.energy_residual` how far the energy is from where the law's own
    dH/dt takes it, integrated by a spline through the samples. `verify` refuses a run whose inputs are not its law's.

    Parameters
    ----------
    law : Law
        The law to hold it against, such as the one that was exported; a continuous one.
    start : float
        Time of step 0 (LAMMPS counts from 0).
    dt : float, optional
        Step, for a dump without times (``dump_modify ... time yes`` writes them).
    m : int, optional
        Dimension; by default that of the positions in the dump.

    Returns
    -------
    Trajectory
        With the forces as inputs u (masses are 1), or the law's own inputs where the dump has none.

    Raises
    ------
    FileError
        If the file cannot be read, is no dump, is damaged, or its snapshots are not of the same agents.
    ArgumentError
        If times or columns are missing, the box is periodic and places cannot be unwrapped, or the flock is not one for
        this law.

    Examples
    --------
    >>> import tempfile
    >>> from flockana.laws.olfati_saber import Algorithm1
    >>> text = "ITEM: TIMESTEP\\n0\\nITEM: NUMBER OF ATOMS\\n1\\nITEM: BOX BOUNDS ss ff pp\\n0 1\\n0 1\\n0 1\\n"
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     _ = (Path(folder) / "one.dump").write_text(text + "ITEM: ATOMS id x vx fx\\n1 3.0 0.5 0.0\\n")
    ...     run = read_lammps(Path(folder) / "one.dump", Algorithm1(), dt=0.01)
    >>> run.q.tolist(), float(run.extra["force_residual"][0])
    ([[[3.0]]], 0.0)
    """
    from scipy.interpolate import CubicSpline

    ensure_law(law)
    if law.continuous is not law:
        raise ArgumentError(f"{law.title} is a map from step to step: expected a continuous law, as LAMMPS's is")
    start = ensure_finite_scalar("start", start)
    step = None if dt is None else ensure_positive("dt", dt)

    def ensure_fits(dimension: int) -> None:
        try:
            law.check_dimension(dimension)
        except ArgumentError as error:
            if m is not None or dimension < 3:
                raise
            raise ArgumentError(f"{error}; {path} has z; a planar run is read with m=2") from None

    dump = read_dump(ensure_path(path), step, m, "p", ensure_fits)
    t, q, p = start + dump["t"], dump["q"], dump["p"]
    law.check_agents(q.shape[1])
    flows = [law.flow(*state) for state in zip(t.tolist(), q, p, strict=True)]
    own_forces, rates = np.array([u for u, _ in flows]), np.array([rate for _, rate in flows])
    u, extra = own_forces, dict[str, FloatArray]()
    if "u" in dump:
        u = dump["u"]
        largest = float(np.abs(own_forces).max())
        extra["force_residual"] = np.abs(u - own_forces).max(axis=(1, 2)) / (largest if largest > 0.0 else 1.0)
    if np.isfinite(rates).all():
        work = CubicSpline(t, rates).antiderivative() if len(t) > 1 else np.zeros_like  # ∫ from the first sample
        extra["work"] = work(t) - work(t[0])
    stats = {"method": "LAMMPS", "steps": dump["steps"], "evaluations": dump["steps"]}
    return Trajectory(t, q, p, u, law, extra, "complete", f"read from {Path(path).name}", stats)
