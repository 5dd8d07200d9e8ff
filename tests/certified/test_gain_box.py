"""Boxes of gains: stable, unstable with a witness, undecided; and every sampled choice agrees."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from flockana import Algorithm1, Algorithm2, Gains, StaticTarget, find_equilibrium, gain_box, rescale
from flockana.lattice import hexagonal_patch
from tests.refused import refused

LAW = Algorithm2(target=StaticTarget((0.0, 0.0)))
HEXAGON = hexagonal_patch(1, 7.0)


TRIANGLE = [[0.0, 0.0], [7.0, 0.0], [3.5, 6.0621778264910706]]
TETRAHEDRON = 7.0 / np.sqrt(8.0) * np.array([[1.0, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]])


def in_space(dimension):
    return Algorithm2(target=StaticTarget((0.0,) * dimension))


@pytest.mark.parametrize(
    ("q", "spread"),
    [([[-3.5], [3.5]], 0.2), (TRIANGLE, 0.1), (HEXAGON, 0.01), (TETRAHEDRON, 0.01), ([[0.0, 0.0]], 0.9)],
)
def test_what_is_proved_holds_for_every_choice_at_its_own_equilibrium(q, spread):
    """Gains drawn agent by agent, and all corners alike: links stay as near as is said, all modes but turns decay."""
    law = in_space(len(q[0]))
    box = gain_box(law, q, spread)
    assert box.status == "verified"
    rest, rng = find_equilibrium(law, q).q if len(q) > 1 else np.array(q), np.random.default_rng(0)
    n = len(q)
    pairs = np.triu_indices(n, 1)
    links = np.linalg.norm(rest[pairs[0]] - rest[pairs[1]], axis=1)
    near = links < law.alpha.range
    for k in range(12):
        a, b, c, d = (rng.uniform(1 - spread, 1 + spread, n) if k else np.full(n, 1 - spread) for _ in range(4))
        own = law.gains
        gains = Gains(
            own.c1_alpha * a[0], own.c2_alpha * b[0], c1_gamma=tuple(own.c1_gamma * c), c2_gamma=tuple(own.c2_gamma * d)
        )
        other = replace(law, gains=gains)
        there = find_equilibrium(other, rest).q if n > 1 else rest
        now = np.linalg.norm(there[pairs[0]] - there[pairs[1]], axis=1)
        assert np.abs(now - links)[near].max(initial=0.0) <= box.moved + 1e-9
        hessian, laplacian = other.alpha.hessian(there).toarray(), other.alpha.laplacian(there).toarray()
        m = len(q[0])
        stiff = gains.c1_alpha * hessian + np.diag(np.repeat(gains.c1_gamma, m))
        damp = gains.c2_alpha * laplacian + np.diag(np.repeat(gains.c2_gamma, m))
        size = n * m
        poles = np.linalg.eigvals(np.block([[np.zeros((size, size)), np.eye(size)], [-stiff, -damp]]))
        turns = {1: 0, 2: 1, 3: 3}[m] if n > 1 else 0
        assert np.sum(np.abs(poles) < 1e-6) == turns
        assert np.sort(poles.real)[: len(poles) - turns].max() < 0.0


def test_a_box_too_wide_is_left_open_and_a_lattice_relaxes_first():
    """S7: with other gains the flock rests elsewhere, and there its rotation is neutral; pressed to 0.93 it relaxes."""
    assert gain_box(LAW, HEXAGON, 0.5).status == "inconclusive"
    assert gain_box(LAW, 0.93 * HEXAGON, 0.01).status == "verified"


def test_the_verdict_does_not_depend_on_units_or_place():
    """An exact scaling by powers of two, and a shift of the γ-agent: the same proof."""
    moved = Algorithm2(target=StaticTarget((100.0, -30.0)))
    for spread, status in ((0.1, "verified"), (0.5, "inconclusive")):
        assert gain_box(moved, np.add(TRIANGLE, (100.0, -30.0)), spread).status == status
        law = rescale(LAW, length=2.0**-10, time=2.0**6)
        scaled = gain_box(law, 2.0**-10 * np.array(TRIANGLE), spread)
        assert scaled.status == status
        assert scaled.moved == pytest.approx(2.0**-10 * gain_box(LAW, TRIANGLE, spread).moved, rel=1e-6, nan_ok=True)


def test_without_any_pull_nothing_is_certain():
    assert gain_box(replace(LAW, gains=Gains(c1_gamma=0.0)), HEXAGON, 0.1).status == "inconclusive"


def test_a_witness_is_a_choice_of_the_box(monkeypatch):
    """An equilibrium that is unstable at a corner: the modes are doctored, as no such flock of seven is known."""
    flock = gain_box.__globals__
    real = flock["linearise"]

    def doctored(law, rest):
        low = law.gains.c1_alpha < 30.0 and law.gains.c2_alpha > 10.0
        modes = [replace(mode, eigenvalue=0.5 + 0j) if low else mode for mode in real(law, rest).modes]
        return SimpleNamespace(modes=modes)

    monkeypatch.setitem(flock, "linearise", doctored)
    box = gain_box(LAW, TRIANGLE, 0.5)
    own = LAW.gains
    assert box.status == "refuted"
    assert box.witness == pytest.approx((15.0, 1.5 * own.c2_alpha, 0.5 * own.c1_gamma, 0.5 * own.c2_gamma))


test_bad_input = refused(
    (lambda: gain_box(Algorithm1(), HEXAGON, 0.1), "expected Algorithm2"),
    (lambda: gain_box(LAW, hexagonal_patch(2, 7.0), 0.1), "q has 19 agents: expected at most 7"),
    (lambda: gain_box(LAW, HEXAGON, 1.0), "spread = 1: expected a share below 1"),
    (lambda: gain_box(LAW, HEXAGON, -0.1), "spread = -0.1"),
    (
        lambda: gain_box(replace(LAW, target=StaticTarget((0.0, 0.0), (1.0, 0.0))), HEXAGON, 0.1),
        "expected one of constant velocity, which it reports",
    ),
)
