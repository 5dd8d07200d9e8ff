"""Energies: identities of every flock, printed ones that are none, Theorem 6 with and without its hypotheses."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from flockana import Algorithm1, Algorithm3, BetaInteraction, Gains, Sphere, StaticTarget, Wall
from tests.adversarial import truth
from tests.adversarial.cases import FALSE, OPEN, REFUTED, TRUE, Case, effort, hold
from tests.adversarial.strategies import flocks, pair_laws, powers, starts, ways

THEOREMS = ("energy", "energy-printed", "os-6", "os-3", "os-1", "E13")
STILL = {"rate": TRUE, "balance": TRUE}


@effort(1.0)
@given(flocks())
def test_what_holds_of_every_flock(case):
    law = case.law
    hold("energy", case, STILL, may_refuse=case.rough)
    hold("collision-energy", case, {"below": TRUE}, may_refuse=case.rough)
    if isinstance(law, Algorithm1):
        damped = TRUE if law.gains.c2_alpha > 0.0 else TRUE | FALSE
        hold("os-1", case, {"ii": damped, "iii": TRUE, "iii-barrier": TRUE}, may_refuse=case.rough)
        return
    single = {"i": TRUE, "ii": TRUE, "iii": TRUE}
    if min(law.gains.c1_gamma, law.gains.c2_gamma) == 0.0:
        single = dict.fromkeys(single, OPEN)
    counts = {"iv-instant": TRUE, "iv-none": TRUE, "iv-barrier": TRUE}
    hold("os-3", case, single | counts, may_refuse=case.rough)
    hold("E13", case, {"corrected": TRUE}, may_refuse=case.rough)


def algorithm3(law, obstacles=(), **gains):
    kept = {name: getattr(law.gains, name) for name in ("c1_alpha", "c2_alpha")}
    time = truth.law_time(law)
    beta = BetaInteraction(d=0.6 * law.alpha.d, r=0.72 * law.alpha.d, eps=law.alpha.eps, unit=law.alpha.unit)
    target = StaticTarget((0.0, 0.0), gains.pop("told", 0.0))
    scaled = {name: value / time ** (2 if "c1" in name else 1) for name, value in gains.items()}
    return Algorithm3(law.alpha, Gains(**kept, **scaled), target, beta, obstacles)


@effort(0.3)
@given(pair_laws(algorithm=1), powers(-9.0, 0.5), st.sampled_from((1.0, 0.8, 2.0)), st.data())
def test_the_printed_energy_of_two_agents(law, speed, apart, data):
    """E2 without damping: H keeps its value, so the printed H + V rises if and only if V does: always on the way in.

    Agents that part from their balance climb to r first; agents out of range that part never do anything.
    """
    undamped = Algorithm1(law.alpha, Gains(law.gains.c1_alpha, 0.0))
    free = algorithm3(undamped, c1_beta=0.0, c2_beta=0.0, c1_gamma=0.0, c2_gamma=0.0)
    d, time = law.alpha.d, truth.law_time(law)
    inward = data.draw(st.booleans())
    q = np.array([[-0.5 * apart * d, 0.0], [0.5 * apart * d, 0.0]])
    q *= 1.1 * law.alpha.r / (apart * d) if apart == 2.0 else 1.0  # out of range whatever κ is
    p = np.array([[0.5, 0.0], [-0.5, 0.0]]) * speed * d / time * (1.0 if inward else -1.0)
    until = 0.5 * time * min(1.0, 0.2 / speed)
    case = Case(free, q, p, until, data.draw(ways(until, until / 200.0)))
    still = apart == 2.0  # out of range for this long
    at_balance = apart == 1.0 and np.size(case.options.get("t_eval", (0.0, until))) == 1  # where V is still for once
    rises = not still and not at_balance and (inward or apart == 1.0)
    clear = rises and apart == 1.0 and speed > 0.1 and not case.options
    expected = REFUTED if clear else FALSE if rises and apart == 1.0 else TRUE if still else TRUE | FALSE
    hold("energy-printed", case, {"printed-run": expected}, may_refuse=case.rough)
    hold("energy", case, STILL, may_refuse=case.rough)


@st.composite
def among_obstacles(draw):
    """A few agents beside walls and spheres under Algorithm 3 with a γ-agent that does not move."""
    law = draw(pair_laws(algorithm=1))
    d, time = law.alpha.d, truth.law_time(law)
    some = [Wall((0.0, -3.0 * d), (0.0, 1.0)), Sphere((4.0 * d, 0.0), d), Sphere((-5.0 * d, d), 2.0 * d)]
    told = draw(st.sampled_from((0.0, (0.5 * d / time, 0.0))))
    gains = {name: draw(st.sampled_from((0.0, 0.3, 3.0))) for name in ("c1_beta", "c2_beta", "c1_gamma", "c2_gamma")}
    full = algorithm3(law, tuple(some[: draw(st.integers(0, 3))]), told=told, **gains)
    q, p = draw(starts(d, d / time, m=2))
    far = np.abs(q).max() > 2.0 * d
    q = q * (2.0 * d / np.abs(q).max() if far else 1.0)  # between the obstacles
    until = time * draw(powers(-6.0, 1.0))
    return Case(full, q, p, until, draw(ways(until, min(until, time) / 50.0 + until / 2000.0)))


@effort(0.3)
@given(among_obstacles())
def test_theorem_6(case):
    hold("os-6", case, STILL, may_refuse=case.rough)
    hold("energy", case, STILL, may_refuse=case.rough)


@pytest.mark.parametrize("strong", [1.0, 1e-6, 1e3])
def test_theorem_6_needs_one_drag_for_all(strong):
    """Per-agent c2γ: condition (76) holds with room to spare, and the energy rises all the same."""
    gains = Gains(1.0, 0.0, 0.0, 0.0, 0.0, (strong, 1e-12 * strong))
    law = Algorithm3(gains=gains, target=StaticTarget((0.0, 0.0), (1.0, 0.0)))
    q, p = np.array([[0.0, 0.0], [100.0, 0.0]]), np.array([[0.5, 0.0], [3.0, 0.0]])
    hold("os-6", Case(law, q, p, 0.05 / max(strong, 1.0)), {"rate": OPEN, "balance": TRUE})
