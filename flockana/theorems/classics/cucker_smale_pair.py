"""Two agents of the Cucker-Smale law on a line: an invariant tells which pairs match and which part for ever."""

from __future__ import annotations

from math import inf

import numpy as np

from flockana.base.checks import FloatArray
from flockana.dynamics.trajectory import Trajectory
from flockana.laws.cucker_smale import CuckerSmale
from flockana.theorems.claims import judged
from flockana.theorems.classics.alignment_bounds import Decline
from flockana.theorems.hypotheses import below, condition, law_is, vacuous
from flockana.theorems.rounding import EPS
from flockana.theorems.theorem import Checked, Claim, Hypothesis, Theorem, Tolerances, unmet

_KNOWN = 1e-11  # of an integral


def _check(run: Trajectory, tolerances: Tolerances) -> Checked:
    needs = [condition("two agents on a line", (run.n, run.m) == (2, 1), detail=f"n = {run.n}, m = {run.m}")]
    if unmet(needs):
        return needs, []
    x, w = run.q[:, 1, 0] - run.q[:, 0, 0], run.p[:, 1, 0] - run.p[:, 0, 0]
    needs.append(condition("different velocities", w[0] != 0.0, abs(float(w[0])), f"w(0) = {w[0]:g}"))
    if unmet(needs):
        return needs, []
    way = float(np.sign(w[0]))
    x, w = way * x, way * w
    weight = run.law.weight
    psi = Decline(weight, weight.strength * (1.0 if run.law.mean else 2.0), 1.0)
    speed, room = float(w[0]), psi.beyond(float(x[0]))
    blur = 4.0 * EPS * (float(np.abs(run.p).max()) + psi(0.0) * float(np.abs(run.q).max()))
    error = blur + _KNOWN * (speed + (0.0 if room == inf else room))
    slow = below("w(0) < ∫λψ from x(0) on", speed, room, error, f"w(0) = {speed:.6g}, the integral {room:.6g}")
    fast = below("w(0) > ∫λψ from x(0) on", room, speed, error, slow.detail)
    return needs, [_invariant(run, psi, x, w, error, tolerances), *_side(psi, x, w, room, error, slow, fast)]


def _invariant(
    run: Trajectory, psi: Decline, x: FloatArray, w: FloatArray, error: float, tolerances: Tolerances
) -> Claim:
    """That w + ∫λψ stays what it was."""
    kept = np.array([v + psi.between(float(x[0]), float(at)) for at, v in zip(x, w, strict=True)])
    off = np.abs(kept / w[0] - 1.0)
    k = int(off.argmax())
    return judged(
        "invariant",
        tolerances.energy - float(off[k]),
        error / float(w[0]),
        computed=float(off[k]),
        stated=f"w + ∫λψ from x(0) to x is w(0), to {tolerances.energy:g} of it",
        witness={"time": float(run.t[k])},
        proof="cucker-smale",
        detail=f"the invariant is off by {off[k]:.2g} of w(0) at most",
    )


def _side(
    psi: Decline, x: FloatArray, w: FloatArray, room: float, error: float, slow: Hypothesis, fast: Hypothesis
) -> list[Claim]:
    """The claim of the side of the threshold that the start is on; the other is vacuous."""
    speed = float(w[0])
    if slow.status == "unmet":
        left = speed - room
        claim = judged(
            "parts",
            left / speed,
            error / speed,
            computed=float(w[-1]),
            stated="the two part for ever",
            proof="cucker-smale",
            detail=f"{fast.detail}: they part at {left:.6g} or more for ever, and did at {w[-1]:.6g} in the end",
        )
        return [*vacuous(slow, ["bounded"]), claim]
    far = psi.reached(float(x[0]), speed)
    claim = judged(
        "bounded",
        1.0 if room == inf else (room - speed) / room,
        inf if far == inf else 0.0 if room == inf else error / room,
        computed=float(x[-1]),
        stated="the two match, at a distance that is known",
        proof="cucker-smale",
        detail=f"{slow.detail}: they end {far:.6g} apart, and got to {x[-1]:.6g}",
    )
    return [claim, *vacuous(fast, ["parts"])]


THEOREM = Theorem(
    id="cucker-smale-pair",
    title="Two agents on a line match below a critical relative speed, and part for ever above it",
    statement=(
        "Of two agents on a line under the Cucker-Smale law, x apart along their relative velocity w > 0, "
        "w + ∫λψ(s) ds from x(0) to x never changes; λψ is K(1 + s²/ℓ²)^-β, or twice that where no sum is divided by "
        "n. If w(0) < ∫λψ from x(0) on they match, where the integral is w(0); if w(0) is more, as it can be for β > ½ "
        "only, they part for ever, at w(0) less the integral or more: the condition of Ha and Liu cannot be left out."
    ),
    source="Ours, on Cucker and Smale 2007 and Ha and Liu 2009",
    kind="trajectory",
    law=law_is("the Cucker-Smale law", CuckerSmale),
    check=_check,
    claims=("invariant", "bounded", "parts"),
    references=("cucker-smale-2007", "ha-liu-2009", "flockana"),
)
