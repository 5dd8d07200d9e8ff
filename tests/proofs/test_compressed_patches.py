"""Verified equilibria: what is enclosed is what flockana computes; a wrong sign or too small a box proves nothing."""

from dataclasses import replace

import numpy as np
import pytest

pytest.importorskip("z3")  # the extra flockana[proofs]

from flint import arb, ctx

from flockana import Algorithm1, AlphaInteraction, find_equilibrium
from flockana.certified.balls import AlphaParameters
from flockana.equilibria.potential import Potential
from flockana.lattice import hexagonal_patch, rigidity
from proofs import double_agent, strained_thirteen, unstressed_patches
from proofs.compressed_patches import LAW, NARROW, RADIUS, computed, curvature, enclose, flock

RNG = np.random.default_rng(6)


@pytest.fixture(autouse=True)
def digits():
    with ctx.workdps(30):
        yield


@pytest.fixture(scope="module")
def seven():
    return computed(1)


def floats(matrix):
    return np.array([[float(x) for x in row] for row in matrix.tolist()])


@pytest.mark.parametrize("rings", [1, 2, 3])
def test_the_sites_in_whole_numbers_are_the_patch(rings):
    sites = unstressed_patches.patch(rings)
    q = 3.5 * np.array([[x, np.sqrt(3.0) * y] for x, y in sites])
    patch = hexagonal_patch(rings, 7.0)
    order, other = (np.lexsort(np.round(points, 6).T) for points in (q, patch))
    assert np.allclose(q[order], patch[other], atol=1e-12)
    links = unstressed_patches.links_of(sites)
    assert unstressed_patches.rigidity_matrix(sites, links).rank() == rigidity(q, links).rank
    assert {unstressed_patches.squared(sites[i], sites[j]) for i, j in links} == {4}


def test_without_some_links_the_rank_falls():
    sites = unstressed_patches.patch(1)
    links = unstressed_patches.links_of(sites)
    assert unstressed_patches.rigidity_matrix(sites, links[1:]).rank() == 11  # one link is not needed
    assert unstressed_patches.rigidity_matrix(sites, links[2:]).rank() == 10
    assert unstressed_patches.laplacian_rank(7, links[2:]) == 6
    assert unstressed_patches.laplacian_rank(7, [link for link in links if 0 not in link]) == 5


@pytest.mark.parametrize("rings", [1, 2])
def test_the_stiffness_and_the_least_curvature_are_those_of_the_kernels(rings):
    par, law = AlphaParameters(), Algorithm1()
    q = hexagonal_patch(rings, 7.0)
    eigenvalues = np.linalg.eigvalsh(Potential(law).stiffness(q).toarray())
    sites = unstressed_patches.patch(rings)
    least = float(unstressed_patches.least_curvature(sites, unstressed_patches.links_of(sites)))
    scale = law.gains.c1_alpha * float(unstressed_patches.stiffness(par))
    assert np.abs(eigenvalues[:3]).max() < 1e-9
    assert least * scale <= eigenvalues[3] * (1 + 1e-9)
    assert least * scale == pytest.approx(min(eigenvalues[3], scale), rel=1e-6)


def test_a_range_that_reaches_second_neighbours_is_refused():
    assert unstressed_patches.stiffness_step(AlphaParameters()).holds is True
    assert unstressed_patches.stiffness_step(AlphaParameters(r="12.2")).holds is False  # √3 d = 12.12…
    assert unstressed_patches.stiffness_step(AlphaParameters(h="0.9")).holds is True  # d_α before the taper: a_ij = 1
    z, edge = unstressed_patches.d_alpha(AlphaParameters()), AlphaParameters(h="0.77734")  # d_α/r_α = 0.7773401
    assert unstressed_patches.off_the_edges(z, edge)
    assert not unstressed_patches.off_the_edges(z + arb(0, "1e-4"), edge)


def test_gradient_and_hessian_are_those_of_the_kernels(seven):
    u = flock(7)
    q = np.array(seven) + 0.05 * RNG.normal(size=14)
    potential = Potential(LAW)
    point = [arb(float(x)) for x in q]
    centred = q.reshape(7, 2)
    assert np.allclose(
        np.array([float(x) for x in u.gradient(point)]),
        -(potential.force(centred).ravel() - 1.1 * np.tile(centred.mean(axis=0), 7)),
        atol=1e-9,
    )
    step, i = 1e-6, 3
    ahead, behind = (u.gradient([*point[:i], point[i] + s, *point[i + 1 :]]) for s in (step, -step))
    slope = [float((a - b) / (2 * step)) for a, b in zip(ahead, behind, strict=True)]
    assert np.allclose(floats(u.hessian(point))[i], slope, rtol=1e-7, atol=1e-6)


def test_the_equilibrium_is_enclosed_and_the_radius_matters(seven):
    u = flock(7)
    wide, narrow = (enclose(u, seven, arb(radius)) for radius in (RADIUS, NARROW))
    assert all(a.overlaps(b) for a, b in zip(wide, narrow, strict=True))
    assert max(float(abs(x - arb(y)).upper()) for x, y in zip(narrow, seven, strict=True)) < 1e-13
    assert enclose(u, seven, arb("1e-17")) is None  # nearer than floats can be
    assert enclose(u, seven, arb("0.01")) is None  # too wide to be certain
    shifted = [x + 1e-5 for x in seven]
    assert enclose(u, shifted, arb(RADIUS)) is None  # not within that radius of here


def test_what_flockana_finds_from_a_disturbed_start_has_the_enclosed_lengths(seven):
    found = enclose(flock(7), seven, arb(NARROW))
    start = hexagonal_patch(1, 7.0) + 0.3 * RNG.normal(size=(7, 2))
    q = find_equilibrium(LAW, start).q
    lengths = sorted(np.linalg.norm(a - b) for k, a in enumerate(q) for b in q[:k])[:12]
    enclosed = sorted(flock(7).lengths(found), key=float)
    assert all(abs(float(ball) - length) < 1e-10 for ball, length in zip(enclosed, lengths, strict=True))


def test_a_wrong_sign_of_the_pull_or_another_gain_proves_nothing(seven, monkeypatch):
    assert enclose(replace(flock(7), c1_gamma=arb("1.101")), seven, arb(RADIUS)) is None
    u = flock(7)
    right = type(u).pull
    monkeypatch.setattr(type(u), "pull", lambda self, s: -right(self, s))
    assert enclose(u, seven, arb(RADIUS)) is None


def test_the_curvature_is_the_least_eigenvalue_off_the_rotation(seven):
    box = enclose(flock(7), seven, arb(NARROW))
    eigenvalues = np.sort(np.linalg.eigvalsh(floats(flock(7).hessian([x.mid() for x in box]))))
    assert abs(eigenvalues[0]) < 1e-9
    assert float(curvature(flock(7), box)) == pytest.approx(1.1, rel=1e-6)
    assert eigenvalues[1:3] == pytest.approx([1.1, 1.1])
    assert float(curvature(flock(7), box, translations=True)) == pytest.approx(eigenvalues[3], rel=1e-6)
    saddle = replace(flock(7), c1_gamma=arb(-300))
    assert curvature(saddle, box) is None


def test_pairs_at_the_edge_of_the_range_are_not_called_smooth(seven):
    u = flock(7)
    assert u.smooth_at([arb(x) for x in seven])
    stretched = [arb(x) * arb("8.4") / arb("6.98314664627") for x in seven]
    assert not u.smooth_at([x + arb(0, 1e-3) for x in stretched])
    knee = arb("2.95")  # about where ‖x‖_σ = h r_α
    assert flock(2).smooth_at([arb(0), arb(0), knee - 1, arb(0)])
    assert not flock(2).smooth_at([arb(0), arb(0), knee + arb(0, "0.01"), arb(0)])


def test_the_proof_is_of_the_default_law():
    assert AlphaInteraction() == LAW.alpha
    assert (LAW.gains.c1_alpha, LAW.gains.c1_gamma) == (30.0, 1.1)


def test_two_agents_on_a_corner_need_their_common_neighbours():
    par = AlphaParameters()
    q = double_agent.places(par)
    found = float(double_agent.least_curvature(par, q))
    law = Algorithm1()
    stiffness = Potential(law).stiffness(np.array([float(x) for x in q]).reshape(-1, 2)).toarray()
    assert found * law.gains.c1_alpha == pytest.approx(np.linalg.eigvalsh(stiffness)[3], rel=1e-6)
    alone = double_agent.places(par, ((0, 0), (2, 0), (1, 1), (0, 0)))  # two common neighbours are too few
    assert double_agent.least_curvature(par, alone) is None


@pytest.mark.parametrize("site", [(2, 0), (4, 0), (3, 1)])
def test_another_place_of_the_second_agent_is_told(monkeypatch, site):
    monkeypatch.setattr(double_agent, "SITES", (*double_agent.SITES[:4], site))
    steps = double_agent.PROOF.steps()
    assert any(not step.holds for step in steps) is (site != (2, 0))  # the other end of the side will do


def test_thirteen_strained_agents_are_enclosed_and_what_is_uncertain_is_not_claimed(monkeypatch):
    u, q = strained_thirteen.flock()
    found = strained_thirteen.enclose(u, q, arb(strained_thirteen.RADIUS))
    eigenvalues = np.sort(np.linalg.eigvalsh(floats(u.hessian([x.mid() for x in found]))))
    assert np.abs(eigenvalues[:3]).max() < 1e-8
    assert float(strained_thirteen.curvature(u, found)) == pytest.approx(eigenvalues[3], rel=1e-5)
    assert 1.3 < eigenvalues[3] < 1.4
    assert strained_thirteen.enclose(u, q, arb("1e-17")) is None  # nearer than floats can be
    assert strained_thirteen.enclose(u, [1.001 * x for x in q], arb(strained_thirteen.RADIUS)) is None
    assert strained_thirteen.transversal(u, q, arb("1e-7"))
    assert not strained_thirteen.transversal(u, q, arb(10))
    right = type(u)._change
    monkeypatch.setattr(type(u), "_change", lambda self, s: -right(self, s))
    assert strained_thirteen.curvature(u, found) is None
