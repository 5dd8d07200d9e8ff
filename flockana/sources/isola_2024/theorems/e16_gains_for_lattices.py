"""Erratum E16: α coefficients above those of γ are needed for a lattice in all cases tried, and do not suffice."""

from functools import lru_cache
from math import sqrt

import numpy as np

from flockana.equilibria.final_state import TerminalState, terminal_state
from flockana.equilibria.lattice_collapse import perturbed, pulled_law
from flockana.interactions import AlphaInteraction
from flockana.lattice import hexagonal_patch, hexagonal_spiral
from flockana.sources.geschwender_2016 import resting_place
from flockana.theorems.attraction_basin import attraction
from flockana.theorems.theorem_toolkit import Claim, Enclosure, FloatArray, Tolerances, erratum, judged, stacked

_ALPHA = AlphaInteraction(d=15.0, r=18.0, eps=0.1, h=0.1, a=3.0, b=3.0)  # the project's
_RATIO = 0.7  # c1γ/c1α: its own 70 : 100
_RINGS = 4  # of the patch of 61 agents
_SIZES, _STARTS = range(2, 8), 6  # agents that rest at c1γ = c1α, from a spiral and from random starts


@lru_cache(maxsize=1)
def _compressed_rest() -> FloatArray:
    """Return the resting positions of a hexagonal patch of 61 agents with the MSN project's gains."""
    return resting_place(_ALPHA, _RATIO, perturbed(hexagonal_patch(_RINGS, _ALPHA.d), _ALPHA.d))


def _measured(q: FloatArray, ratio: float, contact: float) -> TerminalState:
    return terminal_state(pulled_law(_ALPHA, ratio), q, 0.0 * q, contact=contact)


def _least_strain(n: int, contact: float) -> Enclosure:
    """Return the least lattice strain of n agents at rest with c1γ = c1α, over several starts."""
    rng = np.random.default_rng(0)
    starts = [perturbed(hexagonal_spiral(n, _ALPHA.d), _ALPHA.d)]
    starts += [rng.uniform(-_ALPHA.d, _ALPHA.d, (n, 2)) for _ in range(_STARTS - 1)]
    end_states = [_measured(resting_place(_ALPHA, 1.0, q), 1.0, contact) for q in starts]
    # two agents move apart by √2 of the distance to the minimum at most
    return stacked([Enclosure.around(end.strain, sqrt(2.0) * end.distance) for end in end_states]).min()


def _pair_ratio(strain: float) -> float:
    """Return the ratio c1γ/c1α at which a pair rests with a given strain, from the force balance."""
    s = (1.0 - strain) * _ALPHA.d
    return float(-2.0 * _ALPHA.phi_alpha(_ALPHA.sigma_norm(s)) / sqrt(1.0 + _ALPHA.eps * s**2))


@erratum("E16", expected={"verified": "necessary insufficient"}, ours=("insufficient",))
def theorem(tolerances: Tolerances) -> list[Claim]:
    """The MSN project says that the α coefficients "must be greater than the gamma coefficients for algorithm 2 to work
    correctly" (Alpha Agent). Where they are not, no flock that was tried rests as a lattice. It does not suffice: at
    the project's own 100 : 70 pairs of agents coincide permanently in a flock of 61. What counts is the ratio c1γ/c1α
    against a threshold that falls with n (E11).
    """
    # Flocks of 2 to 7 agents at c1γ = c1α, and 61 agents at the project's own coefficients.
    strains = stacked([_least_strain(n, tolerances.contact) for n in _SIZES])
    q = _compressed_rest()
    many = _measured(q, _RATIO, tolerances.contact)
    basin, pairs = attraction(pulled_law(_ALPHA, _RATIO), q, 0.0 * q).certificate, float(many.coincident)
    return [
        judged("necessary", strains - tolerances.quasi).described(
            computed=dict(zip(_SIZES, map(float, strains.mid), strict=True)),
            stated=f"at c1γ = c1α no flock of {_SIZES[0]} to {_SIZES[-1]} agents rests as a quasi-α-lattice",
            witness=f"{_STARTS} starts of each size",
            detail=f"the least strains are {', '.join(f'{x:.0%}' for x in strains.mid)} for n = {_SIZES[0]} to "
            f"{_SIZES[-1]}; a pair reaches {tolerances.quasi:.0%} at c1γ/c1α = {_pair_ratio(tolerances.quasi):.4g}",
        ),
        judged("insufficient", Enclosure(pairs if basin.certain else 0.0, pairs, pairs) - 0.5).described(
            computed=many.coincident,
            stated="at c1γ/c1α = 0.7 some of 61 agents coincide permanently",
            witness="a hexagonal patch relaxed by gradient flow",
            detail=f"at the project's 100 : 70, {many.coincident} pairs of 61 agents end in the same place (of its own "
            f"100 agents more: scenario msn-static), with curvature {many.curvature:.3g} of the largest: {basin.text}",
        ),
    ]
