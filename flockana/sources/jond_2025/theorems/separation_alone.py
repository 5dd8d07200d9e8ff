"""Section 4 of the bearing-distance paper: separation alone oscillates, alignment damps it."""

from math import pi, sqrt
from typing import Any

import numpy as np

from flockana.measures.perception import both_ways
from flockana.sources.jond_2025.laws.minimal import MinimalFlocking
from flockana.theorems.theorem_toolkit import (
    Claim,
    Enclosure,
    FloatArray,
    Tolerances,
    erratum,
    judged,
    observed,
    stacked,
)

_RHO, _MU, _STRETCH = 2.0, 3.0, 0.5
_PERIODS, _PER_PERIOD = 20, 40  # how many, and samples of each
_PATH = both_ways([(0, 1), (1, 2), (2, 3), (3, 4)])
_TIGHT: dict[str, Any] = {"rtol": 1e-11, "atol": 1e-12}


def _crossings(t: FloatArray, y: FloatArray) -> FloatArray:
    """Return the times at which a sampled signal y rises through zero, by linear interpolation."""
    k = np.flatnonzero((y[:-1] < 0.0) & (y[1:] >= 0.0))
    return t[k] - y[k] * (t[k + 1] - t[k]) / (y[k + 1] - y[k])


def _pair(tolerances: Tolerances) -> Claim:
    """Return the claim that two agents without rotation are a harmonic oscillator: y'' = −2μ y, y = ‖x‖ − ρ."""
    law = MinimalFlocking(edges=both_ways([(0, 1)]), spacing=_RHO, mu=_MU, sigma=0.0)
    period = 2.0 * pi / sqrt(2.0 * _MU)
    times = np.linspace(0.0, _PERIODS * period, _PER_PERIOD * _PERIODS + 1)
    start = np.array([[0.0, 0.0], [_RHO + _STRETCH, 0.0]])
    observation = observed(law, start, 0.0 * start, (0.0, times[-1]), t_eval=times, **_TIGHT)
    y = observation.distances([0], [1])[:, 0] - _RHO
    measured_period = float(np.diff(_crossings(observation.t, y.mid)).mean())
    amplitude = float(np.abs(y.mid[-_PER_PERIOD:]).max())
    return judged(
        "alone",
        tolerances.agreement - abs(y - _STRETCH * np.cos(2.0 * pi / period * times)) / _STRETCH,
        computed={"period": measured_period, "amplitude at the end": amplitude},
        stated={"period": period, "amplitude": _STRETCH},
        witness={"q(0)": start.tolist(), "p(0)": "0"},
        detail=f"two agents swing about ρ with period {measured_period:.5g} = 2π/sqrt(2μ), with amplitude "
        f"{amplitude:.4g} after {_PERIODS} periods, as at the start",
    )


def _path_energy(sigma: float) -> Enclosure:
    law = MinimalFlocking(edges=_PATH, spacing=_RHO, mu=_MU, sigma=sigma, normalised=False)
    rng = np.random.default_rng(4)
    q = np.cumsum(rng.uniform(-_RHO, _RHO, (5, 2)), axis=0)
    return observed(law, q, rng.uniform(-1.0, 1.0, q.shape), (0.0, 60.0), **_TIGHT).energy


def _conserved(tolerances: Tolerances) -> Claim:
    """Return the claim on five agents on a path: H is conserved without alignment, and lost with it."""
    lone_energy, aligned_energy = map(_path_energy, (0.0, 1.0))
    drift, left = abs(lone_energy / lone_energy[0] - 1.0).max(), aligned_energy[-1] / aligned_energy[0]
    return judged("energy", tolerances.energy - stacked([drift, left])).described(
        computed={"drift of H without alignment": float(drift.mid), "H(T)/H(0) with it": float(left.mid)},
        stated=f"H keeps its value by separation alone, and with alignment {tolerances.energy:g} of it is left at most",
        witness={"agents": 5, "graph": "a frozen undirected path", "H(0)": float(lone_energy.mid[0])},
        detail=f"on a path of five H keeps its value to {drift.mid:.1g} over 60 time units; with alignment "
        f"{left.mid:.1g} of it is left",
    )


def _resonance(tolerances: Tolerances) -> Claim:
    """Return the claim of resonance in a directed chain: y₂ = ½ a ω t sin ωt grows."""
    law = MinimalFlocking(edges=((0, 1), (1, 2)), spacing=_RHO, mu=_MU, sigma=0.0)
    a, omega = 0.01, sqrt(_MU)
    start = np.array([[0.0], [_RHO + a], [2.0 * _RHO + a]])
    end = 2.0 * pi * _PERIODS / omega
    times = np.linspace(0.0, end, _PER_PERIOD * _PERIODS + 1)
    observation = observed(law, start, 0.0 * start, (0.0, end), t_eval=times, **_TIGHT)
    y = observation.distances([1], [2])[:, 0] - _RHO
    ratio, stated_value = float(np.abs(y.mid[-_PER_PERIOD:]).max()) / a, 0.5 * omega * (end - 0.5 * pi / omega)
    return judged(
        "chain",
        tolerances.agreement - abs(y / a - 0.5 * omega * times * np.sin(omega * times)) / stated_value,
        computed=ratio,
        stated=stated_value,
        witness={"q(0)": start.tolist(), "edges": law.edges},
        detail=f"on a directed chain the second edge swings {ratio:.4g} times as far as the first after {_PERIODS} "
        f"periods, and ever farther: resonance, ω t/2 = {stated_value:.4g}",
    )


def _close_encounter() -> Claim:
    """Return the claim that alignment does not prevent collisions: y(t) = −v exp(−t) sin t reaches −ρ for v > 3.1 ρ."""
    law = MinimalFlocking(edges=both_ways([(0, 1)]), spacing=1.0)
    q, p = np.array([[0.0], [1.0]]), np.array([[2.0], [-2.0]])
    seen = observed(law, q, p, (0.0, 2.0), **_TIGHT)
    gap = Enclosure.around(seen.run.q[:, 1, 0] - seen.run.q[:, 0, 0], seen.shape_error.sum(axis=1)).min()
    return judged("close-encounters", gap, about="all", computed=float(gap.mid)).described(
        stated="with alignment agents avoid close encounters (separation > 0)",
        witness={"q(0)": q.tolist(), "p(0)": p.tolist()},
        detail="two agents at the desired spacing, closing in by four of it per time unit, pass through each other",
    )


@erratum(
    "zone-separation",
    expected={"verified": "alone energy chain", "refuted": "close-encounters"},
    ours=("energy", "chain"),
)
def theorem(tolerances: Tolerances) -> list[Claim]:
    """Section 4 says that the separation (25) alone oscillates, and that alignment (24) brings a common motion and
    avoids close encounters. Two agents swing about the desired spacing with frequency sqrt(2μ), undamped; on reciprocal
    graphs H is conserved, on a directed chain the oscillation even grows. Alignment damps it, but does not exclude
    collisions: two agents that are fast enough meet.
    """
    return [_pair(tolerances), _conserved(tolerances), _resonance(tolerances), _close_encounter()]
