"""Differences between a law and a recording found by regression: gains and forms, in sentences."""

from typing import Any, NamedTuple

import numpy as np

from flockana.base.checks import FloatArray
from flockana.base.vectors import lengths
from flockana.recorded.accelerations import Accelerations
from flockana.recorded.clustered_covariance import covariance_over_agents
from flockana.recorded.contributions import contributions, remainder, variants

_OTHER = 0.01  # relative difference from which on a gain is reported
_CHANCE = 3e-5  # probability that noise alone shows a gain as larger, likewise
_CLEAR = 0.3  # of the residual's squares: a form that leaves no more is reported
_WORTH = 1e-4  # of all squares that a form must explain beyond the law's own
_FITS = 0.99  # share explained by which a law fits
_EXACT = 1e-12  # share of the squares below which nothing more is sought


class Share(NamedTuple):
    """Contribution of a part of the law: its gain in the law and in the recording, and its share of the motion."""

    symbol: str
    text: str
    stated: float
    found: float
    error: float  # standard error of `found`
    share: float


class Solution(NamedTuple):
    """Gains by least squares, their standard errors, the residual sum of squares, and degrees of freedom."""

    gains: FloatArray
    errors: FloatArray
    left: float
    freedom: float


class Explained(NamedTuple):
    """Accelerations explained by a law: residual, remaining squares, shares, findings."""

    residual: FloatArray
    left: float
    left_refitted: float
    total: float
    shares: tuple[Share, ...]
    findings: tuple[str, ...]


class Regression:
    """Accelerations to be explained by the parts of a law, weighted by accuracy."""

    def __init__(self, data: Accelerations, law: Any) -> None:
        self.data, self.weights = data, data.weights
        fixed = remainder(law)
        self.target = data.u if fixed is None else data.u - data.of(fixed)
        self.total = self.squares(data.u)

    def squares(self, x: FloatArray) -> float:
        """Return the weighted sum of squares."""
        return float(np.sum(self.weights * lengths(x) ** 2))

    def share(self, part: FloatArray) -> float:
        """Return the share of the recorded accelerations along a part."""
        return float(np.sum(self.weights[:, :, None] * part * self.data.u)) / self.total if self.total else 0.0

    def solve(self, columns: list[FloatArray]) -> Solution:
        """Return the gains of some parts; residuals of one agent are treated as correlated."""
        root = np.sqrt(self.weights)[:, :, None]
        matrix = np.stack([(root * column).ravel() for column in columns], axis=1)
        y, norms = root * self.target, np.linalg.norm(matrix, axis=0)
        is_used, (gains, errors) = norms > 0.0, np.zeros((2, len(columns)))
        if not is_used.any():
            return Solution(gains, errors, float(np.sum(y**2)), y.size)
        a = matrix[:, is_used] / norms[is_used]
        beta = np.linalg.pinv(a.T @ a) @ (a.T @ y.ravel())
        rest = y - (a @ beta).reshape(y.shape)
        covariance, freedom = covariance_over_agents(a.reshape(*y.shape, -1), rest)
        gains[is_used] = beta / norms[is_used]
        errors[is_used] = np.sqrt(np.maximum(np.diag(covariance), 0.0)) / norms[is_used]
        return Solution(gains, errors, float(np.sum(rest**2)), freedom)


def explained(data: Accelerations, law: Any) -> Explained:
    """Return the explained share of accelerations and the differences: other forms first, then gains."""
    from scipy.stats import t as student

    work, parts = Regression(data, law), contributions(law)
    columns = [data.of(part.acts) for part in parts]
    residual = work.target - sum(part.stated * column for part, column in zip(parts, columns, strict=True))
    left, total = work.squares(residual), work.total
    texts: list[str] = []
    if total and left > _EXACT * total:
        columns, texts = _with_better_forms(work, law, [part.name for part in parts], columns)
    solution = work.solve(columns)
    shares = tuple(
        Share(part.symbol, part.text, part.stated, float(c), float(e), work.share(c * column))
        for part, column, c, e in zip(parts, columns, solution.gains, solution.errors, strict=True)
    )
    if left > _EXACT * total and solution.left < 0.5 * total:
        chance = float(student.isf(_CHANCE, solution.freedom))
        for one in shares:
            if abs(one.found - one.stated) > max(chance * one.error, _OTHER * abs(one.stated)):
                texts.append(f"{one.text} is {one.symbol} = {one.found:.4g} here, {one.stated:.4g} in the law")
    if total and 1.0 - solution.left / total < _FITS and data.basis != "splines":
        most = 1.0 - solution.left / total
        texts.append(f"{most:.1%} is the most that these terms explain with any gains: another law acts")
    return Explained(residual, left, min(left, solution.left), total, shares, tuple(texts))


def _with_better_forms(
    work: Regression, law: Any, names: list[str], columns: list[FloatArray]
) -> tuple[list[FloatArray], list[str]]:
    """Return the columns of a law's parts, replaced by far better alternative forms, and texts on these forms."""
    current, texts = list(columns), list[str]()
    open_ = [(variant, work.data.of(variant.acts)) for variant in variants(law) if variant.gain in names]
    left = work.solve(current).left
    while open_ and left > _EXACT * work.total:
        trials = []
        for variant, column in open_:
            k = names.index(variant.gain)
            trials.append((work.solve([*current[:k], column, *current[k + 1 :]]).left, variant, column))
        best_left, best, column = min(trials, key=lambda trial: trial[0])
        if best_left > _CLEAR * left or left - best_left < _WORTH * work.total:
            break
        left, current[names.index(best.gain)] = best_left, column
        texts.append(best.finding)
        open_ = [each for each in open_ if each[0].gain != best.gain]
    return current, texts
