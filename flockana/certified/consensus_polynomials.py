"""Exact stability decisions for second-order consensus: are all modes s² + (α + βs) μ of a net stable?

Weights and gains count as the rationals of their printed decimals.
"""

from collections.abc import Sequence

from flint import acb, arb, ctx, fmpq, fmpq_mat, fmpq_poly

from flockana.certified.balls import exact

_DIGITS = 30  # of the enclosures


def laplacian_of(weights: Sequence[Sequence[float]]) -> fmpq_mat:
    """Return L = diag(Σ_j a_ij) − A of rational weights."""
    rows = [[exact(item) for item in row] for row in weights]
    negated_rows = [[-item for item in row] for row in rows]
    for i, row in enumerate(rows):
        negated_rows[i][i] = sum(row, fmpq(0)) - row[i]
    return fmpq_mat(negated_rows)


def stable_off_agreement(laplacian: fmpq_mat, position: float, velocity: float) -> bool:
    """Return whether all poles except the two of the agreement motion lie in the open left half-plane.

    det(s²I + (α + βs)L) = Σ_k c_k (−1)^(n−k) s^2k (α + βs)^(n−k) with the characteristic polynomial Σ_k c_k μ^k of L;
    Hurwitz's criterion decides its cofactor of s² with rationals.
    """
    n, gain = laplacian.nrows(), fmpq_poly([exact(position), exact(velocity)])
    characteristic = laplacian.charpoly()
    square_term = fmpq_poly([0, 0, 1])
    whole = fmpq_poly([0])
    for k in range(n + 1):
        whole += characteristic[k] * (-1) ** (n - k) * square_term**k * gain ** (n - k)
    coefficients = [whole[k] for k in range(whole.degree() + 1)]
    return is_hurwitz(coefficients[2:])  # the first two are 0, as the rows of L sum to 0


def is_hurwitz(coefficients: Sequence[fmpq]) -> bool:
    """Return whether all roots of a real polynomial, given from its constant term on, have negative real parts.

    Routh's array: all entries of its first column have one sign.
    """
    falling_coefficients = list(reversed([fmpq(c) for c in coefficients]))
    upper, lower = falling_coefficients[0::2], falling_coefficients[1::2]
    sign = 1 if falling_coefficients[0] > 0 else -1
    while lower:
        if lower[0] * sign <= 0:
            return False
        ratio = upper[0] / lower[0]
        remaining_row = [a - ratio * b for a, b in zip(upper[1:], [*lower[1:], *[fmpq(0)] * len(upper)], strict=False)]
        upper, lower = lower, remaining_row
    return True


def moving_eigenvalues(laplacian: fmpq_mat) -> list[acb]:
    """Return enclosures of the distinct nonzero eigenvalues of L, as roots of its characteristic polynomial."""
    with ctx.workdps(_DIGITS):
        return [root for root, _ in laplacian.charpoly().numer().complex_roots() if not root.contains(0)]


def velocity_threshold(eigenvalues: Sequence[acb]) -> arb:
    """Return an enclosure of max Im²μ / (Re μ |μ|²), the lower limit of β²/α for stability."""
    largest = arb(0)
    for mu in eigenvalues:
        largest = largest.max(mu.imag**2 / (mu.real * (mu.real**2 + mu.imag**2)))
    return largest
