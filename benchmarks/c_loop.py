"""The C loop of `pair_loop.c`, compiled for this machine when it is first asked for."""

from __future__ import annotations

import ctypes
import shutil
import subprocess
import tempfile
from pathlib import Path
from typing import Any

import numpy as np

from flockana.base.value_checks import FloatArray

FLAGS = ("-O3", "-march=native", "-ffast-math", "-fPIC", "-c")
MISSING = "no C compiler (cc) here: the comparison with the C loop is left out"
_DOUBLES = np.ctypeslib.ndpointer(np.float64, flags="C_CONTIGUOUS")


def compiled() -> ctypes.CDLL | None:
    """The loop as a library, or None where there is no C compiler."""
    cc = shutil.which("cc")
    if cc is None:
        return None
    with tempfile.TemporaryDirectory() as folder:
        library, parts, source = (
            Path(folder) / "pair_loop.so",
            Path(folder) / "pair_loop.o",
            Path(__file__).with_name("pair_loop.c"),
        )
        subprocess.run([cc, *FLAGS, str(source), "-o", str(parts)], check=True)
        # linked without -ffast-math, which would set the whole process to flush subnormal numbers to zero
        subprocess.run([cc, "-shared", str(parts), "-o", str(library), "-lm"], check=True)
        loaded = ctypes.CDLL(str(library))
    loaded.flock_new.argtypes, loaded.flock_new.restype = [ctypes.c_long], ctypes.c_void_p
    loaded.flock_free.argtypes, loaded.flock_free.restype = [ctypes.c_void_p], None
    loaded.flock_build.argtypes = [ctypes.c_void_p, _DOUBLES, _DOUBLES, ctypes.c_double]
    loaded.flock_build.restype = ctypes.c_long
    loaded.flock_flow.argtypes, loaded.flock_flow.restype = [ctypes.c_void_p, *[_DOUBLES] * 6], ctypes.c_double
    loaded.flock_repeat.argtypes = [ctypes.c_void_p, *[_DOUBLES] * 6, ctypes.c_long, ctypes.c_double]
    loaded.flock_repeat.restype = ctypes.c_double
    loaded.flock_rk4.argtypes = [ctypes.c_void_p, *[_DOUBLES] * 5, ctypes.c_double, ctypes.c_double, ctypes.c_long]
    loaded.flock_rk4.restype = ctypes.c_long
    return loaded


class Loop:
    """Algorithm 2 in C for one flock, with a list that lasts while nobody moves by half the skin.

    Parameters
    ----------
    library : CDLL
        What `compiled` gave.
    law : Algorithm2
        In the plane, with a target at rest at the origin.
    n : int
        Agents.
    """

    def __init__(self, library: ctypes.CDLL, law: Any, n: int) -> None:
        self._c, self._flock, self._u = library, library.flock_new(n), np.empty((n, 2))
        a, g = law.alpha, law.gains
        self._range = float(a.r)
        self._law = np.array([a.r, a.eps, a.h, a.a, a.b, a.c, a.d_alpha, a.r_alpha])
        self._gains = np.array([g.c1_alpha, g.c2_alpha, g.c1_gamma, g.c2_gamma], dtype=np.float64)
        self._target = np.zeros(4)

    def build(self, q: FloatArray, p: FloatArray, skin: float = 0.0) -> int:
        """List the pairs closer than the range and the skin; how many there are."""
        return int(self._c.flock_build(self._flock, q, p, self._range + skin))

    def flow(self, q: FloatArray, p: FloatArray) -> tuple[FloatArray, float]:
        """(u, dH/dt) over the list that is kept."""
        rate = self._c.flock_flow(self._flock, q, p, self._law, self._gains, self._target, self._u)
        return self._u, rate

    def rebuilt_flow(self, q: FloatArray, p: FloatArray) -> tuple[FloatArray, float]:
        """(u, dH/dt) over a list of its own."""
        self.build(q, p)
        return self.flow(q, p)

    def repeated(self, q: FloatArray, p: FloatArray, times: int, *, rebuild: bool) -> tuple[FloatArray, float]:
        """(u, dH/dt), computed so many times in one call, over the list that is kept or one of its own each time."""
        given = q, p, self._law, self._gains, self._target, self._u
        return self._u, self._c.flock_repeat(self._flock, *given, times, self._range if rebuild else 0.0)

    def stepped(
        self, q: FloatArray, p: FloatArray, dt: float, steps: int, skin: float
    ) -> tuple[FloatArray, FloatArray, int]:
        """(q, p) after so many steps of RK4, and how often the list was made."""
        q, p = q.copy(), p.copy()
        given = q, p, self._law, self._gains, self._target
        return q, p, int(self._c.flock_rk4(self._flock, *given, self._range + skin, dt, steps))

    def close(self) -> None:
        """Give the memory back."""
        self._c.flock_free(self._flock)
