"""Rigorous verdicts on a scenario, from a tube and the certified basin at its end."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from flockana.base.errors import SolverError
from flockana.base.integrity_seals import replace_sealed
from flockana.dynamics.predicates import ensure_uninterrupted
from flockana.dynamics.trajectory import Trajectory
from flockana.theorems import Tolerances, Verdict, verify


@dataclass(frozen=True)
class Enclosure:
    """Settings for rigorous verdicts on a run: theorems, and a tube of solutions from its start over its time."""

    theorems: tuple[str, ...]  # ids of the theorems; others are checked on the run
    # whether to certify the basin of the equilibrium next to the end: what claims about limits need
    limit: bool = False
    options: Mapping[str, Any] = field(default_factory=dict)  # keyword arguments of `flockana.enclose`

    def verdict(self, name: str, run: Trajectory, *, tolerances: Tolerances | None, subject: str) -> Verdict:
        """Return the verdict of a theorem on all starts of a run's enclosure."""
        tube, basin = run.cached("enclosed", lambda: self._enclosed(run))
        return verify(name, tube, basin=basin, tolerances=tolerances, subject=subject)

    def _enclosed(self, run: Trajectory) -> tuple[Any, Any]:
        """Return the tube of solutions, and the basin of its end or None, in lengths of ℓ (the unit of σ₁)."""
        from flockana.certified.basin import certify
        from flockana.certified.enclose_run import enclose
        from flockana.certified.structural_potential import in_lengths_of_unit
        from flockana.equilibria.solve import find_equilibrium

        unit = run.law.alpha.unit
        law = in_lengths_of_unit(run.law)
        span = (float(run.t[0]), float(run.t[-1]))
        tube = ensure_uninterrupted(enclose(law, run.q[0] / unit, run.p[0] / unit, span, **self.options))
        if unit != 1.0:
            tube = replace_sealed(tube, message=f"{tube.message} (the run in lengths of ℓ, rounded)".strip())
        if not self.limit:
            return tube, None
        try:
            return tube, certify(find_equilibrium(law, tube.q[-1]))
        except SolverError:  # nothing is known of where it ends: its limit is inconclusive
            return tube, None
