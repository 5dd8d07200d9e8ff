import numpy as np
import pytest

from benchmarks.c_loop import Loop, compiled
from benchmarks.flocks import FLOCKS, R
from flockana import Algorithm2, AlphaInteraction, StaticTarget, simulate
from flockana.kernels.neighbours import pair_blocks


@pytest.fixture(scope="module")
def library():
    loaded = compiled()
    if loaded is None:
        pytest.skip("no C compiler")
    return loaded


@pytest.mark.parametrize("kind", FLOCKS)
def test_force_and_power_are_the_law_s(library, kind):
    law = Algorithm2(alpha=AlphaInteraction(a=3.0, b=5.0, h=0.4), target=StaticTarget((0.0, 0.0)))
    q, p = FLOCKS[kind](2000)
    u, rate = law.flow(0.0, q, p)
    loop = Loop(library, law, len(q))
    assert loop.build(q, p) == sum(i.size for i, _ in pair_blocks(q, R))
    repeated = (lambda: loop.repeated(q, p, 3, rebuild=False), lambda: loop.repeated(q, p, 3, rebuild=True))
    for compute in (lambda: loop.flow(q, p), lambda: loop.rebuilt_flow(q, p), *repeated):
        found = compute()
        np.testing.assert_allclose(found[0], u, rtol=0.0, atol=1e-12 * np.abs(u).max())
        assert found[1] == pytest.approx(rate, rel=1e-12)
    loop.close()


def test_a_list_with_a_skin_serves_flocks_that_moved_within_it(library):
    law = Algorithm2(target=StaticTarget((0.0, 0.0)))
    q, p = FLOCKS["gas"](500)
    loop = Loop(library, law, len(q))
    loop.build(q, p, skin=1.0)
    moved = q + 0.35 * np.sign(p)  # 0.495 at most: less than half the skin
    u = law.flow(0.0, moved, p)[0]
    np.testing.assert_allclose(loop.flow(moved, p)[0], u, rtol=0.0, atol=1e-12 * np.abs(u).max())
    loop.close()


def test_a_run_in_c_ends_where_ours_does(library):
    """Forty steps of a gas whose list, with half the skin, is made anew on the way."""
    law, (q, p) = Algorithm2(target=StaticTarget((0.0, 0.0))), FLOCKS["gas"](500)
    loop = Loop(library, law, len(q))
    run = simulate(law, q, p, (0.0, 0.2), method="RK4", dt=0.005, t_eval=[0.2])
    end, speed, lists = loop.stepped(q, p, 0.005, 40, 0.5)
    loop.close()
    np.testing.assert_allclose(end, run.q[-1], rtol=0.0, atol=1e-11 * np.abs(q).max())
    np.testing.assert_allclose(speed, run.p[-1], rtol=0.0, atol=1e-11 * np.abs(run.p).max())
    assert lists > 1
