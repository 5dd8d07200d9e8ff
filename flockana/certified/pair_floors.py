"""Lower bounds of a pair's second derivative, uniform over all displacements up to a length.

Let e be the relative displacement of a pair at rest at Δ, of length ℓ0 and direction u, and f(Δ + e) = F(|Δ + e|).
Sought are numbers α ("along") and β ("across") with

    ⟨e, ∇²f(Δ + e) e⟩ >= α ⟨u, e⟩² + β (|e|² − ⟨u, e⟩²)        for all |e| <= η.

Only the direction in which the pair has been displaced counts, which costs in β the square of η/ℓ0 and not its first
power. With ℓ = |Δ + e|, x = ℓ − ℓ0 and b = 1 − cos of the angle by which the pair has turned,

    left − right = d0 + d1 b + d2 b²,    |e|² = x² + 2 ℓ ℓ0 b,
    d0 = (F'' − α) x²,   d1 = 2x (F'' ℓ0 + α ℓ) + 2 (T ℓ0² − β ℓ²),   d2 = F'' ℓ0² − α ℓ² − T ℓ0² + β ℓ²,

F'' and T = F'/ℓ at ℓ: of one length ℓ and of b in [0, (η² − x²)/(2 ℓ ℓ0)]. Lengths are cut into cells, and these again
where their enclosures are too wide. (`proofs/certified_basins.py` checks the identity.)
"""

from dataclasses import dataclass, field

import numpy as np
from flint import arb, fmpq

from flockana.base.checks import FloatArray
from flockana.certified.balls import ball, square
from flockana.certified.structure import Structure

LEVELS = 4  # cells of the first cut: 2^4 to either side, as many as there are shells
SHELLS = 2**LEVELS
_DEEPEST = 16
_POINTS = 801  # at which floating point looks
_SPARE = (0.03, 1e-5)  # of K (η/ℓ0)², and of K: margin that a proposed β keeps


@dataclass(frozen=True)
class LengthCells:
    """Cached enclosures of F'' and T over cells of lengths about ℓ0, shared by shells."""

    u: Structure
    rest: arb
    reach: fmpq
    kept: dict[tuple[int, int], tuple[arb, arb, arb]] = field(default_factory=dict, compare=False)

    def at(self, level: int, k: int) -> tuple[arb, arb, arb]:
        """Return (x, F'', T) over x in reach·[k, k + 1]/2^level."""
        if (level, k) not in self.kept:
            unit = self.reach / 2**level
            x = ball(unit * k).union(ball(unit * (k + 1)))
            s = square(self.rest + x)
            self.kept[level, k] = x, self.u.stiffness(s), self.u.tension(s)
        return self.kept[level, k]

    def holds(self, shell: int, along: fmpq, across: fmpq) -> bool:
        """Return whether (α, β) certainly are lower bounds up to η = reach·shell/SHELLS; False also if undecided."""
        cells = [(LEVELS, k) for k in range(-shell, shell)]
        limit = square(ball(self.reach * shell / SHELLS))
        while cells:
            level, k = cells.pop()
            if self._cell_holds(level, k, limit, ball(along), ball(across)):
                continue
            if level == _DEEPEST:
                return False
            cells += [(level + 1, 2 * k), (level + 1, 2 * k + 1)]
        return True

    def _cell_holds(self, level: int, k: int, limit: arb, along: arb, across: arb) -> bool:
        x, stiff, pull = self.at(level, k)
        rest, length = self.rest, self.rest + x
        least = (stiff - along).lower()  # by its ends: a product of balls about 0 would be far too wide
        d0 = least * square(x.abs_lower() if least >= 0 else x.abs_upper())
        d1 = 2 * x * (stiff * rest + along * length) + 2 * (pull * square(rest) - across * square(length))
        d2 = (stiff - pull) * square(rest) - (along - across) * square(length)
        most = ((limit - square(x)).nonnegative_part() / (2 * length * rest)).upper()
        slope = d1.lower() + d2.lower().min(arb(0)) * most  # d1 + d2 b >= slope for b in [0, most]
        return bool(d0 + slope.min(arb(0)) * most >= 0)


def proposed_across(along: float, rest: float, x: FloatArray, stiff: FloatArray, pull: FloatArray, eta: float) -> float:
    """Return a β for an α, proposed in floating point at points x, with slack for the proof."""
    length, unit = rest + x, max(float(np.abs(stiff).max()), abs(along))
    most = np.maximum((eta**2 - x**2) / (2.0 * length * rest), 0.0)
    d1 = 2.0 * x * (stiff * rest + along * length) + 2.0 * pull * rest**2
    d2 = np.minimum((stiff - pull) * rest**2 - along * length**2, 0.0)
    turned = most > 0.0
    room = (stiff - along) * x**2 + most * (d1 + d2 * most)
    bound = np.min(room[turned] / (most * length**2 * (2.0 - most))[turned], initial=np.inf)
    bound = min(bound, float(pull[np.argmin(np.abs(x))]))
    return float(bound - _SPARE[0] * unit * (eta / rest) ** 2 - _SPARE[1] * unit)


def points(reach: float) -> FloatArray:
    """Return displacements at which floating point evaluates: the shells' ends, denser near 0."""
    inner = np.linspace(-1.0, 1.0, _POINTS) ** 3
    ends = np.arange(-SHELLS, SHELLS + 1) / SHELLS
    return reach * np.unique(np.concatenate([inner, ends]))
