"""Algorithm 1 on a directed net (agents that look ahead only): momentum and energy."""

from math import pi

import numpy as np

from flockana.interactions import AlphaInteraction
from flockana.lattice.builders import hexagonal_spiral
from flockana.laws import Algorithm1, DirectedNet
from flockana.scenarios.report_claims import Claim, Tolerances, Trajectory, finding, report
from flockana.scenarios.scenario_builders import OURS, Scenario, verified

_N = 12
_WORTH = 1e-3  # of what there is at the start: a change that counts, far above the error of the run


@report("momentum", "momentum is not conserved")
def _momentum_changes(run: Trajectory, tolerances: Tolerances) -> Claim:
    total = run.p.sum(axis=1)
    change = float(np.linalg.norm(total - total[0], axis=1).max() / np.linalg.norm(total[0]))
    detail = f"momentum is not kept: Σ p_i changes by up to {change:.3g} of its size at the start"
    return finding(change - _WORTH, detail, computed=change, stated=f"> {_WORTH:g}", error=1e-9)


@report("energy-rises", "the energy rises on the way")
def _energy_rises(run: Trajectory, tolerances: Tolerances) -> Claim:
    energy = run.metric("undirected_energy")
    rise = float((energy - np.minimum.accumulate(energy)).max() / energy[0])
    detail = f"H of the undirected law rises by up to {rise:.3g} of its value at the start"
    return finding(rise - _WORTH, detail, computed=rise, stated=f"> {_WORTH:g}", error=1e-9)


@report("directed", "most edges are one-way")
def _one_way(run: Trajectory, tolerances: Tolerances) -> Claim:
    share = float(run.metric("one_way")[0])
    detail = f"{share:.0%} of the edges at the start are one-way"
    return finding(share - 0.5, detail, computed=share, stated="more than half")


def _cone(seed: int = 0) -> Scenario:
    generator, d = np.random.default_rng(seed), AlphaInteraction().d
    q = hexagonal_spiral(_N, d) + generator.uniform(-0.3, 0.3, (_N, 2))
    title = "Twelve agents that look ahead only: momentum is not kept, energy rises"
    source_text = (
        "Ours, on the slides' remark on directed nets: Algorithm 1 with the default gains, an angle of view of 120°, "
        "twelve agents near a lattice, each coordinate displaced by up to 0.3, velocities uniform in [1, 3] × [-1, 1]."
    )
    law = DirectedNet(Algorithm1(), view=2.0 * pi / 3.0)
    p = generator.uniform((1.0, -1.0), (3.0, 1.0), (_N, 2))
    reports = (_one_way, _momentum_changes, _energy_rises)
    return Scenario(
        "directed-cone", title, source_text, law, q, p, (0.0, 3.0), seed, verified("source"), reports, references=OURS
    )


SCENARIOS = {"directed-cone": _cone}
