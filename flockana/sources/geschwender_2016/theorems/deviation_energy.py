"""The slides' remark that the deviation energy is nonsmooth while the potential V is smooth: true, and shown."""

from collections.abc import Callable

import numpy as np

from flockana.interactions import AlphaInteraction
from flockana.measures.metrics import deviation_energy
from flockana.theorems.theorem_toolkit import Claim, Tolerances, erratum, of_state

_NEAR = 2.0**-20  # of r: how close to the range from within, and of d to coincidence
_ROUNDING = 1e-13  # relative, of an energy of two agents
PROOF = "deviation-energy"


def _jump(name: str, energy: Callable[[float], float], r: float, stated: float, symbol: str) -> Claim:
    """Return the claim that an energy jumps at the interaction range by the stated value."""
    within, at = energy(r * (1.0 - _NEAR)), energy(r)
    scale = max(within, at)
    return of_state(name, 32.0 * _NEAR * scale - abs(within - at - stated), _ROUNDING * scale, proof=PROOF).described(
        computed=within - at,
        stated=f"{symbol}(r⁻) − {symbol}(r) = {stated:.6g}",
        witness={"distance": [r * (1.0 - _NEAR), r], symbol: [within, at]},
        detail=f"{symbol} of a pair is {within:.6g} just within r and {at:.6g} at r"
        + (": it jumps" if stated else ": it does not jump"),
    )


def _corner(
    name: str, energy: Callable[[float], float], stated: float, units: tuple[float, float], symbol: str
) -> Claim:
    """Return the claim that an energy's slope changes by the stated value as one agent passes through another."""
    step = _NEAR * units[1]
    change = -2.0 * (energy(step) - energy(0.0)) / step  # of |x|: the slope on the left is the opposite
    return of_state(
        name,
        64.0 * _NEAR * units[0] - abs(change - stated),
        _ROUNDING * max(energy(0.0), energy(step)) / step,
        computed=change,
        stated=f"{symbol}'(0⁻) − {symbol}'(0⁺) = {stated:.6g}",
        witness={"step": step},
        proof=PROOF,
        detail=f"where two agents coincide the slope of {symbol} changes by {change:.6g}",
    )


@erratum(
    "deviation-energy",
    title="The deviation energy is not smooth, V is",
    source="slides, smooth potentials: 'deviation energy is nonsmooth'",
    expected={"verified": "jump corner potential-continuous potential-smooth"},
)
def theorem(tolerances: Tolerances) -> list[Claim]:
    """The deviation energy E(q) jumps by ⅔(r − d)² where a pair comes into range and has a corner where two agents
    coincide; the potential V(q) of the same pair is continuously differentiable at both.
    """
    # Check a pair of the paper's law within range, at the range, and passing through coincidence.
    alpha = AlphaInteraction()
    d, r = alpha.d, alpha.r

    def deviation(x: float) -> float:
        return deviation_energy([[0.0], [x]], d, r)

    def potential(x: float) -> float:
        return alpha.potential_energy(np.array([[0.0], [x]]))

    return [
        _jump("jump", deviation, r, 2.0 / 3.0 * (r - d) ** 2, "E"),
        _corner("corner", deviation, 8.0 / 3.0 * d, (d, d), "E"),
        _jump("potential-continuous", potential, r, 0.0, "V"),
        _corner("potential-smooth", potential, 0.0, (alpha.c_star / d, d), "V"),
    ]
