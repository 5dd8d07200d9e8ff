"""Verdicts of theorems on motion for runs in fixed steps (`FixedSteps`).

A theorem about a flow is vacuous of a run in steps; definitions about samples hold of one as they stand. Of the energy
identity and of Theorem 6 the library says more: the energy loses in each step what it loses along the flow, and changes
by the scheme's own defect; whether it falls nevertheless is seen.
"""

from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import cache

import numpy as np

from flockana.recorded.one_step_predictions import predicted
from flockana.solvers.fixed_steps import FixedSteps
from flockana.theorems.catalogue import theorem_modules
from flockana.theorems.theorem import Claim, Hypothesis, Known, Theorem, Tolerances
from flockana.theorems.theorem_toolkit import EPS, Enclosure, Observed, Trajectory, judged

_FINE = 8  # times finer than usual the flow is integrated


@cache
def claims_on_steps() -> Mapping[str, tuple[str, Callable[[Observed], int]]]:
    """Return claims for fixed-step runs by theorem, with their first samples, from the modules' `STEPS`."""
    return {name: meaning for module in theorem_modules() for name, meaning in getattr(module, "STEPS", {}).items()}


def scheme_note(item: Theorem) -> str:
    """Return a sentence on a theorem's meaning for fixed-step runs; empty for other theorems."""
    if item.kind != "trajectory":
        return ""
    if item.id in claims_on_steps():
        return f"For the run of a scheme: {claims_on_steps()[item.id][0]}."
    if item.law is None:
        return "For the run of a scheme: the same, as the theorem is about samples or has its law among its hypotheses."
    return "For the run of a scheme: nothing, as the theorem is about the law's flow, unless it names the scheme."


def is_about_steps(item: Theorem, seen: Observed) -> bool:
    """Return whether a theorem is about the law behind a fixed-step run, and not about the scheme."""
    law = seen.law
    if not isinstance(law, FixedSteps) or item.kind != "trajectory" or item.law is None:
        return False
    return item.law(seen).status == "unmet" and item.law(_of_law(seen, law)).status != "unmet"


def on_steps(item: Theorem, seen: Observed, tolerances: Tolerances) -> Known:
    """Return the verdict of a flow theorem on a fixed-step run: vacuous claims, and flockana's own."""
    law: FixedSteps = seen.law
    detail = f"the run is in steps of {law.dt:g} of {law.law.title} by {law.title}"
    missed = Hypothesis("the law acts in continuous time", "unmet", detail=detail)
    if item.id not in claims_on_steps() or len(seen.t) < 2:
        return (missed,), item.vacuous_claims(missed)
    flow = _of_law(seen, law)
    requirements, _ = item.check(flow, tolerances)
    start_index = claims_on_steps()[item.id][1](flow)
    return (missed,), (*item.vacuous_claims(missed), *_of_energy(seen.run, start_index, list(requirements), tolerances))


def _of_law(seen: Observed, law: FixedSteps) -> Observed:
    """Return a fixed-step run as samples of its law; nothing is known of the states between them."""
    run = seen.run
    extra_series = {"work": np.zeros(len(run.t))}  # which only the law's own balance asks for: it is not used here
    return Observed.alone(Trajectory(run.t, run.q, run.p, run.u, law.law, extra_series))


def _of_energy(given: Trajectory, since: int, needs: list[Hypothesis], tolerances: Tolerances) -> list[Claim]:
    """Return two claims: the energy falls at every sample, and rises at most by the scheme's defect."""
    run, law = given.window(float(given.t[since]), float(given.t[-1])), given.law.law
    energy = run.energy()
    unit, rounding = float(np.abs(energy).max()) or 1.0, (run.n**2 + 64) * EPS
    ends = [predicted(law, run.t, run.q, run.p, refine=refinement) for refinement in (_FINE, _FINE // 2)]
    t = run.t[1:].tolist()
    led, rough = (np.array([law.hamiltonian(*row) for row in zip(t, *end, strict=True)]) for end in ends)
    change, defect = np.diff(energy), energy[1:] - led
    worst, total = int(np.argmax(np.abs(defect))), float(defect.sum())
    text = f"the scheme's defect is {defect[worst]:.3g} at most, at t = {run.t[worst + 1]:.6g}, and {total:.3g} in all"
    rises, maximum = int((change > 0.0).sum()), max(float(change.max()), 0.0)
    falls = judged("steps-fall", Enclosure.around(tolerances.energy - change / unit, rounding), needs).described(
        computed=float(change.max()) / unit,
        stated=f"H rises by no more than {tolerances.energy:g} of the largest |H| from sample to sample",
        detail=f"H rises at {rises} of {len(change)} samples, by {maximum:.3g} at most; {text}",
    )
    lost = energy[:-1] - led
    energy_claim = judged(
        "steps-defect", Enclosure.around(tolerances.energy + lost / unit, rounding + np.abs(led - rough) / unit), needs
    ).described(
        computed=float(lost.min()) / unit,
        stated="H(t + dt) - H(t) <= the scheme's defect: H at the end of the step less H where the law's flow leads",
        detail=f"along the flow from each sample H falls by {lost.min():.3g} at least; {text}",
    )
    return [replace(claim, by="flockana") for claim in (falls, energy_claim)]
