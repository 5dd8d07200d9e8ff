"""Olfati-Saber and Murray: consensus tolerates a delay up to π/(2 λ_n), compared with the library's delay margin."""

from dataclasses import replace
from fractions import Fraction
from math import pi
from typing import Any

import numpy as np

from flockana.interactions import Gains
from flockana.lattice import hexagonal_patch
from flockana.laws.olfati_saber import Algorithm1
from flockana.measures.nets import laplacian
from flockana.stability.consensus import consensus_root, consensus_system
from flockana.stability.delay import DelaySystem, delay_margin
from flockana.stability.delay_roots import rightmost_roots, root_error
from flockana.stability.law_studies import delay_system
from flockana.theorems.theorem_toolkit import EPS, Claim, FloatArray, Tolerances, erratum, of_state, spectral
from flockana.theorems.tube_claims import decided

_PROOF = "delayed-consensus"
_AROUND = Fraction(1, 100)  # of the margin: how far to either side roots are looked at
_DIGITS = 30
_SWEEP = 1e-9  # relative: to which a sweep locates a crossing that double roots blur to √eps at most


def _net(n: int, pairs: list[tuple[int, int]]) -> FloatArray:
    return laplacian(n, np.array(pairs, dtype=np.int32)).toarray()


def _nets() -> dict[str, tuple[DelaySystem, float]]:
    """Return example nets by name, each as its delay system and largest Laplacian eigenvalue λ_n."""
    path, ring = [(0, 1), (1, 2)], [(k, (k + 1) % 6) for k in range(6)]
    star, whole = [(0, k) for k in range(1, 5)], [(i, j) for j in range(4) for i in range(j)]
    known_nets = {
        "path of 3": (_net(3, path), 3.0),
        "ring of 6": (_net(6, ring), 4.0),
        "star of 5": (_net(5, star), 5.0),
        "complete net of 4": (_net(4, whole), 4.0),
    }
    law = Algorithm1(gains=Gains(c1_alpha=0.0, c2_alpha=1.0))
    flock = delay_system(law, hexagonal_patch(1, law.alpha.length))
    top = float(np.linalg.eigvalsh(flock.late[1])[-1])
    nets = {name: (consensus_system(matrix), largest) for name, (matrix, largest) in known_nets.items()}
    free = replace(flock, neutral=consensus_system(flock.late[1]).neutral)  # nothing holds any place, not only rigidly
    return nets | {"hexagon of 7 under Algorithm 1 without its gradient": (free, top)}


def _margin(nets: dict[str, tuple[DelaySystem, float]]) -> Claim:
    """Return the claim that the library's delay margin (frequency sweep) agrees with the closed form."""
    off, margins = 0.0, {}
    for name, (system, largest) in nets.items():
        margin = delay_margin(system)
        margins[name] = margin.delay
        off = max(off, abs(margin.delay * 2.0 * largest / pi - 1.0), abs(margin.frequency / largest - 1.0))
    return spectral("margin", _SWEEP - off, 0.0, computed=margins).described(
        stated="π/(2 λ_n), where the net swings at the frequency λ_n",
        detail=f"of {len(nets)} nets the delay margin that a sweep over frequency finds is π/(2 λ_n), to {off:.1g}",
    )


def _side(name: str, sign: int, nets: dict[str, tuple[DelaySystem, float]]) -> Claim:
    """Return the claim on the sign of the rightmost root for a delay 1 % off the margin, on example nets."""
    share = 1.0 + sign * float(_AROUND)
    margin, error, deviation, real_parts = np.inf, 0.0, 0.0, {}
    for net, (system, largest) in nets.items():
        delay = share * pi / (2.0 * largest)
        root = complex(rightmost_roots(system, delay, count=2)[0])
        sharp_error = root_error(system, root, delay)
        real_parts[net] = root.real
        deviation = max(deviation, abs(abs(root) - abs(consensus_root(largest, delay))) / largest if sign > 0 else 0.0)
        if sign * root.real / largest - sharp_error / largest < margin - error:
            margin, error = sign * root.real / largest, sharp_error / largest
    words, side = ("grows", "right") if sign > 0 else ("decays", "left")
    closed_text = f"; it is Lambert's W(-λ_n τ)/τ, to {deviation:.1g}" if sign > 0 else ""
    return spectral(name, margin, error, computed=real_parts).described(
        stated=f"at {share:g} times π/(2 λ_n) the slowest motion off the consensus {words}",
        detail=f"in {len(nets)} nets the rightmost root except the consensus's is at least {margin:.3g} λ_n {side} of "
        f"the imaginary axis{closed_text}",
    )


def root_enclosure(share: Fraction) -> Any:
    """Return a ball around the rightmost root of s + e^(−sτ) = 0, from Lambert's W."""
    # Of another λ the root is λ times this one, at τ over λ: λτ alone counts.
    from flint import acb, arb, ctx

    from flockana.certified.balls import ball

    with ctx.workdps(_DIGITS):
        delay = ball(share) * arb.pi() / 2
        return acb(-delay).lambertw() / delay


def _exact(name: str, sign: int) -> Claim:
    """Return the claim on the sign of one mode's rightmost root 1 % off the delay margin, by Lambert's W₀."""
    share = 1 + sign * _AROUND
    root = root_enclosure(share)
    return decided(name, sign * root.real, proof=_PROOF).described(
        computed=str(root.real),
        stated=f"Re s {'>' if sign > 0 else '<'} 0 at λτ = {share} π/2",
        witness=str(root),
        detail=f"s = W(-λτ)/τ: Re s/λ in {root.real.str(8)}, Im s/λ in {root.imag.str(8)}",
    )


def _average(nets: dict[str, tuple[DelaySystem, float]]) -> Claim:
    """Return the claim that the agreed value is the mean of the start for any delay."""
    deviation = max(float(np.abs(system.late[1].sum(axis=0)).max()) / largest for system, largest in nets.values())
    agent_count = max(len(system.late[1]) for system, _ in nets.values())
    return of_state("average", agent_count * EPS - deviation, 0.0, proof=_PROOF, computed=deviation).described(
        stated="the sum over the agents never changes, so that they agree on the average of the start",
        detail=f"the columns of L sum to 0, to within {deviation:.1g} λ_n",
    )


@erratum(
    "delayed-consensus",
    title="Consensus bears a delay below π/(2 λ_n), and none above",
    source="Olfati-Saber and Murray 2004, Theorem 10, in our words",
    references=("olfati-saber-murray-2004",),
    expected={"verified": "margin below above root-below root-above average"},
)
def theorem(tolerances: Tolerances) -> list[Claim]:
    """Agents x' = -L x(t - τ) on a fixed, undirected, connected net agree on the average of their start, whatever it
    is, if and only if 0 <= τ < π/(2 λ_n), λ_n the largest eigenvalue of L; at π/(2 λ_n) they oscillate at the frequency
    λ_n. Compared with the delay margin that the library finds for any flock, on nets whose spectrum is known, and with
    the rightmost root just below and just above it.
    """
    nets = _nets()
    sides, roots = (("below", -1), ("above", 1)), (("root-below", -1), ("root-above", 1))
    return [_margin(nets), *(_side(*side, nets) for side in sides), *(_exact(*root) for root in roots), _average(nets)]
