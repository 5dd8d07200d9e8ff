import numpy as np
import pytest
from scipy.linalg import block_diag

from flockana.equilibria import find_equilibrium
from flockana.lattice import hexagonal_patch
from flockana.laws.olfati_saber import Algorithm1
from flockana.stability import axis_crossings, delay_margin, delay_system
from flockana.stability.axis_crossings import least_crossing
from flockana.stability.common_blocks import split_into_blocks
from flockana.stability.delay import DelaySystem


@pytest.fixture(scope="module")
def patch():
    """37 agents in rings, each of which knows its own state at once."""
    law = Algorithm1()
    return delay_system(law, find_equilibrium(law, hexagonal_patch(3, 7.0)).q, delayed="neighbours")


def _hidden(blocks, seed):
    """Return quadruples of matrices as one, in coordinates that mix them all."""
    size = sum(len(block[0]) for block in blocks)
    rotation = np.linalg.qr(np.random.default_rng(seed).normal(size=(size, size)))[0]
    return tuple(rotation @ block_diag(*parts) @ rotation.T for parts in zip(*blocks, strict=True))


def _unlike(seed, size):
    """Return K₀, D₀, K₁, D₁ that share no direction: late springs hold the flock, prompt drag damps it."""
    k0, d0, k1, d1 = 0.2 * np.random.default_rng(seed).normal(size=(4, size, size))
    return k0, d0 + np.eye(size), k1 + (2.0 + seed % 7) * np.eye(size), 0.2 * d1


def test_a_hexagonal_patch_falls_into_the_types_of_its_symmetries(patch):
    # Characters of D6 on 74 coordinates: 74, 1, -1, -2, 0, 0; so A1, A2, B1 and B2 six times, E1 13, E2 12 times.
    blocks = split_into_blocks((*patch.prompt, *patch.late))
    assert sorted(len(block[0]) for block in blocks) == [6, 6, 6, 6, 12, 13]


def test_what_nothing_holds_is_a_block_of_zeros():
    law = Algorithm1()
    system = delay_system(law, find_equilibrium(law, hexagonal_patch(2, 7.0)).q)
    blocks = split_into_blocks((*system.prompt, *system.late))
    assert [[x.tolist() for x in block] for block in blocks if len(block[0]) == 1] == [4 * [[[0.0]]]]


def test_blocks_have_the_margin_of_the_whole(patch):
    margin, top = delay_margin(patch), 1.01 * patch.highest
    whole = least_crossing((*patch.prompt, *patch.late), 1e-6 * top, top)
    assert margin.delay == pytest.approx(whole.delay, rel=1e-9)
    assert margin.frequency == pytest.approx(whole.frequency, rel=1e-9)
    assert margin.certified


@pytest.mark.parametrize("seed", range(5))
def test_hidden_blocks_are_found_and_equal_ones_once(seed):
    small, large = _unlike(seed, 2), _unlike(seed + 100, 3)
    blocks = sorted(split_into_blocks(_hidden([large, small, large], seed)), key=lambda block: len(block[0]))
    assert [len(block[0]) for block in blocks] == [2, 3]
    for block, planted in zip(blocks, (small, large), strict=True):
        for x, y in zip(block, planted, strict=True):
            np.testing.assert_allclose(np.poly(x), np.poly(y), rtol=0.0, atol=1e-9 * np.abs(np.poly(y)).max())


@pytest.mark.parametrize("seed", range(5))
def test_the_margin_is_the_least_of_the_blocks(seed):
    parts = [_unlike(seed, 3), _unlike(seed + 50, 2), _unlike(seed + 100, 3)]
    k0, d0, k1, d1 = _hidden(parts, seed)
    alone = [delay_margin(DelaySystem((a, b), (c, d))).delay for a, b, c, d in parts]
    assert 0.0 < min(alone) < max(alone)
    assert delay_margin(DelaySystem((k0, d0), (k1, d1))).delay == pytest.approx(min(alone), rel=1e-8)


def test_blocks_that_only_some_of_their_agents_are_heard_in_are_found():
    k0, d0, k1, d1 = _unlike(2, 2)
    deaf = np.triu(k0), np.triu(d0), np.triu(k1), np.triu(d1)  # the second agent hears nobody
    blocks = split_into_blocks(_hidden([deaf, _unlike(3, 3)], 4))
    assert sorted(len(block[0]) for block in blocks) == [2, 3]


def test_what_two_directions_are_coupled_to_joins_them():
    star = np.array([[0.0, 1.0, 2.0, 0.0], [-1.0, 0.0, 0.0, 0.0], [-2.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 3.0]])
    none = np.zeros((4, 4))
    blocks = split_into_blocks((np.diag([1.0, 2.0, 3.0, 4.0]), none, none, star))
    assert sorted(len(block[0]) for block in blocks) == [1, 3]


def test_parts_that_are_rounding_beside_their_counterparts_do_not_join_blocks():
    law = Algorithm1()
    system = delay_system(law, find_equilibrium(law, hexagonal_patch(3, 7.0)).q, delayed="pairs")
    assert 0.0 < np.abs(system.prompt[0]).max() < 1e-12 * np.abs(system.late[0]).max()
    blocks = split_into_blocks((*system.prompt, *system.late))
    assert sorted(len(block[0]) for block in blocks) == [1, 6, 6, 6, 6, 12, 12]


def test_one_block_whose_search_is_cut_short_leaves_the_margin_open(monkeypatch):
    stiff = np.zeros((1, 1)), np.ones((1, 1)), 50.0 * np.ones((1, 1)), np.zeros((1, 1))
    k0, d0, k1, d1 = _hidden([_unlike(0, 3), stiff], 5)
    system = DelaySystem((k0, d0), (k1, d1))
    assert delay_margin(system).certified
    monkeypatch.setattr(axis_crossings, "MOST", 3)
    assert delay_margin(system).least == 0.0


def test_weakly_coupled_blocks_are_kept_whole():
    four = _hidden([_unlike(1, 2), _unlike(2, 3)], 3)
    coupled = (four[0] + 1e-9 * np.ones((5, 5)), *four[1:])
    assert len(split_into_blocks(four)) == 2
    assert split_into_blocks(coupled) == [coupled]


@pytest.mark.parametrize(("n", "share"), [(8, 1e-6), (12, 1e-3), (20, 1e-3)])
def test_many_directions_of_one_eigenspace_are_kept_whole(n, share):
    rng = np.random.default_rng(1)
    turns = np.kron(np.eye(n // 2), [[0.0, 1.0], [-1.0, 0.0]])
    late = [gain * turns + share * (x - x.T) for gain, x in zip((0.9, 0.8), rng.normal(size=(2, n, n)), strict=True)]
    four = (np.eye(n), 2.0 * np.eye(n), *late)
    assert split_into_blocks(four) == [four]


@pytest.mark.parametrize("power", [-36, -43, -45, -48])
def test_blocks_far_softer_than_others_are_not_split_off(power):
    """All entries are dyadic; the margin is that of the soft block alone."""
    soft, wide = 2.0**power, 2.0**-8
    k, d, late = (np.array(x) for x in ([[2, 0.75], [0.75, 1]], [[1, 0.25], [0.25, 0.75]], [[1, 0.25], [0.25, 0.5]]))
    none = np.zeros((2, 2))

    def mixed(x, y):
        return np.block([[x + y, x - y], [x - y, x + y]]) / 2.0

    prompt = mixed(soft * k, k), mixed(wide * d, 3.0 * d)
    late_part = mixed(0.5 * soft * late, none), mixed(2.0 * wide * late, none)
    assert len(split_into_blocks((*prompt, *late_part), neutral=False)) == 1
    alone = delay_margin(DelaySystem((soft * k, wide * d), (0.5 * soft * late, 2.0 * wide * late)))
    assert alone.certified
    margin = delay_margin(DelaySystem(prompt, late_part))
    assert margin.delay >= (1.0 - 1e-5) * alone.delay
    assert margin.least == 0.0  # of a motion that soft rounding may hide the crossing: the margin is at most the delay


def test_drags_that_cancel_to_rounding_are_no_crossing_of_a_neutral_motion():
    ring = (np.roll(np.eye(5), 1, 0) + np.roll(np.eye(5), -1, 0)) / 2.0
    k, d = np.array([[2.0, 0.7], [0.7, 1.0]]), np.array([[1.0, 0.3], [0.3, 0.45]])
    prompt = np.kron(np.eye(5) - ring, k), np.kron(np.eye(5), d)
    margin = delay_margin(DelaySystem(prompt, (np.zeros((10, 10)), -np.kron(ring, d)), neutral=4))
    assert margin.delay == margin.least == np.inf
