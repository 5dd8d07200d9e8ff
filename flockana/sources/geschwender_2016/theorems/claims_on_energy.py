"""Claims about an energy that a source prints wrongly (E1, E2): by algebra, at an exact state, along a run."""

from collections.abc import Callable
from typing import Any

import numpy as np

from flockana.theorems.rounding_bounds import energy_error
from flockana.theorems.theorem_toolkit import Claim, Enclosure, FloatArray, Needs, Observed, Trajectory, exact, judged

PROOF = "energy-identities"


def state_claim(state: Any) -> Claim:
    """Return the claim that the printed energy does not rise, at a rational state with a known exact rate."""
    rate, true_rate = float(state.rate), float(state.true_rate)
    return exact("printed-state", not state.rate.is_positive, margin=-rate, error=0.0, disproof=PROOF).described(
        computed=rate,
        stated="dH/dt <= 0 for the printed H",
        witness={"q": [str(x) for x in state.q], "p": [str(x) for x in state.p]},
        detail=f"at an exact state of two agents the printed H has rate {rate:.4g}, the true one {true_rate:g}",
    )


def rises(energy: Enclosure) -> Enclosure:
    """Return the excess of an energy over its least value so far, at each sample."""
    return energy + (-energy).largest_so_far()


def printed_energy(seen: Observed, excess: Callable[[Trajectory], FloatArray]) -> Enclosure:
    """Return the energy as printed by a source, the true energy plus a given excess, at each sample."""

    def rounding(run: Trajectory) -> FloatArray:
        return energy_error(run.law, run.q, run.p, np.abs(run.energy()) + np.abs(excess(run)))

    floor = 2.0 * seen.floors.work + rounding(seen.run)
    return seen.series(lambda run: run.energy() + excess(run), floor=floor)


def run_claim(seen: Observed, excess: Callable[[Trajectory], FloatArray], where: str, needs: Needs = ()) -> Claim:
    """Return the claim that the printed energy (true plus excess) never rises; `where` names the run."""
    # A rise from a sample to a later one refutes it; samples at which it does not rise verify nothing.
    above = rises(printed_energy(seen, excess))
    peak, true_energy = int(np.argmax(above.lo)), seen.energy
    rise = float(above.mid[peak])
    course = f"rises by {rise:.4g} until t = {seen.t[peak]:.3g}" if above.lo[peak] > 0.0 else "is not seen to rise"
    return judged("printed-run", -above, needs, about="all", computed=rise).described(
        stated="the printed H never rises",
        witness={"q(0)": seen.run.q[0].tolist(), "p(0)": seen.run.p[0].tolist(), "time": float(seen.t[peak])},
        detail=f"along a run of {where} the printed H {course}; the true one goes from {true_energy.mid[0]:.4g} to "
        f"{true_energy.mid[-1]:.4g}",
    )
