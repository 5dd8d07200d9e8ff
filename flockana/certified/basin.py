"""Certified basins of equilibria of Algorithms 1 and 2: starts that provably end in the orbit.

Let O be the orbit of x* under rotations, in the frame of the centre of mass, dist the distance to O over all
coordinates, H = U + ½‖v‖². Every state with dist < ρ and H − U* < ΔH stays nearer than ρ, collides nowhere and
converges to a point of O with matched velocities, at a guaranteed rate. The argument, with what is checked where:

1. x* exists, one in a box modulo rigid motions (`at_rest`, Krawczyk).
2. w = y − R x* for the nearest R x* is orthogonal to the orbit there; U and H do not change under rotations: prose.
3. Along w the curvature of U is at least k_i in the i-th shell of the ball (`shells`), so that
   U − U* >= G(‖w‖) and ⟨∇U, w⟩ >= λ‖w‖²; on the way out U would have to reach U* + G(ρ), and H, which never rises, is
   less: the set is invariant. In it O holds all equilibria.
4. ⟨v, D v⟩ >= μ‖v‖² throughout and a strict Lyapunov function falls exponentially (both in `lyapunov`); so the
   speed is integrable in time, and x converges to one point. No limit set theorem is needed.
5. dist² is smooth where the nearest point is unique and not degenerate: in the plane if ρ < ‖x*‖, in space if
   (1 + √3) ρ √g < tr − g with g the Frobenius norm, and tr the trace, of Σ x_i* x_i*ᵀ (checked; that this suffices is
   prose: R maximises tr(Rᵀ M), M = Σ x_i x_i*ᵀ, which it does uniquely if σ2 ± σ3 > 0).
6. Pairs stay farther apart than ℓ − √2 ρ > 0.

The centre of mass is not part of it: it moves uniformly under Algorithm 1, and under Algorithm 2, where q_r' = p_r,
q_c − q_r solves y'' + c2γ y' + c1γ y = −p_r'.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from fractions import Fraction
from typing import Any

import numpy as np
from flint import arb, ctx, fmpq

from flockana.base.errors import ArgumentError, SolverError
from flockana.base.integrity_seals import ensure_sealed, sealed
from flockana.base.short_repr import ShortRepr
from flockana.base.table_export import facts_text
from flockana.base.value_checks import FloatArray, ensure_points
from flockana.certified.balls import ball, minus, norm, norm2
from flockana.certified.curvature_shells import ROOT_TWO, BondTable, Shells, prove
from flockana.certified.decimal_rounding import fraction, round_down
from flockana.certified.enclosed_equilibrium import BOX, centred, enclose_rest, rotated_to, unique_projection
from flockana.certified.lyapunov import Bounds, Decay, damping, decay
from flockana.certified.structural_potential import Structure
from flockana.equilibria.solve import Equilibrium, ensure_unedited_equilibrium
from flockana.measures.nets import components, links

DIGITS = 40
_STATED = 4
_BISECTIONS = 10
_LEAST = 0.05  # of the curvature at rest: a smaller one buys radius at the price of the rate
_WIDEST = 0.5  # of d
_SMALLEST = 1e-4  # of d: a basin that is smaller is not sought
_RETREAT, _RETRIES = 0.97, 8
_APART = 1e-6  # of d: nearer agents are at one place


@dataclass(frozen=True, eq=False)
class Basin(ShortRepr):
    """Certified basin of an equilibrium's orbit under rotations; all numbers exact, rounded to the safe side.

    Every start whose shape is nearer than `radius` to the orbit, over all coordinates, and whose structural energy is
    less than `level` above the equilibrium's, converges to a point of the orbit, in the frame of the centre of mass,
    and its velocities match.

    Parameters
    ----------
    rest : ndarray, shape (n, m)
        The computed equilibrium, its centre at the origin; the true one is within 1e-13 d of it.
    radius : Fraction
        ρ, in units of length.
    level : Fraction
        ΔH, in units of energy.
    curvature : Fraction
        λ: within, U − U* >= ½ λ dist².
    damping : Fraction
        μ: within, the energy falls at least at the rate μ‖v‖².
    rate : Fraction
        Distance and speed fall at least like exp(−rate·t), but for `overshoot`.
    overshoot : Fraction
        The energy's excess E obeys E(t) <= overshoot·E(0)·exp(−2 rate·t).
    distance : Fraction
        No two agents ever come nearer to one another.
    connected : bool
        Whether the net is connected at all times.
    proof : Proved
        What it was proved from, for its certificate.

    Examples
    --------
    >>> from flockana.laws.olfati_saber import Algorithm1
    >>> pair = certify([[0.0], [7.0]], law=Algorithm1())
    >>> pair.share > 0.05, pair.holds([[0.0], [7.2]], [[1.0], [1.0]]), pair.holds([[0.0], [9.0]], [[0.0], [0.0]])
    (True, True, False)
    """

    law: Any = field(repr=False)
    rest: FloatArray = field(repr=False)
    radius: Fraction
    level: Fraction
    curvature: Fraction
    damping: Fraction
    rate: Fraction
    overshoot: Fraction
    distance: Fraction
    connected: bool
    proof: Proved = field(repr=False)

    def __str__(self) -> str:
        names = ("radius", "level", "curvature", "damping", "rate", "overshoot", "distance")
        return facts_text("Basin", {name: f"{float(getattr(self, name)):.4g}" for name in names})

    @property
    def share(self) -> float:
        """Radius ρ of the certified basin in units of the desired distance d, ρ/d."""
        return float(self.radius) / float(self.law.alpha.d)

    def above(self, q: Any, p: Any) -> tuple[arb, arb]:
        """Return upper bounds of a state's distance from the orbit and of its energy above the equilibrium.

        Parameters
        ----------
        q, p : array_like, shape (n, m)
            Positions and velocities, floats (which count with their binary values) or balls.
        """
        with ctx.workdps(DIGITS):
            u, shape = self.proof.structure, self.rest.shape
            x, v = centred("q", q, shape), centred("p", p, shape)
            rotated_rest = rotated_to(self.proof.rest, x, shape)
            distance = norm(minus(x, rotated_rest))
            excess = u.energy(x) - u.energy(self.proof.rest) + norm2(v) / 2
            return distance.upper(), excess.upper()

    def ensure_unedited(self) -> None:
        """Raise unless the basin is unchanged since `certify` returned it."""
        ensure_sealed("basin", self, "a basin as certify returned it", "certify(equilibrium) proves another")

    def holds(self, q: Any, p: Any) -> bool:
        """Return whether a start is certainly in the basin; False also where undecided.

        Parameters
        ----------
        q, p : array_like, shape (n, m)
            Positions and velocities, floats (which count with their binary values) or balls. Agents are numbered as in
            `rest`.

        Raises
        ------
        ArgumentError
            If the basin was made or changed by hand.
        """
        self.ensure_unedited()
        distance, excess = self.above(q, p)
        with ctx.workdps(DIGITS):
            return bool(distance < ball(self.radius) and excess < ball(self.level))


@dataclass(frozen=True, eq=False)
class Proved:
    """Bounds and shells that prove a basin, as needed for a certificate."""

    structure: Structure
    rest: tuple[arb, ...]
    box: fmpq
    shells: Shells
    second: fmpq
    degree: fmpq
    bounds: Bounds
    decay: Decay


def certify(equilibrium: Any, *, law: Any = None) -> Basin:
    """Return a certified basin of an equilibrium of Algorithm 1 or 2, as large as the proof allows.

    Parameters
    ----------
    equilibrium : Equilibrium or array_like, shape (n, m)
        A strict minimum, of `find_equilibrium`; or positions next to one.
    law : Algorithm1 or Algorithm2, optional
        The law, if not the equilibrium's own.

    Raises
    ------
    ArgumentError
        If there is no equilibrium, or it is no strict minimum, has coincident agents, or is disconnected under
        Algorithm 1.
    SolverError
        If no basin could be proved.

    Examples
    --------
    >>> from flockana.laws.olfati_saber import Algorithm1
    >>> triangle = certify([[0.0, 0.0], [7.0, 0.0], [3.5, 6.062177826491071]], law=Algorithm1())
    >>> triangle.share > 0.045, triangle.connected, triangle.distance > 6
    (True, True, True)
    """
    is_equilibrium = isinstance(equilibrium, Equilibrium)
    if is_equilibrium:
        ensure_unedited_equilibrium("equilibrium", equilibrium)
    law = equilibrium.law if law is None and is_equilibrium else law
    if law is None:
        raise ArgumentError("law = None: expected the law that these positions are an equilibrium of")
    q = ensure_points("equilibrium", equilibrium.q if is_equilibrium else equilibrium)
    u = Structure.of(law, *q.shape)
    _ensure_flock(law, q)
    with ctx.workdps(DIGITS):
        computed_state, rest_enclosure = enclose_rest(u, q)
        bond_table = BondTable(law, u, rest_enclosure)
        radius = _largest(bond_table)
        for _ in range(_RETRIES):
            shells = prove(bond_table, bond_table.proposed(radius))
            basin = shells and _assemble_basin(bond_table, law, computed_state, shells)
            if basin:
                return basin
            radius *= _RETREAT
    raise SolverError(f"no basin of {q.shape[0]} agents could be proved down to ρ = {radius / law.alpha.d:.3g} d")


def _ensure_flock(law: Any, q: FloatArray) -> None:
    """Raise before any work unless the configuration can be a strict minimum of distinct agents."""
    if len(q) < 2:
        raise ArgumentError(f"equilibrium has {len(q)} agent: expected two or more, a shape")
    if len(links(q, _APART * law.alpha.d)):
        raise ArgumentError("the equilibrium has coincident agents: expected distinct positions, or they may collide")
    if law.gains.c2_alpha == 0.0 and (law.target is None or law.gains.c2_gamma == 0.0):
        raise ArgumentError("c2_alpha = 0 and no c2_gamma: expected a gain that damps, or no velocities match")
    is_untargeted = law.target is None or law.gains.c1_gamma == 0.0
    if is_untargeted and components(len(q), links(q, law.alpha.r)).any():
        raise ArgumentError("the net is disconnected and nothing else holds it together: expected one component")


def _largest(around: BondTable) -> float:
    """Return the largest radius at which floating point proposes enough curvature for a basin, by bisection."""
    d = float(around.law.alpha.d)
    shortest = min(float(distance) for _, distance in around.gaps.values())
    at_rest = around.proposed(_SMALLEST * d).mean
    if not at_rest > 0.0:
        fault = (
            f"the least curvature off the rigid motions is {at_rest:.3g}: expected a strict minimum of the potential"
        )
        raise ArgumentError(f"{fault}: expected a strict minimum; a saddle or a soft net has no basin")
    low, high = _SMALLEST * d, min(_WIDEST * d, 0.99 * shortest * float(ROOT_TWO.q) / float(ROOT_TWO.p))
    for _ in range(_BISECTIONS):
        midpoint = 0.5 * (low + high)
        low, high = (midpoint, high) if around.proposed(midpoint).mean > _LEAST * at_rest else (low, midpoint)
    return low


def _assemble_basin(around: BondTable, law: Any, computed: list[float], shells: Shells) -> Basin | None:
    """Return the basin that curvature shells prove; None if a condition of the proof is not certain."""
    u, reach = around.u, ROOT_TWO * shells.radius
    link_lengths = {pair: distance for pair, (_, distance) in around.gaps.items()}
    second_eigenvalue, degree = damping(u, link_lengths, reach)
    lowest_curvature, maximum = u.c2_gamma + u.c2_alpha * second_eigenvalue, u.c2_gamma + 2 * u.c2_alpha * degree
    curvature, surplus = (round_down(value, _STATED) for value in (shells.curvature, shells.surplus))
    apart = min((distance - ball(reach)).lower() for distance in link_lengths.values())
    if not (lowest_curvature > 0 and curvature > 0 and apart > 0 and unique_projection(u, around.rest, shells.radius)):
        return None
    bounds = Bounds(curvature, surplus, lowest_curvature, maximum)
    if not (decay_bounds := decay(bounds)).rate > 0:
        return None
    basin = Basin(
        law=law,
        rest=np.array(computed).reshape(u.n, u.m),
        radius=fraction(shells.radius),
        level=fraction(round_down(shells.level, _STATED)),
        curvature=fraction(curvature),
        damping=fraction(lowest_curvature),
        rate=fraction(decay_bounds.rate),
        overshoot=fraction(decay_bounds.overshoot),
        distance=fraction(round_down(apart, _STATED)),
        connected=second_eigenvalue > 0,
        proof=Proved(u, tuple(around.rest), BOX * u.par.d, shells, second_eigenvalue, degree, bounds, decay_bounds),
    )
    return sealed(basin)
