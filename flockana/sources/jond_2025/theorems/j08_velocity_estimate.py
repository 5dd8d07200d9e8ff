"""Erratum J8: the velocity estimate (17) of the bearing form drifts away from the velocity, and the flock disperses."""

import numpy as np

from flockana.measures.nets import components, links
from flockana.sources.jond_2025.laws.zone_flocking import ZoneFlocking
from flockana.sources.jond_2025.theorems.random_starts import SEEDS, runs_from_random_starts, zone_start
from flockana.theorems.theorem_toolkit import Claim, Tolerances, always, erratum, mostly, of_state

_SAME, _ROUNDING = 1e-9, 1e-11  # relative: forces that differ by less are the same; their rounding


def _forms(tolerances: Tolerances) -> Claim:
    """Return the claim that position and bearing form of each behaviour are equal for the true velocity."""
    worst = 0.0
    for seed in range(SEEDS):
        q, p = zone_start(seed)
        position, bearing = (ZoneFlocking(form=form).behaviours(q, p) for form in ("position", "bearing"))
        largest = max(float(np.abs(term).max()) for term in position.values())
        worst = max(worst, *(float(np.abs(position[name] - bearing[name]).max()) / largest for name in position))
    return of_state("forms", _SAME - worst, _ROUNDING, computed=worst).described(
        stated="with the true velocity both forms of all six behaviours are equal",
        witness={"starts": SEEDS},
        detail=f"with the true velocity position and bearing form agree to {worst:.1g}: (12)-(15) are right",
    )


@erratum("J8", expected={"verified": "forms measured", "refuted": "equivalent holds-together"}, corrected=("measured",))
def theorem(tolerances: Tolerances) -> list[Claim]:
    """Remark 3 calls the bearing form with the estimate (17) equivalent. (17) leaves out the global speed term and both
    bounds: estimates drift away from the velocities, and the flock disperses.
    """
    laws = (ZoneFlocking(own_velocity=name) for name in ("estimated", "measured"))
    estimated_runs, measured_runs = map(runs_from_random_starts, laws)
    drift = [float(np.linalg.norm(run.extra["estimate"][-1] - run.p[-1], axis=1).mean()) for run in estimated_runs]
    flocks = [int(components(run.n, links(run.q[-1], 5.0)).max()) + 1 for run in estimated_runs]
    is_connected = [not components(run.n, links(run.q[-1], 5.0)).any() for run in measured_runs]
    return [
        _forms(tolerances),
        always(
            "equivalent",
            [error < 0.1 for error in drift],
            "with (17) the estimate is within 0.1 m/s of the velocity after 20 s",
            "the estimate (17) makes the bearing form equivalent (Remark 3)",
        ).described(witness={"mean error of the estimate, by seed": drift}),
        always(
            "holds-together",
            [count == 1 for count in flocks],
            f"with (17) the flock is one component ({np.median(flocks):g} in the median)",
            "the flock stays together with the estimate as well",
        ).described(witness={"components by seed": flocks}),
        mostly("measured", is_connected, "with the true velocity the flock is one component", "odometry repairs it"),
    ]
