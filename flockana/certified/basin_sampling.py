"""Estimate of an equilibrium's true basin by random runs, beside the certified one."""

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from flockana.base.binomial_intervals import clopper_pearson
from flockana.base.errors import ArgumentError
from flockana.base.value_checks import FloatArray, Numbers, ensure_count, ensure_positive, ensure_seed, ensure_series
from flockana.certified.basin import Basin
from flockana.dynamics.predicates import ensure_uninterrupted
from flockana.dynamics.simulate import simulate
from flockana.equilibria.final_state import rigid_motions


@dataclass(frozen=True, eq=False)
class SampledBasin:
    """Numbers of starts at rest, displaced in random directions, that returned to the orbit."""

    basin: Basin = field(repr=False)
    distances: FloatArray
    returned: Any
    runs: int

    @property
    def shares(self) -> FloatArray:
        """Fraction of the random starts at each distance that returned to the orbit of the equilibrium."""
        return self.returned / self.runs

    def interval(self, *, level: float = 0.95) -> tuple[FloatArray, FloatArray]:
        """Return exact confidence intervals of the probability that a start returns, at each distance."""
        return clopper_pearson(self.returned, np.full_like(self.returned, self.runs), level=level)


def sample_basin(
    basin: Basin, distances: Numbers, *, runs: int = 20, seed: int = 0, t_end: float = 20.0
) -> SampledBasin:
    """Run starts at rest at given distances from the orbit in random directions, and count those that return.

    A run counts if its end is in the certified basin: from there on it is proved. A run that needs longer than `t_end`
    does not.

    Parameters
    ----------
    basin : Basin
        Of `certify`.
    distances : sequence of float
        Over all coordinates, in units of length.
    runs : int
        Starts at each.
    t_end : float
        Length of a run.

    Examples
    --------
    >>> from flockana.certified.basin import certify
    >>> from flockana.laws.olfati_saber import Algorithm1
    >>> pair = certify([[0.0], [7.0]], law=Algorithm1())
    >>> sample_basin(pair, [0.3, 12.0], runs=4).returned.tolist()
    [4, 0]
    """
    if not isinstance(basin, Basin):
        raise ArgumentError(f"basin = {basin!r}: expected a basin, as certify(...) gives it")
    runs, end = ensure_count("runs", runs), ensure_positive("t_end", t_end)
    start_distances = ensure_series("distances", distances)
    if not start_distances.size or not (start_distances > 0.0).all():
        raise ArgumentError(f"distances = {start_distances.tolist()}: expected one or more numbers > 0")
    rng, motions = np.random.default_rng(ensure_seed(seed)), rigid_motions(basin.rest)
    target = basin.law.target
    centre, drift = (0.0, 0.0) if target is None else target.state(0.0)
    return_counts = np.zeros(start_distances.size, dtype=np.int64)
    for k, start_distance in enumerate(start_distances):
        for _ in range(runs):
            w = rng.standard_normal(basin.rest.size)
            w -= motions @ (motions.T @ w)
            start = basin.rest + centre + (start_distance / np.linalg.norm(w) * w).reshape(basin.rest.shape)
            p0, span = np.zeros_like(start) + drift, (0.0, end)
            run = ensure_uninterrupted(simulate(basin.law, start, p0, span, t_eval=[0.0, end]))
            return_counts[k] += basin.holds(run.q[-1], run.p[-1])
    return SampledBasin(basin, start_distances, return_counts, runs)
