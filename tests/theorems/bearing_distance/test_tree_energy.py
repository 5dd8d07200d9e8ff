"""Claims about energies on a frozen tree, on made-up runs of one edge: how near the bound it comes, and its error."""

from __future__ import annotations

from dataclasses import replace
from math import sqrt

import numpy as np
import pytest

from flockana import MinimalFlocking, Tolerances, simulate
from flockana.measures.perception import both_ways
from flockana.theorems import theorem
from flockana.theorems.observed import Observed

PAIR, MU, RHO = ((0, 1),), 4.0, 2.0
LAW = MinimalFlocking(edges=PAIR, spacing=RHO, mu=MU)
BOTH = MinimalFlocking(edges=both_ways(PAIR), spacing=RHO, mu=MU, normalised=False)


def claim_of(run, name):
    """On this run alone."""
    return next(c for c in theorem("zone-1-corrected").examine(Observed.of(run), Tolerances())[1] if c.name == name)


def edge(stretch, law=LAW, far=0.0, until=1.0):
    """A run of two agents at rest at first, that far apart."""
    q = np.array([[far], [far + stretch]])
    return simulate(law, q, 0.0 * q, (0.0, until))


@pytest.mark.parametrize("stretch", [1.5, 2.5])
def test_an_edge_let_go_is_at_its_bound_but_for_the_tolerance(stretch):
    """Its amplitude is |ρ − x|; pressed, it starts at ρ − √(2V/μ) itself, stretched it comes near it from above."""
    run = edge(stretch)
    claim = claim_of(run, "root-edge")
    amplitude = abs(RHO - stretch)
    start = 0.5 * MU * amplitude**2
    assert claim.witness == {"edge (0, 1)": {"V(0)": pytest.approx(start)}}
    share = Tolerances().energy
    least = float(np.abs(run.q[:, 1, 0] - run.q[:, 0, 0]).min())
    slack = (least - RHO) / amplitude + sqrt(1.0 + share)
    found = claim.computed["least distance to the bound"]
    assert found == pytest.approx(slack, abs=1e-3 if stretch > RHO else 3e-8)  # less what the path may be off
    assert claim.margin == pytest.approx(min(found, share), rel=1e-3)
    rounding = 8.0 * EPS * (1.0 + float(np.abs(run.q).max()) / RHO) * RHO
    assert claim.error == pytest.approx(4.0 * rounding / amplitude + 64.0 * EPS, rel=1e-6, abs=0.0)
    assert f"above their bound, {RHO - amplitude * sqrt(1.0 + share):.3g} or more" in claim.detail


def test_a_rise_of_the_energy_in_one_step_is_found():
    """V of one sample 1 % above the one before."""
    run = edge(1.5)
    rest = RHO + 0.5 * np.exp(-0.1 * run.t)
    rest[3] = RHO + 0.5 * np.exp(-0.1 * run.t[2]) * sqrt(1.01)
    q = np.stack([np.zeros(len(run.t)), rest], axis=1)[:, :, None]
    claim = claim_of(replace(run, q=q, p=np.zeros_like(q)), "root-edge")
    rise = 0.01 * np.exp(-0.2 * run.t[2]) * 1.0
    assert claim.computed["largest rise of V in a step"] == pytest.approx(rise, rel=1e-6)
    assert claim.margin < 0.0


@pytest.mark.parametrize(
    ("stretch", "status"), [(2.1 * RHO, "vacuous"), (1.9 * RHO, "verified"), (RHO, "inconclusive")]
)
def test_edges_without_energy_and_with_too_much_say_nothing(stretch, status):
    """From 2ρ on V is μρ²/2, and nothing keeps it off length 0; at ρ, at rest, there is nothing to see."""
    assert claim_of(edge(stretch), "root-edge").status == status


def test_on_an_undirected_tree_the_energy_of_all_bounds_each_edge():
    """Both agents move: ½ Σ|v − v̄|² + ½ μ (x − ρ)²."""
    run = edge(1.5, law=BOTH)
    start = 0.5 * MU * 0.25
    claim = claim_of(run, "no-collision")
    assert claim.witness == {"H(0)": pytest.approx(start), "least μρ²/2": pytest.approx(0.5 * MU * RHO**2)}
    slack = sqrt(1.0 + Tolerances().energy) - 1.0
    assert claim.margin == pytest.approx(slack, abs=3e-8)
    rounding = 8.0 * EPS * (1.0 + float(np.abs(run.q).max()) / RHO) * RHO
    assert claim.error == pytest.approx(4.0 * rounding * sqrt(MU / (2.0 * start)) + 64.0 * EPS, rel=1e-6, abs=0.0)
    energy = claim_of(run, "energy")
    assert energy.witness["H(0)"] == pytest.approx(start)
    assert energy.margin == pytest.approx(Tolerances().energy - energy.witness["residual"] / start, rel=1e-9)
    assert energy.computed <= 0.0


def test_the_energy_is_the_less_exact_the_farther_away():
    near, far = (claim_of(edge(1.5, law=BOTH, far=x), "energy").error for x in (0.0, 1e6))
    springs = MU * 0.5 * 8.0 * EPS * 1e6 / RHO * RHO  # μ |x − ρ| times the rounding of x
    assert near < 1e-12
    assert far == pytest.approx(springs / (0.5 * MU * 0.25), rel=0.2)
