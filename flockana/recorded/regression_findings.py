"""Differences between a law and a recording found by regression: gains and forms, in sentences."""

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from flockana.base.value_checks import FloatArray
from flockana.base.vector_norms import lengths
from flockana.recorded.accelerations import Accelerations
from flockana.recorded.clustered_covariance import covariance_over_agents
from flockana.recorded.law_contributions import Contribution, contributions, remainder, variants

_OTHER = 0.01  # relative difference from which on a gain is reported
_CHANCE = 3e-5  # probability that noise alone shows a gain as larger, likewise
_CLEAR = 0.3  # of the residual's squares: a form that leaves no more is reported
_WORTH = 1e-4  # of all squares that a form must explain beyond the law's own
_FITS = 0.99  # share explained by which a law fits
_EXACT = 1e-12  # share of the squares below which nothing more is sought
_GROWN = 2.0  # times what the stated errors do in any of a few draws: what they may do


Twin = tuple[Accelerations, Any]  # of a flock under the law with the stated errors, and the law or map from its states


class Share(NamedTuple):
    """Contribution of a part of the law: its stated and fitted gain, and its share of recorded accelerations."""

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
    """Accelerations explained by a law: residuals, residual and total squares, shares of terms, findings."""

    residual: FloatArray
    left: float
    left_refitted: float
    total: float
    shares: tuple[Share, ...]
    findings: tuple[str, ...]


class Regression:
    """Weighted least-squares regression of recorded accelerations on the accelerations by the parts of a law."""

    def __init__(self, data: Accelerations, law: Any) -> None:
        self.data, self.weights = data, data.weights
        known_part = remainder(law)
        self.target = data.u if known_part is None else data.u - data.of(known_part)
        self.total = self.squares(data.u)

    def squares(self, x: FloatArray) -> float:
        """Return Σ w ‖x‖², the sum of squared vector norms weighted by the accuracy of the accelerations."""
        return float(np.sum(self.weights * lengths(x) ** 2))

    def share(self, part: FloatArray) -> float:
        """Return Σ w x·u/Σ w ‖u‖² for recorded accelerations u and the accelerations x by a part of the law."""
        return float(np.sum(self.weights[:, :, None] * part * self.data.u)) / self.total if self.total else 0.0

    def solve(self, columns: list[FloatArray]) -> Solution:
        """Return least-squares gains of parts of the law; residuals of one agent count as correlated."""
        root = np.sqrt(self.weights)[:, :, None]
        matrix = np.stack([(root * column).ravel() for column in columns], axis=1)
        y, norms = root * self.target, np.linalg.norm(matrix, axis=0)
        is_used, (gains, errors) = norms > 0.0, np.zeros((2, len(columns)))
        if not is_used.any():
            return Solution(gains, errors, float(np.sum(y**2)), y.size)
        a = matrix[:, is_used] / norms[is_used]
        beta = np.linalg.pinv(a.T @ a) @ (a.T @ y.ravel())
        residuals = y - (a @ beta).reshape(y.shape)
        covariance, degrees_of_freedom = covariance_over_agents(a.reshape(*y.shape, -1), residuals)
        gains[is_used] = beta / norms[is_used]
        errors[is_used] = np.sqrt(np.maximum(np.diag(covariance), 0.0)) / norms[is_used]
        return Solution(gains, errors, float(np.sum(residuals**2)), degrees_of_freedom)


def explained(data: Accelerations, law: Any, twins: Sequence[Twin] = ()) -> Explained:
    """Return the explained share of accelerations and the differences: other forms first, then gains.

    Errors of states make gains and the share smaller: `twins` of the data show by how much under the law itself, and
    what is no more than twice that is no finding.
    """
    from scipy.stats import t as student

    regression, parts = Regression(data, law), contributions(law)
    columns = [data.of(part.acts) for part in parts]
    residual = regression.target - sum(part.stated * column for part, column in zip(parts, columns, strict=True))
    left, total = regression.squares(residual), regression.total
    texts: list[str] = []
    if total and left > _EXACT * total:
        columns, texts = _with_better_forms(regression, law, [part.name for part in parts], columns)
    solution = regression.solve(columns)
    gain_changes, lost_share = _done_by_errors(twins, parts)
    shares = tuple(
        Share(part.symbol, part.text, part.stated, float(c), float(np.hypot(e, change)), regression.share(c * column))
        for part, column, c, e, change in zip(
            parts, columns, solution.gains, solution.errors, gain_changes, strict=True
        )
    )
    if left > _EXACT * total and solution.left < 0.5 * total:
        chance_limit = float(student.isf(_CHANCE, solution.freedom))
        for share, error, change in zip(shares, solution.errors, gain_changes, strict=True):
            smallest_finding = max(chance_limit * error, _OTHER * abs(share.stated), _GROWN * float(change))
            if abs(share.found - share.stated) > smallest_finding:
                texts.append(f"{share.text} is {share.symbol} = {share.found:.4g} here, {share.stated:.4g} in the law")
    left_share = solution.left / total if total else 0.0
    if left_share > max(1.0 - _FITS, _GROWN * lost_share) and data.basis != "splines":
        explained_share = 1.0 - solution.left / total
        texts.append(f"{explained_share:.1%} is the most that these terms explain with any gains: another law acts")
    return Explained(residual, left, min(left, solution.left), total, shares, tuple(texts))


def _done_by_errors(twins: Sequence[Twin], parts: Sequence[Contribution]) -> tuple[FloatArray, float]:
    """Return the largest changes of gains and of the unexplained share by errors alone, in simulated data."""
    gain_changes, lost_share = np.zeros(len(parts)), 0.0
    for data, law in twins:
        regression = Regression(data, law)
        solution = regression.solve([data.of(part.acts) for part in contributions(law)])
        gain_changes = np.maximum(gain_changes, np.abs(solution.gains - [part.stated for part in parts]))
        lost_share = max(lost_share, solution.left / (regression.total or 1.0))
    return gain_changes, lost_share


def _with_better_forms(
    work: Regression, law: Any, names: list[str], columns: list[FloatArray]
) -> tuple[list[FloatArray], list[str]]:
    """Return the columns of a law's parts, replaced by far better alternative forms, and texts on these forms."""
    current_columns, texts = list(columns), list[str]()
    open_variants = [(variant, work.data.of(variant.acts)) for variant in variants(law) if variant.gain in names]
    left = work.solve(current_columns).left
    while open_variants and left > _EXACT * work.total:
        trials = []
        for variant, column in open_variants:
            k = names.index(variant.gain)
            trials.append((work.solve([*current_columns[:k], column, *current_columns[k + 1 :]]).left, variant, column))
        best_remainder, best_form, column = min(trials, key=lambda trial: trial[0])
        if best_remainder > _CLEAR * left or left - best_remainder < _WORTH * work.total:
            break
        left, current_columns[names.index(best_form.gain)] = best_remainder, column
        texts.append(best_form.finding)
        open_variants = [item for item in open_variants if item[0].gain != best_form.gain]
    return current_columns, texts
