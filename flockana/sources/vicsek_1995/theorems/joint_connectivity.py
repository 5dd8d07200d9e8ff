"""Jadbabaie, Lin and Morse: headings agree if the nets are jointly connected in every time window."""

from dataclasses import replace
from typing import Any

import numpy as np

from flockana.measures.connectivity_windows import joint_windows
from flockana.sources.vicsek_1995.laws import HeadingAveraging
from flockana.sources.vicsek_1995.theorems import heading_averages
from flockana.theorems.claim import does_not_hold
from flockana.theorems.claims import by_count, run_theorem
from flockana.theorems.theorem import Checked, Claim, Hypothesis, Tolerances, unmet
from flockana.theorems.theorem_toolkit import (
    Certificate,
    FloatArray,
    Observed,
    Trajectory,
    condition,
    law_is,
    limit_claim,
)

_PROOF = "headings"
_EVERY = 1e-6  # of a step: samples that are one step apart


def _kinds(run: Trajectory) -> list[Hypothesis]:
    """Return the hypotheses that headings are averaged as numbers, without noise, and every step is stored."""
    law, steps = run.law, np.diff(run.t)
    plain = law.average == "headings" and law.noise == 0.0
    is_recorded = "heading" in run.extra and bool(np.all(np.abs(steps - law.dt) <= _EVERY * law.dt))
    return [
        condition("headings are averaged as numbers, without noise", plain, detail=f"{law.average}, η = {law.noise}"),
        condition("every step is kept", is_recorded, detail=f"{len(run.t)} samples"),
    ]


def _at_all_later_times(windows: Any, connected: Certificate, parted: Certificate) -> Hypothesis:
    """Return the hypothesis of joint connectivity over all later windows: proved, disproved or assumed from the run."""
    name = "the nets are jointly connected over contiguous bounded windows, at all later times"
    longest = max((stop - start for start, stop in windows), default=0)
    text = f"{len(windows)} windows seen, of {longest} steps at most"
    if connected.certain:
        return Hypothesis(name, "met", connected.margin, f"{text}; {connected.text}", decided="enclosed")
    if parted.certain:
        return Hypothesis(name, "unmet", -parted.margin, f"{text}, none can follow: {parted.text}", decided="enclosed")
    return Hypothesis(name, "assumed", None, f"{text}; what comes after the run is not known")


def _hull(headings: FloatArray, needs: list[Hypothesis]) -> Claim:
    """Return the claim that no heading leaves the span of the previous headings."""
    lower, maximum = headings.min(axis=1), headings.max(axis=1)
    out = np.flatnonzero((np.diff(lower) < 0.0) | (np.diff(maximum) > 0.0))
    return by_count("hull", out.size, needs, proof=_PROOF, computed=float(maximum[-1] - lower[-1])).described(
        stated="the greatest heading never rises, the least never falls",
        witness={"steps at which one does": int(out.size), "first": int(out[0]) if out.size else None},
        detail=f"the headings' span goes from {maximum[0] - lower[0]:.4g} to {maximum[-1] - lower[-1]:.4g} radians",
    )


def _contraction(headings: FloatArray, found: tuple[heading_averages.Block, ...], needs: list[Hypothesis]) -> Claim:
    """Return the claim that each block of n − 1 windows shrinks the span by the guaranteed factor."""
    n = headings.shape[1]
    span = np.ptp(headings, axis=1)
    missed = [b for b in found if not span[b.stop] <= b.factor * span[b.start] + b.error or not b.mixes]
    name = f"n - 1 = {n - 1} jointly connected windows in a row"
    window_need = replace(condition(name, bool(found), detail=f"{len(found)} times in the run"), on_motion=True)
    slowest = max((b.factor for b in found), default=float("nan"))
    first_steps = (missed[0].start, missed[0].stop) if missed else None
    text = f"{len(found)} blocks; the weakest guarantees {slowest:.4g} times the span"
    return by_count("contraction", len(missed), [*needs, window_need], proof=_PROOF, computed=slowest).described(
        stated="over n - 1 windows the span shrinks by a factor below 1 that the nets alone guarantee",
        witness={"blocks": len(found), "steps of the first missed": first_steps},
        detail=text if found else does_not_hold(name),
    )


def _limit(run: Trajectory, heading: FloatArray, needs: list[Hypothesis], connected: Certificate) -> Claim:
    weights = heading_averages.neighbourhood_sizes(run.n, run.law.links(run.q[-1]))
    return limit_claim("agreement", needs, [connected], proof=_PROOF, computed=float(np.ptp(heading))).described(
        stated="all headings tend to a common one",
        witness={"heading": heading_averages.final_heading(heading, weights)} if connected.certain else None,
        detail=f"at the end the headings differ by {np.ptp(heading):.3g} radians",
    )


@run_theorem(
    "jlm-headings",
    title="Nearest-neighbour averaging: headings agree under joint connectivity",
    source="Jadbabaie, Lin and Morse, theorem on leaderless coordination, in our words; span and factor are ours",
    law=law_is("nearest-neighbour averaging of headings", HeadingAveraging),
    claims=("hull", "contraction", "agreement"),
    references=("jadbabaie-lin-morse-2003", "vicsek-1995"),
    ours=("hull", "contraction"),
)
def theorem(seen: Observed, tolerances: Tolerances) -> Checked:
    """Let each agent's heading become the mean of its own and its neighbours' headings, all agents moving at one speed.
    If there is an infinite sequence of contiguous, non-empty, bounded intervals of time from the start on, across each
    of which the agents are linked together, all headings tend to a common one. No heading ever leaves the span of those
    before, and over n - 1 such intervals the span shrinks by a factor that the nets guarantee.
    """
    run = seen.run
    if unmet(requirements := _kinds(run)):
        return requirements, []
    headings = run.extra["heading"]
    nets = [run.law.links(q) for q in run.q[:-1]]
    windows = joint_windows(run.n, nets)
    end_state = run.law, run.q[-1], headings[-1]
    connected_claim = heading_averages.permanently_connected(*end_state)
    lasting_need = _at_all_later_times(windows, connected_claim, heading_averages.permanently_separated(*end_state))
    return [*requirements, lasting_need], [
        _hull(headings, requirements),
        _contraction(headings, heading_averages.blocks(nets, headings, windows), requirements),
        _limit(run, headings[-1], [*requirements, lasting_need], connected_claim),
    ]
