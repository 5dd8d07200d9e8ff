"""Ultimate bound of a disturbed flock in a certified basin, from its strict Lyapunov function.

F = E + ε⟨w, v⟩ falls at least like dF/dt <= −αF in the basin, α = 2 rate (`flockana.certified.lyapunov`). A disturbance
d of the agents' accelerations, its mean over the agents taken off, adds ⟨v + εw, d⟩ <= ‖d‖(‖v‖ + ε‖w‖). With
E >= ½λ‖w‖² + ½‖v‖², e = ε/√λ and (1 − e)E <= F that is at most ‖d‖ c √F, c = √(2(1 + e²)/(1 − e)). So for ‖d‖ <= W

    √F(t) <= max(√F(0), W c/α),   limsup √F <= W c/α,   E <= F/(1 − e),

as long as the flock stays in the basin, which it does while F < (1 − e) ΔH.
"""

from dataclasses import dataclass, field
from fractions import Fraction
from typing import Any

from flint import arb, ctx

from flockana.base.errors import ArgumentError
from flockana.base.short_repr import ShortRepr
from flockana.base.value_checks import ensure_nonnegative
from flockana.certified.balls import ball
from flockana.certified.basin import DIGITS, Basin
from flockana.certified.decimal_rounding import fraction, round_down, round_up

_STATED = 4


@dataclass(frozen=True)
class UltimateBound(ShortRepr):
    """Bounds of a flock in a certified basin under a bounded disturbance; all exact, rounded to the safe side.

    Parameters
    ----------
    basin : Basin
        The basin.
    disturbance : Fraction
        W: at every time the disturbance, its mean over the agents taken off, is at most as large over all coordinates.
    largest : Fraction
        Disturbances below it cannot drive the flock out of the basin from a start with F(0) < (1 − e) ΔH.
    excess : Fraction
        In the end the energy above the equilibrium's is at most that.
    distance, speed : Fraction
        In the end the distance to the orbit and the relative speed, over all coordinates, are at most these.

    Examples
    --------
    >>> from flockana.certified.basin import certify
    >>> from flockana.laws.olfati_saber import Algorithm1
    >>> pair = certify([[0.0], [7.0]], law=Algorithm1())
    >>> small, large = ultimate_bound(pair, 0.05), ultimate_bound(pair, 0.1)
    >>> small.stays, 1.999 < large.distance / small.distance < 2.001
    (True, True)
    """

    basin: Basin = field(repr=False)
    disturbance: Fraction
    largest: Fraction
    excess: Fraction
    distance: Fraction
    speed: Fraction

    @property
    def stays(self) -> bool:
        """Whether the disturbance is too small to drive the flock out of the basin."""
        return self.disturbance < self.largest

    def holds(self, q: Any, p: Any) -> bool:
        """Return whether a start certainly stays in the basin under the disturbance.

        Parameters
        ----------
        q, p : array_like, shape (n, m)
            Positions and velocities, as `Basin.holds` takes them.
        """
        self.basin.ensure_unedited()
        distance, excess = self.basin.above(q, p)
        with ctx.workdps(DIGITS):
            share = _share(self.basin)
            start = (1 + share) * excess < (1 - share) * ball(self.basin.level)
            return bool(self.stays and distance < ball(self.basin.radius) and start)


def ultimate_bound(basin: Basin, disturbance: Any) -> UltimateBound:
    """Return bounds of a flock's motion in a certified basin under a bounded disturbance.

    Parameters
    ----------
    basin : Basin
        From `flockana.certify`.
    disturbance : float
        W >= 0, an acceleration: the largest √Σ‖d_i − mean‖² at any time.

    Raises
    ------
    ArgumentError
        On what is no basin, or a negative disturbance.
    """
    if not isinstance(basin, Basin):
        raise ArgumentError(f"basin = {basin!r}: expected a basin, as certify(...) returns it")
    basin.ensure_unedited()
    disturbance_bound = Fraction(ensure_nonnegative("disturbance", disturbance))
    with ctx.workdps(DIGITS):
        share, rate = _share(basin), 2 * ball(basin.proof.decay.rate)
        gain = (2 * (1 + share * share) / (1 - share)).sqrt() / rate  # √F <= W gain in the end
        largest = ((1 - share) * ball(basin.level)).sqrt() / gain
        excess = (ball(disturbance_bound) * gain) ** 2 / (1 - share)
        bounds = (excess, (2 * excess / ball(basin.curvature)).sqrt(), (2 * excess).sqrt())
        up = (fraction(round_up(x, _STATED)) if x > 0 else Fraction(0) for x in bounds)
        return UltimateBound(basin, disturbance_bound, fraction(round_down(largest, _STATED)), *up)


def _share(basin: Basin) -> arb:
    """Return the weight e = ε/√λ of the Lyapunov function's cross term."""
    return ball(basin.proof.decay.eps) / ball(basin.proof.bounds.curvature).sqrt()
