"""CMA-ES in the unit cube, restarted with twice the population after convergence (IPOP)."""

from typing import Any

import numpy as np

from flockana.base.value_checks import FloatArray

_SIGMA = 0.2  # of the cube's side: the first generation covers most of it
_FULL = 100  # dimensions up to which the whole covariance is learned, beyond them its diagonal (sep-CMA-ES)


class Search:
    """IPOP-CMA-ES optimiser that proposes generations of points and learns from their grades."""

    def __init__(self, start: FloatArray, seed: int) -> None:
        self.dimension, self.restarts = len(start), 0
        self._rng = np.random.default_rng(seed)
        self._begin(start)

    def _begin(self, mean: FloatArray) -> None:
        import cmaes

        dimension_count = max(2, self.dimension)  # CMA wants two dimensions at least; the second does nothing then
        mean = np.concatenate([mean, np.full(dimension_count - len(mean), 0.5)])
        population = (4 + int(3.0 * np.log(dimension_count))) * 2**self.restarts
        kind: Any = cmaes.CMA if dimension_count <= _FULL else cmaes.SepCMA
        bounds = np.tile([0.0, 1.0], (dimension_count, 1))
        self._cma = kind(mean, _SIGMA, bounds, seed=int(self._rng.integers(2**31)), population_size=population)

    def ask(self) -> list[FloatArray]:
        """Return the next generation of points, each of shape (D,)."""
        self._asked = [self._cma.ask() for _ in range(self._cma.population_size)]
        return [x[: self.dimension] for x in self._asked]

    def tell(self, grades: list[float]) -> None:
        """Update the optimiser with the grades of the generation that `ask` returned last."""
        self._cma.tell(list(zip(self._asked, grades, strict=True)))
        if self._cma.should_stop():
            self.restarts += 1
            self._begin(self._rng.uniform(size=self.dimension))
