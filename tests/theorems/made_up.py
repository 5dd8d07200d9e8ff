"""Runs that no integrator made, judged by a theorem's own check: `verify` refuses them, as other tests hold."""

import numpy as np

from flockana import Tolerances, Trajectory, Verdict, rescale, theorem, verify
from flockana.lattice import hexagonal_patch
from flockana.theorems.observed_run import Observed


def made_up(law, q, p=None, t=None, u=None):
    """A run with samples as given; paths between them by the accelerations given, or 0."""
    q = np.array(q, dtype=float)
    p = np.zeros_like(q) if p is None else np.array(p, dtype=float)
    u = np.zeros_like(q) if u is None else np.array(u, dtype=float)
    t = np.arange(float(len(q))) if t is None else np.array(t, dtype=float)
    return Trajectory(t, q, p, u, law, {"work": np.zeros(len(q))}, stats={"steps": len(q) - 1})


def judged(name, run, tolerances=None):
    """What the theorem's check says of this one run, as if it were exact, without a second."""
    used = tolerances or Tolerances()
    return Verdict(name, *theorem(name).examine(Observed.alone(run), used), used)


SCALINGS = [(1e-6, 1.0), (1e3, 1e-3), (25.4, 60.0)]


def same_in_all_units(name, run, scaling):
    """Fail if a theorem's check says anything else of the same run in other units."""
    one, two = judged(name, run), judged(name, rescale(run, length=scaling[0], time=scaling[1]))
    assert statuses(one) == statuses(two)
    assert [h.status for h in one.hypotheses] == [h.status for h in two.hypotheses]


def statuses(verdict):
    """Status by claim."""
    return {claim.name: claim.status for claim in verdict.claims}


def hypothesis(verdict, part):
    """The hypothesis whose name holds this."""
    (found,) = [one for one in verdict.hypotheses if part in one.name]
    return found


def said(name, run):
    """Status by claim, as `verify` has it."""
    return statuses(verify(name, run))


def hexagon(seed=1, shake=0.2, speed=0.3):
    """Seven agents near an α-lattice of length 7, and their velocities."""
    rng, q = np.random.default_rng(seed), hexagonal_patch(1, 7.0)
    return q + shake * rng.uniform(-1, 1, q.shape), speed * rng.uniform(-1, 1, q.shape)
