"""What the two theorems of Tanner, Jadbabaie and Pappas claim of a run: no collision, and rest in the end."""

from __future__ import annotations

from math import inf
from typing import Any

import numpy as np

from flockana.base.vectors import lengths
from flockana.dynamics.tolerance import FLOOR
from flockana.dynamics.trajectory import Trajectory
from flockana.theorems.asymptotics import velocities_match
from flockana.theorems.claims import judged
from flockana.theorems.limits import decay, limit_claim
from flockana.theorems.rounding import EPS, spread_error
from flockana.theorems.sampling import least_between
from flockana.theorems.theorem import Claim, Tolerances

_NOISE = 10.0  # times the absolute tolerance: what an integrator leaves of a force at rest


def energy_falls(run: Trajectory, tolerances: Tolerances, proof: str) -> Claim:
    """The claim that the energy agrees with the integral of −k₂ Σ‖p_j − p_i‖², which never rises."""
    energy, largest = run.energy(), float(np.abs(run.energy()).max()) or 1.0
    off = np.abs(run.energy_residual) / largest
    k = int(off.argmax())
    return judged(
        "energy",
        tolerances.energy - float(off[k]),
        run.n**2 * 8.0 * EPS,
        computed=float(off[k]),
        stated=f"dH/dt = -k₂ Σ‖p_j - p_i‖² over links, to {tolerances.energy:g} of the largest H",
        witness={"time": float(run.t[k])},
        proof=proof,
        detail=f"H falls from {energy[0]:.6g} to {energy[-1]:.6g}",
    )


def no_collision(run: Trajectory, i: Any, j: Any, proof: str) -> Claim:
    """The claim that some pairs never come nearer than where V alone is the energy of the start, between samples too.

    It is refuted by a sample alone. Where H(0) is small V is flat, and what rounding leaves of H(0) moves the bound.
    """
    if not len(i):
        return judged("no-collision", 1.0, 0.0, detail="no pair is joined")
    gaps = lengths(run.q[:, j] - run.q[:, i])
    k = int(gaps.min(axis=1).argmin())
    energy, blur = float(run.energy()[0]), _energy_error(run, i, j)
    least, between = float(gaps[k].min()), least_between(run, i, j)
    bound, lowest = (run.law.potential.nearest(level) for level in (energy, energy + blur))
    highest = run.law.potential.nearest(energy - blur)
    rounding = 8.0 * EPS * float(np.abs(run.q).max()) + 1e-12 * run.scales.length + max(bound - lowest, highest - bound)
    unseen = max(least - between, 0.0) if least > bound else 0.0
    return judged(
        "no-collision",
        (least - bound) / run.scales.length,
        (rounding + unseen) / run.scales.length,
        computed=least,
        stated=f"no such pair comes nearer than {bound:.6g}, where V = H(0)",
        witness={"time": float(run.t[k])},
        proof=proof,
        detail=f"the least distance at the samples is {least:.6g}, and between them at least {between:.6g}",
    )


def _energy_error(run: Trajectory, i: Any, j: Any) -> float:
    """Of the rounding of H at the start: a relative error e of d²/s² moves V by k (|d²/s² − 1| e + e²) at most."""
    q, potential = run.q[0], run.law.potential
    s = np.linalg.norm(q[j] - q[i], axis=1)
    x, e = (potential.d / s) ** 2, 8.0 * EPS * (1.0 + float(np.abs(q).max()) / s)
    moved = potential.strength * float(np.sum(np.abs(x - 1.0) * e + e * e))
    total: float = moved + run.n**2 * EPS * float(run.energy()[0]) + float(spread_error(run.p[:1])[0])
    return total


def comes_to_rest(run: Trajectory, tolerances: Tolerances, names: tuple[str, str]) -> list[Claim]:
    """The claims that relative velocities, and the forces of the potentials, tend to 0: by steady falls."""
    still = np.zeros_like(run.p[0])
    force = np.array([float(np.abs(run.law.flow(0.0, q, still)[0]).max()) for q in run.q])
    floor, noise = (
        tolerances.force * run.scales.force,
        _NOISE * FLOOR * float(run.stats.get("rtol", 0.0)) * run.scales.force,
    )
    extremal = limit_claim(
        names[1],
        [],
        [decay(run.t, force + noise, floor=floor).certificate],
        computed=float(force[-1]),
        stated=f"the largest force -> 0 (below {floor:.3g} it counts as 0)",
        witness={"time": float(run.t[-1])},
        detail=f"the largest force goes from {force[0]:.3g} to {force[-1]:.3g} at t = {run.t[-1]:g}",
    )
    return [velocities_match(run, tolerances, [], name=names[0]), extremal]


def out_of_range(run: Trajectory) -> float:
    """H(0)/V(R): as many pairs can its energy ever put out of range, at most."""
    far = float(run.law.potential.energy(run.law.r**2))
    return float(run.energy()[0]) / far if far > 0.0 else inf
