"""Log file of a simulation with unknown gains, for students to identify."""

import numpy as np

from flockana.dynamics.simulate import simulate
from flockana.interactions.gains import Gains
from flockana.lattice.builders import hexagonal_patch
from flockana.laws.olfati_saber import Algorithm1
from flockana.recorded.recording import Recording


def unknown_program(seed: int = 0) -> Recording:
    """Return the exact log of seven agents under Algorithm 1 with a friction that the seed chooses."""
    generator = np.random.default_rng([seed, 15])
    law = Algorithm1(gains=Gains(c1_alpha=30.0, c2_alpha=float(generator.integers(20, 80)) / 10.0))
    start = hexagonal_patch(1, 7.1)
    run = simulate(law, start, 0.3 * start[::-1] / 7.1, (0.0, 1.0), t_eval=np.linspace(0.0, 1.0, 201))
    return Recording(run.t, run.q, run.p, run.u, bound=0.0)
