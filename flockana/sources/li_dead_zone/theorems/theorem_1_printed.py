"""Printed Theorem 1 of the dead-zone paper: one flock within r, a falling energy, one velocity, no collision."""

from flockana.measures.metrics import cohesion_radius
from flockana.sources.li_dead_zone.laws.dead_zone import DeadZoneFlocking
from flockana.sources.li_dead_zone.theorems import common_claims as case
from flockana.sources.li_dead_zone.theorems.net_components import Components
from flockana.sources.li_dead_zone.theorems.range_limits import first_entry
from flockana.theorems.rounding_bounds import frame_error
from flockana.theorems.theorem import Checked, Claim, Hypothesis, Tolerances, unmet
from flockana.theorems.theorem_toolkit import EPS, Certificate, Enclosure, Observed, counted, limit_claim, run_theorem


def _certain_radius(seen: Observed, end: Components, radius: float) -> tuple[Enclosure | None, str]:
    """Return 1 − R/r in the limit, R the cohesion radius, and its certificate; None where unknown."""
    if end.count > 1:
        separation = end.separation
        return Enclosure.around(-separation.margin, separation.error) if separation.certain else None, separation.text
    (whole,), r = end.members, end.r
    basin_certificate = whole.basin.certificate
    if whole.size == 1 or basin_certificate.certain:
        error = (whole.basin.reach + 2.0 * whole.off + 2.0 * frame_error(seen.run.q[-1:])) / r + 4.0 * EPS
        return Enclosure.around(1.0 - radius / r, error), basin_certificate.text
    if whole.dt is None and whole.radius < r:
        text = f"{whole.bond.text}, and no agent {whole.radius:.4g} away from the centre"
        return Enclosure.around(1.0 - whole.radius / r, 4.0 * EPS), text
    return None, basin_certificate.text


def _cohesion(seen: Observed, end: Components, needs: list[Hypothesis]) -> Claim:
    """Return the claim that the cohesion radius R is at most the range r in the limit."""
    radius = cohesion_radius(seen.run.q[-1])
    margin, is_certain = _certain_radius(seen, end, radius)
    inner_margin, outer_margin = (-1.0, -1.0) if margin is None else (float(margin.lo), float(-margin.hi))
    return limit_claim(
        "cohesion", needs, [Certificate(inner_margin, "", 0.0)], escape=Certificate(outer_margin, "", 0.0)
    ).described(
        computed=radius,
        stated=f"in the end no agent is farther than r = {end.r:g} from the leader (read: the centre of mass)",
        witness={"components": end.count, "time": float(seen.t[-1])},
        detail=f"at t = {seen.t[-1]:g} there are {end.count} component(s), R = {radius:.4g}; {is_certain}",
    )


def _energy(seen: Observed, law: DeadZoneFlocking, needs: list[Hypothesis]) -> Claim:
    """Return the claim that the energy of neighbours never rises, refuted by a pair entering the range."""
    # Otherwise it is H̄ less a constant, or falls by ψ̄(r) as a pair leaves. That no pair comes in is a whole number.
    jump, entry = law.interaction.far_potential, first_entry(seen, law.interaction.r)
    has_entry = entry.pair is not None and jump > 0.0
    possible_entries = int(has_entry or (entry.unsure and jump > 0.0))
    detail = "no pair comes into range"
    if has_entry:
        detail = f"agents {entry.pair} come into range of each other before t = {entry.time:.6g}: H rises by {jump:.4g}"
    elif jump == 0.0:
        detail = "the potential of a pair is 0 at r: nothing jumps"
    elif entry.unsure:
        detail = "between the samples, or within the run's error, a pair may come into range"
    return counted("energy", 0, int(has_entry), possible_entries, needs, computed=jump if has_entry else 0.0).described(
        stated="H, summed over neighbours, never rises",
        witness={"agents": entry.pair, "time": entry.time},
        detail=detail,
    )


@run_theorem(
    "dead-zone-1-printed",
    title="Dead-zone flocking as printed: cohesion, falling energy, one velocity, no collision",
    source="Li, Yuan and Liu, Theorem 1 (its proof is omitted there)",
    law=case.applied,
    claims=("cohesion", "energy", "velocity", "collision"),
    references=("li-dead-zone",),
)
def theorem(seen: Observed, tolerances: Tolerances) -> Checked:
    """From finite initial energy, agents form cohesive flocks with no agent farther than r from its virtual leader; the
    energy does not rise, the flock ends in a local minimum and velocities match; no two agents collide. No leader
    appears in the law: its centre of mass is taken instead. Connectivity is not implied (L4), the energy of neighbours
    jumps (L5), velocities match within components only (L7); the last claim is true (L6).
    """
    requirements, law = case.hypotheses(seen), case.dead_zone_law(seen.run)
    if law is None or unmet(requirements):
        return requirements, []
    end = case.final_components(seen, law)
    return requirements, [
        _cohesion(seen, end, requirements),
        _energy(seen, law, requirements),
        case.velocities_match(seen, end, requirements, name="velocity"),
        case.no_collision(seen, law, Enclosure.of(0.0), requirements, name="collision"),
    ]
