"""Claims about energies on a frozen tree, on made-up runs of one edge: how near the bound it comes, and its error."""

from dataclasses import replace
from math import sqrt

import numpy as np
import pytest

from flockana import MinimalFlocking, Tolerances, simulate, theorem
from flockana.measures.perception import both_ways
from flockana.theorems.observed_run import Observed

PAIR, MU, RHO = ((0, 1),), 4.0, 2.0
LAW = MinimalFlocking(edges=PAIR, spacing=RHO, mu=MU)
BOTH = MinimalFlocking(edges=both_ways(PAIR), spacing=RHO, mu=MU, normalised=False)


def claim_of(run, name):
    return next(c for c in theorem("zone-1-corrected").examine(Observed.of(run), Tolerances())[1] if c.name == name)


def edge(stretch, law=LAW, far=0.0, until=1.0):
    q = np.array([[far], [far + stretch]])
    return simulate(law, q, 0.0 * q, (0.0, until))


@pytest.mark.parametrize("stretch", [1.5, 2.5])
def test_an_edge_let_go_is_at_its_bound_but_for_the_tolerance(stretch):
    """Its amplitude is |ρ − x|; pressed, it starts at ρ − √(2V/μ) itself, stretched it comes near it from above."""
    run = edge(stretch)
    claim = claim_of(run, "root-edge")
    amplitude, share = abs(RHO - stretch), Tolerances().energy
    assert claim.status == "verified"
    assert claim.witness == {"edge (0, 1)": {"V(0)": pytest.approx(0.5 * MU * amplitude**2)}}
    least = float(np.abs(run.q[:, 1, 0] - run.q[:, 0, 0]).min())
    room = (least - RHO + amplitude * sqrt(1.0 + share)) / RHO
    assert claim.computed["least distance to the bound"] == pytest.approx(room, abs=1e-9)
    assert claim.computed["largest rise of V in a step"] <= 0.0
    assert f"the shortest of them is never below {least:.4g}" in claim.detail


@pytest.mark.parametrize("rise", [0.01, 1e-5, 1e-9])
def test_a_rise_of_the_energy_in_one_step_is_found(rise):
    """V of one sample so much above the one before, of a run taken for exact: more than 1e-6 of V(0) refutes."""
    run = edge(1.5)
    rest = RHO + 0.5 * np.exp(-0.1 * run.t)
    rest[3] = RHO + 0.5 * np.exp(-0.1 * run.t[2]) * sqrt(1.0 + rise)
    q = np.stack([np.zeros(len(run.t)), rest], axis=1)[:, :, None]
    seen = Observed.alone(replace(run, q=q, p=np.zeros_like(q)))
    claim = next(c for c in theorem("zone-1-corrected").examine(seen, Tolerances())[1] if c.name == "root-edge")
    found = rise * np.exp(-0.2 * run.t[2]) * 0.5**2 / RHO**2
    assert claim.computed["largest rise of V in a step"] == pytest.approx(found, rel=1e-4)
    assert (claim.margin < 0.0) == (rise > 1e-6)


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
    assert (claim.status, claim.proof) == ("verified", None)  # the proof is of the plane and of space
    assert claim.witness == {"H(0)": pytest.approx(start), "least μρ²/2": pytest.approx(0.5 * MU * RHO**2)}
    room = 0.5 * (sqrt(1.0 + Tolerances().energy) - 1.0) / RHO
    assert claim.margin == pytest.approx(room, abs=1e-9)
    energy = claim_of(run, "energy")
    assert energy.witness["H(0)"] == pytest.approx(start)
    assert energy.margin == pytest.approx(Tolerances().energy - energy.witness["residual"] / start, rel=1e-6)
    assert energy.computed <= 0.0


def test_the_energy_is_the_less_exact_the_farther_away():
    near, far = (claim_of(edge(1.5, law=BOTH, far=x), "energy").error for x in (0.0, 1e6))
    assert near < 1e-7
    assert far > MU * 0.5 * 16.0 * 2.0**-52 * 1e6 / (0.5 * MU * 0.25)  # μ |x − ρ| times the rounding of x
