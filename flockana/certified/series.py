"""α-pair law along a path as power series in time (Arb), piece by piece.

ρ_h is only C¹ at z = h r_α and at z = r_α. Between these distances, below and beyond, φ_α and a_ij are analytic in the
squared distance, so that the Taylor coefficients of a pair's force follow from those of its path by series arithmetic.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from typing import Any

from flint import arb, arb_series

from flockana.certified.intervals import bump, bump_slope, exact, phi, phi_slope, shift, sigma_of_square


class Piece(Enum):
    """Piece of ρ_h on which the distance of a pair lies, or possibly two."""

    CORE = "z < h r_α"
    TAPER = "h r_α < z < r_α"
    OUT = "z > r_α"
    SWITCH = "about a distance where pieces meet"


@dataclass(frozen=True)
class PairNumbers:
    """Numbers of the α-pair law as balls at one precision, lengths in units of ℓ where marked.

    Attributes
    ----------
    eps, h, a, b : arb
        As of the law; ε in units of 1/ℓ².
    offset : arb
        c − d_α, what is added to z in φ; in units of ℓ².
    cutoff, knee : arb
        r_α and h r_α, in units of ℓ².
    area : arb
        ℓ².
    """

    eps: arb
    h: arb
    a: arb
    b: arb
    offset: arb
    cutoff: arb
    knee: arb
    area: arb

    @classmethod
    def of(cls, alpha: Any) -> PairNumbers:
        """Return the numbers of an `AlphaInteraction` as exact decimals."""
        unit = exact(alpha.unit)
        d, r, eps = exact(alpha.d) / unit, exact(alpha.r) / unit, exact(alpha.eps) * unit * unit
        h, a, b = exact(alpha.h), exact(alpha.a), exact(alpha.b)
        cutoff = sigma_of_square(arb(r * r), eps)
        offset = shift(a, b) - sigma_of_square(arb(d * d), eps)
        return cls(arb(eps), arb(h), arb(a), arb(b), offset, cutoff, arb(h) * cutoff, arb(unit * unit))

    def piece(self, s2: arb) -> Piece:
        """Return the piece on which every squared distance in a ball lies."""
        z = sigma_of_square(s2 / self.area, self.eps)
        if z > self.cutoff:
            return Piece.OUT
        if z < self.knee:
            return Piece.CORE
        return Piece.TAPER if z > self.knee and z < self.cutoff else Piece.SWITCH


def pair_series(s2: arb_series, law: PairNumbers, piece: Piece) -> tuple[arb_series, arb_series]:
    """Return (stress s_ij, adjacency a_ij) along a path of squared distances, on one piece within range."""
    slant, z = _slant_and_norm(s2, law)
    rho, (s, root) = _bump(z, law, piece), _shifted(z, law)
    return rho * _action(s, root, law) * slant, rho


def pair_slopes(s2: arb_series, law: PairNumbers, piece: Piece) -> tuple[arb_series, arb_series]:
    """Return (d s_ij/d s², d a_ij/d s²) along a path of squared distances, on one piece within range."""
    slant, z = _slant_and_norm(s2, law)
    rho, rho_slope, (s, root) = _bump(z, law, piece), _bump_slope(z, law, piece), _shifted(z, law)
    action, action_slope = _action(s, root, law), (law.a + law.b) / 2 * (root * root * root)
    along = rho_slope * action + rho * action_slope - law.eps * slant * rho * action
    return along * slant * slant / (2 * law.area), rho_slope * slant / (2 * law.area)


def _slant_and_norm(s2: arb_series, law: PairNumbers) -> tuple[arb_series, arb_series]:
    """Return (1/√(1 + εs²), z = (√(1 + εs²) − 1)/ε)."""
    square = 1 + law.eps * (s2 / law.area)
    slant = square.rsqrt()
    return slant, (square * slant - 1) / law.eps


def _shifted(z: arb_series, law: PairNumbers) -> tuple[arb_series, arb_series]:
    """Return (s = z − d_α + c, 1/√(1 + s²)), from which φ and its slope follow."""
    s = z + law.offset
    return s, (1 + s * s).rsqrt()


def _action(s: arb_series, root: arb_series, law: PairNumbers) -> arb_series:
    """Return φ(z − d_α)."""
    return ((law.a + law.b) * (s * root) + (law.a - law.b)) / 2


def _bump(z: arb_series, law: PairNumbers, piece: Piece) -> arb_series:
    """Return ρ_h(z/r_α) on a piece."""
    if piece is Piece.CORE:
        return arb_series([1])
    return (1 + _phase(z, law).cos_pi()) / 2


def _bump_slope(z: arb_series, law: PairNumbers, piece: Piece) -> arb_series:
    """Return the derivative of ρ_h(z/r_α) on a piece."""
    if piece is Piece.CORE:
        return arb_series([0])
    return -arb.pi() / (2 * (1 - law.h) * law.cutoff) * _phase(z, law).sin_pi()


def _phase(z: arb_series, law: PairNumbers) -> arb_series:
    """Return the position on the taper, from 0 to 1."""
    return (z / law.cutoff - law.h) / (1 - law.h)


def pair_hull(s2: arb, law: PairNumbers) -> tuple[arb, arb, arb, arb]:
    """Return (s_ij, a_ij, and their derivatives by s²) on a ball of squared distances over several pieces.

    The derivatives are continuous, so that their balls hold all of them, on either side of a switch and at it.
    """
    inside = (s2 / law.area).nonnegative_part()
    slant, z = (1 + law.eps * inside).rsqrt(), sigma_of_square(inside, law.eps)
    rho, rho_slope = bump(z / law.cutoff, law.h), bump_slope(z / law.cutoff, law.h) / law.cutoff
    action, action_slope = _phi(z, law), phi_slope(z + law.offset - shift(law.a, law.b), law.a, law.b)
    along = rho_slope * action + rho * action_slope - law.eps * slant * rho * action
    return rho * action * slant, rho, along * slant * slant / (2 * law.area), rho_slope * slant / (2 * law.area)


def _phi(z: arb, law: PairNumbers) -> arb:
    """Return φ(z − d_α) on a ball."""
    return phi(z + law.offset - shift(law.a, law.b), law.a, law.b)
