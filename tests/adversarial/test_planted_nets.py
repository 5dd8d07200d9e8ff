"""Theorem 5: lattices counted in integers, ratios exactly at their limits, crossings counted in exact arithmetic."""

from itertools import combinations
from math import comb, sqrt

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from flockana import verify
from tests.adversarial import truth
from tests.adversarial.cases import FALSE, OPEN, REFUTED, TRUE, VERIFIED, effort
from tests.adversarial.strategies import powers, seeds

THEOREMS = ("os-5", "os-5-terminal")
ROOTS = {"triangular": sqrt(3.0), "square": sqrt(2.0), "fcc": sqrt(2.0)}
FCC8 = [(0, 0, 0), (1, 0, 1), (2, 1, 1), (1, 1, 0), (2, 2, 0), (2, 1, -1), (1, 0, -1), (2, 0, 0)]
STEPS = [(1, 0), (0, 1), (-1, 1), (-1, 0), (0, -1), (1, -1)]


def judged(q, d, r, expected):
    """os-5 on a configuration."""
    verdict = verify("os-5", q=q, d=d, r=r)
    wrong = [claim for claim in verdict.claims if claim.status not in expected.get(claim.name, TRUE | FALSE)]
    assert not wrong, f"verify('os-5', q={np.asarray(q).tolist()}, d={d!r}, r={r!r})"
    return verdict


def moved(q, seed, shift):
    rng = np.random.default_rng(seed)
    m = q.shape[1]
    return q @ np.linalg.qr(rng.normal(size=(m, m)))[0] + shift * rng.normal(size=m)


@st.composite
def animals(draw):
    rng, n = np.random.default_rng(draw(seeds)), draw(st.integers(1, 25))
    cells = [(0, 0)]
    while len(cells) < n:
        a, b = cells[rng.integers(len(cells))]
        step = STEPS[rng.integers(6)] if rng.uniform() < 0.9 else (3, 1)
        if (a + step[0], b + step[1]) not in cells:
            cells.append((a + step[0], b + step[1]))
    return cells


@effort(0.75)
@given(
    animals(), seeds, powers(-6.0, 4.0), st.sampled_from((0.0, 1.0, 1e3, 1e7)), st.sampled_from((1.05, 1.2, 1.7, 0.0))
)
def test_patches_of_the_triangular_lattice(cells, seed, d, shift, kappa):
    """κ = 0 stands for the limit √3 itself, where the second neighbours are at r to the last bit and do not count."""
    n, links = len(cells), truth.lattice_links(cells)
    q = np.array([(a + 0.5 * b, 0.5 * sqrt(3.0) * b) for a, b in cells]) * d
    q = moved(q, seed, shift * d)
    good = VERIFIED if shift <= 1e3 and links else TRUE
    several = good if n >= 3 else OPEN
    truths = {"i": good, "i-graph": good, "ii": several, "ii-sharp": good, "iii": good if n > 3 else OPEN}
    verdict = judged(q, d, d * (kappa or ROOTS["triangular"]), truths | {"extension": TRUE, "extension-lengths": TRUE})
    if shift <= 1e3 and links:
        assert verdict.claim("ii").computed == len(links) <= truth.harborth(n)


@pytest.mark.parametrize("shift", [0.0, 1e3])
@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("d", [1.0, 7e-6, 0.1, 3e3])
@pytest.mark.parametrize("which", ["square", "fcc"])
def test_ratios_at_the_limit(which, d, seed, shift):
    """√2 d is no link on a square or an FCC lattice."""
    q = np.array(list(np.ndindex(4, 4)), dtype=float)
    if which == "fcc":
        q = np.array([c for c in np.ndindex(3, 3, 3) if sum(c) % 2 == 0], dtype=float) / sqrt(2.0)
    links = sum(abs(np.linalg.norm(a - b) - 1.0) < 1e-3 for a, b in combinations(q, 2))
    verdict = judged(moved(q * d, seed, shift * d), d, d * ROOTS[which], {"i": VERIFIED, "iii": VERIFIED})
    assert verdict.claim("iii").computed == comb(len(q), 2) - links


@effort(0.1)
@given(seeds, powers(-6.0, 4.0), st.sampled_from((1.05, 1.2, 0.0)))
def test_lattices_in_space_need_not_be_planar(seed, d, kappa):
    """E5: 8 agents of an FCC lattice with 17 links, no two of which cross, and a graph that cannot be drawn."""
    q = moved(np.array(FCC8, float) * d / sqrt(2.0), seed, d)
    r = d * (kappa or ROOTS["fcc"])
    verdict = judged(q, d, r, {"i": VERIFIED, "i-graph": REFUTED, "ii": OPEN, "ii-sharp": OPEN, "iii": VERIFIED})
    assert verdict.claim("iii").computed == comb(8, 2) - 17


@effort(0.5)
@given(
    seeds, st.integers(2, 12), st.sampled_from((0.8, 1.5, 4.0)), st.integers(1, 3), st.sampled_from((1.0, 1e-6, 1e4))
)
def test_any_net(seed, n, spread, m, d):
    rng = np.random.default_rng(seed)
    q, r = rng.uniform(-1.0, 1.0, (n, m)) * spread * d, 1.4 * d
    links = [(i, j) for i, j in combinations(range(n), 2) if np.linalg.norm(q[i] - q[j]) < r]
    lattice = dict.fromkeys(("i", "i-graph", "ii", "ii-sharp", "iii"), OPEN if links else TRUE)
    names = ("extension", "extension-lengths", "extension-links", "extension-quantitative")
    verdict = judged(q, d, r, lattice | dict.fromkeys(names, TRUE))
    if m == 2:
        assert verdict.claim("i").computed == truth.crossing_count(q, links)


@effort(0.3)
@given(seeds, powers(-17.0, -1.0), st.sampled_from((1.0, -1.0)), st.sampled_from((1.0, 1e-6, 1e4)))
def test_crossing_diagonals_next_to_the_bound(seed, off, sign, d):
    """A square's diagonals, as long as √2 sides: whatever rounding makes of r/√2 and ℓ/√2, the extension is true."""
    q = moved(np.array([(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]) * d, seed, d)
    names = ("extension", "extension-lengths", "extension-links", "extension-quantitative")
    judged(q, d, sqrt(2.0) * d * (1.0 + sign * off), dict.fromkeys(names, TRUE))


@effort(0.3)
@given(seeds, powers(-12.0, -1.0), st.sampled_from((1.0, 7e-6, 4e3)))
def test_a_lattice_a_little_off(seed, off, d):
    cells = [(0, 0), *STEPS]
    q = np.array([(a + 0.5 * b, 0.5 * sqrt(3.0) * b) for a, b in cells])
    q = d * (q + off * np.random.default_rng(seed).uniform(-1.0, 1.0, q.shape))
    exact = VERIFIED if off < 1e-8 else OPEN if off > 1e-3 else TRUE
    judged(q, d, 1.3 * d, dict.fromkeys(("i", "i-graph", "ii", "ii-sharp", "iii"), exact))
