"""Sphere at rest for the checker of tubes, computed from a certificate's numbers.

With w = x − y, D = ‖w‖, e = w/D and the clearance c = D − R, z = ‖c‖_σ, an agent is pushed by
−c1β φ_β(z) c/√(1 + εc²) e and braked by −c2β ρ_h G, G = v − (R/D)(v − ⟨e, v⟩ e), its velocity past its β-agent.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from flint import arb, arb_series

from flockana.certified.balls import BetaParameters, ball, dot, square
from flockana.certified.intervals import bump, bump_slope, d_beta, phi_beta, phi_beta_slope, psi_beta, sigma_of_square


@dataclass(frozen=True)
class Sphere:
    """Sphere of centre y and radius R with the β-pair law and its gains."""

    par: BetaParameters
    centre: tuple[arb, ...]
    radius: arb
    push: arb
    drag: arb

    @classmethod
    def of(cls, law: Mapping[str, Any], one: Mapping[str, Any]) -> Sphere:
        """Return the sphere of a certificate, its numbers as exact decimals."""
        par = BetaParameters(d=law["beta_d"], eps=law["beta_eps"], h=law["beta_h"])
        centre = tuple(ball(Fraction(x)) for x in one["centre"])
        numbers = (ball(Fraction(x)) for x in (one["radius"], law["c1_beta"], law["c2_beta"]))
        return cls(par, centre, *numbers)

    def clearance(self, x: Sequence[arb]) -> arb:
        """Return ‖x − y‖ − R."""
        total = sum((square(a - b) for a, b in zip(x, self.centre, strict=True)), arb(0))
        return total.nonnegative_part().sqrt() - self.radius

    def height(self, x: Sequence[arb]) -> arb:
        """Return ‖c‖_σ of the clearance c."""
        return sigma_of_square(square(self.clearance(x)), self.par.eps)

    def energy(self, x: Sequence[arb]) -> arb:
        """Return c1β ψ_β."""
        return self.push * psi_beta(self.height(x), self.par)

    def piece(self, x: Sequence[arb]) -> int | None:
        """Return an agent's piece (`piece_of`)."""
        return piece_of(self.height(x), d_beta(self.par), self.par.h)

    def force(self, x: Sequence[Any], v: Sequence[Any], piece: int | None) -> list[Any]:
        """Return the force along series of position and velocity; on an unknown piece as numbers at the begin."""
        if piece is None:
            x, v = [a[0] for a in x], [a[0] for a in v]
        e, distance = self._direction(x)
        c, eps = distance - self.radius, ball(self.par.eps)
        if piece is None:
            z = sigma_of_square(square(c), self.par.eps)
            action, rho = phi_beta(z, self.par), bump(z / d_beta(self.par), self.par.h)
        else:
            z, h = ((1 + eps * (c * c)).sqrt() - 1) / eps, ball(self.par.h)
            rho = taper(z / d_beta(self.par), h, piece)
            s = z - d_beta(self.par)
            action = rho * (s / (1 + s * s).sqrt() - 1)
        size, along = self.push * action * c / (1 + eps * (c * c)).sqrt(), dot(e, v)
        share = self.radius / distance
        return [-size * a - self.drag * rho * (w - share * (w - along * a)) for a, w in zip(e, v, strict=True)]

    def slope(self, x: Sequence[arb], v: Sequence[arb]) -> tuple[list[list[arb]], list[list[arb]]]:
        """Return ∂(force)/∂x and ∂(force)/∂v on a box, across the pieces."""
        e, distance = self._direction(x)
        c, along, share = distance - self.radius, dot(e, v), self.radius / distance
        stretch, z = 1 + ball(self.par.eps) * square(c), sigma_of_square(square(c), self.par.eps)
        action, rho = phi_beta(z, self.par), bump(z / d_beta(self.par), self.par.h)
        fading = bump_slope(z / d_beta(self.par), self.par.h) / d_beta(self.par) * c / stretch.sqrt()
        size = self.push * action * c / stretch.sqrt()
        steeper = self.push * (phi_beta_slope(z, self.par) * square(c) + action / stretch.sqrt()) / stretch
        by_x, by_v = [], []
        for k, (a, w) in enumerate(zip(e, v, strict=True)):
            slip, rows, brakes = w - share * (w - along * a), list[arb](), list[arb]()
            for h, (b, u) in enumerate(zip(e, v, strict=True)):
                aside = int(k == h) - a * b
                turn = share / distance * (b * (w - a * along) + aside * along + a * (u - b * along))
                rows.append(-steeper * a * b - size * aside / distance - self.drag * (fading * b * slip + rho * turn))
                brakes.append(-self.drag * rho * ((1 - share) * int(k == h) + share * a * b))
            by_x.append(rows)
            by_v.append(brakes)
        return by_x, by_v

    def _direction(self, x: Sequence[Any]) -> tuple[list[Any], Any]:
        """Return the unit vector e from the centre, and its derivative D."""
        away = [a - b for a, b in zip(x, self.centre, strict=True)]
        squares = [square(a) if isinstance(a, arb) else a * a for a in away]
        distance = sum(squares[1:], squares[0]).sqrt()
        return [a / distance for a in away], distance


def piece_of(z: arb, cutoff: arb, h: Any) -> int | None:
    """Return the piece of ρ_h on which a σ-norm is: 0 up to h·cutoff, 1 up to the cutoff, 2 beyond, None if on two."""
    knee = ball(h) * cutoff
    return 0 if z < knee else 2 if z > cutoff else 1 if z > knee and z < cutoff else None


def taper(z: Any, h: arb, piece: int) -> Any:
    """Return ρ_h(z) of a series on piece 0 or 1."""
    return arb_series([1]) if piece == 0 else (1 + ((z - h) / (1 - h)).cos_pi()) / 2
