"""Limit claims shared by several theorems: velocities match, the flock ends as a lattice."""

from collections.abc import Iterable
from math import sqrt
from typing import Any

from flockana.base.errors import SolverError
from flockana.base.natural_scales import Scales
from flockana.equilibria.final_state import TerminalState, terminal_state
from flockana.lattice import classify
from flockana.laws.olfati_saber import Algorithm1
from flockana.theorems.attraction_basin import final_basin
from flockana.theorems.claims import undecided
from flockana.theorems.energy_basins import Basin
from flockana.theorems.limit_certificates import decays_to_zero
from flockana.theorems.theorem_toolkit import (
    EPS,
    Certificate,
    Claim,
    Enclosure,
    Needs,
    Observed,
    Tolerances,
    limit_claim,
)


def velocities_match(
    seen: Observed, needs: Needs, *, name: str, caught: Iterable[Certificate] = (), proof: str | None = None
) -> Claim:
    """Return the claim that velocities match in the moving frame in the limit, by certificate or proof."""
    what: dict[str, Any] = {"what": "velocity mismatch K̃", "of": "K̃", "start": "K̃ at the start"}
    return decays_to_zero(seen, name, needs, caught, series=seen.mismatch.mid, stated="K̃ -> 0", proof=proof, **what)


def settled(end: TerminalState, tolerances: Tolerances, scales: Scales) -> bool:
    """Return whether a terminal state is an equilibrium of the structural dynamics within tolerance."""
    return end.force <= tolerances.force and end.mismatch <= tolerances.velocity * scales.energy


def lattice_limit(seen: Observed, needs: Needs, tolerances: Tolerances, *, name: str) -> Claim:
    """Return the claim that the limit is an α-lattice, decided if the flock stays near a strict minimum."""
    # There the limit is known up to its distance. An equilibrium with c1γ > 0 is no lattice, as λJ presses on every
    # link, so that a small strain verifies nothing.
    try:
        end = terminal_state(seen.law, *seen.end[:2], contact=tolerances.contact)
    except SolverError as why:
        return undecided(name, str(why), about="limit")
    caught = final_basin(seen)
    is_pressed = not isinstance(seen.law, Algorithm1) and seen.law.gains.c1_gamma > 0.0
    margin, is_certain = tolerances.lattice - limit_strain(seen, end, caught), caught.certificate.certain
    kind = classify(end.strain, lattice=tolerances.lattice, quasi=tolerances.quasi).replace("neither", "no lattice")
    decides = [Certificate(float(margin.lo), caught.certificate.text, 0.0)] if is_certain and not is_pressed else []
    strain_certificate = Certificate(float(-margin.hi), caught.certificate.text, 0.0) if is_certain else None
    return limit_claim(name, needs, decides, escape=strain_certificate, computed=end.strain).described(
        stated=f"|link - d|/d <= {tolerances.lattice:g} in the limit",
        witness={"force": end.force, "links": end.links, "curvature": end.curvature},
        detail=f"at the end: {kind}, links {end.shortest:.6g} to {end.longest:.6g}, residual force {end.force:.2g}"
        + ("" if is_certain else f"; {caught.certificate.text}")
        + ("; λJ compresses every link" if is_pressed else ""),
    )


def limit_strain(seen: Observed, end: TerminalState, caught: Basin) -> Enclosure:
    """Return the largest relative link strain |link − d|/d at the minimum near a run's last state."""
    rounding = 4.0 * EPS * float(abs(seen.run.q[-1]).max())
    return Enclosure.around(end.strain, (sqrt(2.0) * caught.distance + rounding) / seen.law.alpha.d)
