"""The α-law as a GPU's compiler takes it: device functions made of the kernels' own text, summed over a full list.

`python tests/on_a_gpu.py ptx` prints what `compile_ptx` makes of them; with ``NUMBA_ENABLE_CUDASIM=1`` and ``sums`` the
simulator's sums over 30 agents, as JSON. Both are run in processes of their own, as numba decides on the simulator when
it is imported.
"""

import json
import sys
from functools import cache
from math import nan
from types import FunctionType

import numpy as np
from numba import cuda, float64, int64

from flockana import AlphaInteraction, links
from flockana.jit import Inlined
from flockana.kernels import alpha


@cache
def device_function(function):
    """Return a kernel's helper, and all that it calls, as a device function."""
    text = function.py_func
    names = {k: v for k, v in text.__globals__.items() if k in text.__code__.co_names}
    names = {k: device_function(v) if isinstance(v, Inlined) else v for k, v in names.items()}
    # written into its caller: a call would be compiled by itself, for which numba asks the driver what device there is
    return cuda.jit(device=True, inline="always")(FunctionType(text.__code__, names, text.__name__))


norm, stress = device_function(alpha.norm_alpha), device_function(alpha.stress_alpha)


def sums(q, p, start, neighbour, par, c1, c2, u, dissipation):
    """Write each agent's acceleration in the plane, and its share of the dissipation, from all its neighbours."""
    i = cuda.grid(1)
    if i < q.shape[0]:
        u[i, 0], u[i, 1], dissipation[i] = 0.0, 0.0, 0.0
        for k in range(start[i], start[i + 1]):
            j = neighbour[k]
            x, y, v, w = q[j, 0] - q[i, 0], q[j, 1] - q[i, 1], p[j, 0] - p[i, 0], p[j, 1] - p[i, 1]
            z, root = norm(x * x + y * y, par)
            s, a = stress(z, root, par)
            u[i, 0] += c1 * s * x + c2 * a * v
            u[i, 1] += c1 * s * y + c2 * a * w
            dissipation[i] += 0.5 * a * (v * v + w * w)


def flock():
    """Return 30 agents in the plane, some of them near the range, and the full list of their neighbours."""
    rng, law = np.random.default_rng(7), AlphaInteraction()
    q, p = rng.uniform(0.0, 30.0, (30, 2)), rng.normal(size=(30, 2))
    both = np.concatenate([links(q, law.range), links(q, law.range)[:, ::-1]])
    both = both[np.lexsort(both.T[::-1])]
    return law, q, p, np.searchsorted(both[:, 0], np.arange(31)), both[:, 1].astype(np.int64)


if __name__ == "__main__" and sys.argv[1] == "sums":
    law, q, p, start, neighbour = flock()
    u, shares = np.full(q.shape, nan), np.full(len(q), nan)
    cuda.jit(sums)[1, 32](q, p, start, neighbour, law.par.copy(), 2.0, 3.0, u, shares)
    print(json.dumps({"u": u.tolist(), "dissipation": shares.sum()}))
elif __name__ == "__main__":
    plane, row, whole = float64[:, ::1], float64[::1], int64[::1]
    signatures = {
        "norm_alpha": (float64, row),
        "stress_alpha": (float64, float64, row),
        "psi_alpha": (float64, row, plane),
        **dict.fromkeys(("phi_alpha", "phi_alpha_slope", "adjacency_alpha"), (float64, row)),
    }
    texts = {
        name: cuda.compile_ptx(device_function(getattr(alpha, name)), types, device=True, cc=(8, 0))[0]
        for name, types in signatures.items()
    }
    types = (plane, plane, whole, whole, row, float64, float64, plane, row)
    texts["sums"] = cuda.compile_ptx(sums, types, cc=(8, 0))[0]
    print(json.dumps(texts))
