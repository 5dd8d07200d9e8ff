"""Integration of a wrapped law without noise, in steps that miss no encounter."""

from collections.abc import Iterator
from math import ceil

import numpy as np

from flockana.base.checks import FloatArray
from flockana.base.errors import ArgumentError
from flockana.dynamics.encounters import Encounters, State
from flockana.dynamics.iterate import discrete, wanted_steps
from flockana.dynamics.sample import Samples, Tally
from flockana.solvers.fixed_steps import FixedSteps


def followed(
    law: FixedSteps, q0: FloatArray, p0: FloatArray, t_span: tuple[float, float], keep: FloatArray | None, tally: Tally
) -> Iterator[Samples]:
    """Yield the steps of a wrapped law without noise; raise if a step, or the past, misses an encounter."""
    check, wanted = Encounters.of(law.law, len(q0)), wanted_steps(law, t_span, keep)
    before = State(q0, p0, np.zeros_like(q0))
    past = law.start(q0, p0).get("past", np.empty((0, 4, *q0.shape)))
    for k in range(len(past) - 1):
        _ensure_encounters_resolved(
            check, law.dt, State(*past[k, :3]), State(*past[k + 1, :3]), t_span[0] - (len(past) - 1 - k) * law.dt
        )
    first = 0
    for samples in discrete(law, q0, p0, t_span, None, tally):
        for t, *state in zip(samples.t.tolist(), samples.q, samples.p, samples.u, strict=True):
            after = State(*state)
            if t > t_span[0]:
                # the input of a step is its mean: that of both of its ends, to the order that paths are looked at
                _ensure_encounters_resolved(check, law.dt, before._replace(u=after.u), after, t - law.dt)
            before = after
        kept = (
            slice(None) if wanted is None else np.flatnonzero(np.isin(np.arange(first, first + len(samples.t)), wanted))
        )
        first += len(samples.t)
        if wanted is None or kept.size:  # type: ignore[union-attr]
            yield Samples(samples.t[kept], samples.q[kept], samples.p[kept], samples.u[kept], {})


def _ensure_encounters_resolved(check: Encounters, h: float, before: State, after: State, t: float) -> None:
    share = check.share(h, before, after) if check.any else 1.0
    if share < 1.0:
        raise ArgumentError(
            f"dt = {h:g}: agents come into range and out again, or go too far there, within the step from t = {t:.6g}; "
            f"expected dt <= {h / ceil(1.0 / share):.4g}"
        )
