"""Claims about limits that several theorems share: velocities match, the flock ends as a lattice."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

import numpy as np

from flockana.base.checks import FloatArray
from flockana.base.scales import Scales
from flockana.dynamics.tolerance import FLOOR
from flockana.dynamics.trajectory import Trajectory
from flockana.equilibria.terminal import TerminalState, terminal_state
from flockana.lattice import classify
from flockana.laws.olfati_saber import Algorithm1
from flockana.measures.nets import link_lengths, links
from flockana.theorems.basin import Basin
from flockana.theorems.claims import judged
from flockana.theorems.limits import Certificate, decay, limit_claim
from flockana.theorems.olfati_saber.attraction import final_basin
from flockana.theorems.rounding import EPS, frame_error
from flockana.theorems.theorem import Claim, Hypothesis, Tolerances

_NOISE = 10.0  # times the absolute tolerance


def numerical_noise(run: Trajectory, scale: float) -> float:
    """Motion that an integrator leaves in a flock at rest: some of its absolute tolerances; a map leaves none."""
    if "rtol" not in run.stats:
        return 0.0
    given = run.stats.get("atol")
    return _NOISE * float(FLOOR * run.stats["rtol"] if given is None else given / run.scales.length) * scale


def rest_certificate(run: Trajectory, tolerances: Tolerances) -> Certificate:
    """Certificate that all relative motion dies out: the rms relative velocity decays to what counts as 0."""
    speed = (
        np.sqrt(run.metric("normalised_velocity_mismatch"))
        + frame_error(run.p)
        + numerical_noise(run, run.scales.speed)
    )
    falls = decay(run.t, speed, floor=float(np.sqrt(tolerances.velocity)) * run.scales.speed).certificate
    return replace(falls, text=f"√K̃: {falls.text}")


def velocities_match(
    run: Trajectory,
    tolerances: Tolerances,
    needs: Iterable[Hypothesis],
    *,
    name: str,
    caught: Iterable[Certificate] = (),
) -> Claim:
    """The claim that velocities match in the moving frame: K̃ decays steadily, or another certificate says so."""
    series = run.metric("normalised_velocity_mismatch")
    return limit_claim(
        name,
        needs,
        [*caught, rest_certificate(run, tolerances)],
        computed=float(series[-1]),
        stated=f"K̃ -> 0 (below {tolerances.velocity:g} of the law's speed² it counts as 0)",
        witness={"time": float(run.t[-1]), "K̃ at the start": float(series[0])},
        detail=f"velocities match: K̃ goes from {series[0]:.3g} to {series[-1]:.3g} at t = {run.t[-1]:g}",
    )


def settled(end: TerminalState, tolerances: Tolerances, scales: Scales) -> bool:
    """Whether a terminal state is an equilibrium of the structural dynamics within tolerance, attracting or not."""
    return end.force <= tolerances.force and end.mismatch <= tolerances.velocity * scales.energy


def _strains(run: Trajectory) -> FloatArray:
    """Largest |link − d|/d at each sample; 1 without links."""
    d, strains = run.law.alpha.d, np.ones(len(run.t))
    for k, q in enumerate(run.q):
        lengths = link_lengths(q, links(q, run.law.alpha.r))
        if lengths.size:
            strains[k] = float(np.abs(lengths - d).max()) / d
    return strains


def lattice_limit(run: Trajectory, needs: Iterable[Hypothesis], tolerances: Tolerances, *, name: str) -> Claim:
    """The claim that the limit is an α-lattice; a strained limit refutes it only if it is a strict minimum.

    Where the flock is caught by a strict minimum, the limit is known up to its distance from there. In a net that can
    flex there is none: then the largest strain and the relative speeds must both decay to what counts as 0. An
    equilibrium with c1γ > 0 is no lattice, as λJ presses on every link: what little it may be verifies nothing.
    """
    end = terminal_state(run.law, run.q[-1], run.p[-1], contact=tolerances.contact)
    caught, margin = final_basin(run), tolerances.lattice - end.strain
    pressed = not isinstance(run.law, Algorithm1) and run.law.gains.c1_gamma > 0.0
    if caught.certificate.margin > 0.0:
        certificate, error = caught.certificate, _strain_error(run, caught)
    else:
        strains = _strains(run) + numerical_noise(run, run.scales.length) / run.law.alpha.d
        falls = decay(run.t, strains, floor=tolerances.lattice).certificate
        both = rest_certificate(run, tolerances), replace(falls, text=f"strain: {falls.text}")
        certificate = min(both, key=lambda each: each.margin)
        margin, error = min(margin, certificate.margin), certificate.error
    kind = classify(end.strain, lattice=tolerances.lattice, quasi=tolerances.quasi)
    return judged(
        name,
        margin,
        error,
        needs,
        verifies=not pressed,
        refutes=caught.certificate.margin > 0.0,
        computed=end.strain,
        stated=f"|link - d|/d <= {tolerances.lattice:g} in the limit",
        witness={"force": end.force, "links": end.links, "curvature": end.curvature},
        detail=f"at the end: {kind}, links {end.shortest:.6g} to {end.longest:.6g}, residual force {end.force:.2g}; "
        f"{certificate.text}" + ("; λJ presses on every link" if pressed else ""),
    )


def _strain_error(run: Trajectory, caught: Basin) -> float:
    """How far strains of the limit may be from those of the last state: two agents move by √2 δ apart at most."""
    rounding = 4.0 * EPS * float(np.abs(run.q[-1]).max())
    return float((np.sqrt(2.0) * caught.distance + rounding) / run.law.alpha.d)
