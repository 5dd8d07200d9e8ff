"""Any pair potential: truths of random ones, and what lacks a property, which nothing is claimed of."""

from math import sqrt

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from flockana import Algorithm1, Algorithm2, Gains, LinearTarget, StaticTarget, pair_law
from tests.adversarial.cases import OPEN, TRUE, VACUOUS, VERIFIED, Case, effort, hold
from tests.adversarial.strategies import powers, seeds

THEOREMS = ("any-potential",)
CLAIMS = ("cohesion", "velocities", "critical", "one-instant", "no-collision")
CUT = "(1 - s**2/r**2)**2"
FORMULAS = {  # ψ, and what it is at contact
    "morse": (f"k*((1 - exp(-a*(s/d - 1)))**2 - 1)*{CUT}", "finite"),
    "lennard-jones": (f"k*((d/s)**6 - 2*(d/s)**3)*{CUT}", "infinite"),
    "well": ("k*(s**2 - d**2)**2*(r**2 - s**2)**2/r**8", "smooth"),
}


def pair(name, unit=1.0, adjacency="(1 - s/r)**2", **numbers):
    formula, contact = FORMULAS[name]
    known = {"k": numbers.pop("k", 1.0)} | ({"a": numbers.pop("a", 2.0)} if name == "morse" else {})
    return pair_law(formula, adjacency=adjacency, range=1.6 * unit, length=unit, parameters=known), contact


@st.composite
def flocks(draw):
    """A flock of two to five in any unit, slow to fast, near each other or not, under Algorithm 1 or 2."""
    rng = np.random.default_rng(draw(seeds))
    unit, n, m = draw(st.sampled_from((1.0, 1e-6, 1e3))), draw(st.integers(2, 5)), draw(st.integers(1, 3))
    alpha, contact = pair(draw(st.sampled_from(sorted(FORMULAS))), unit, k=unit**2)
    grid = np.array([(*spot,)[:m] for spot in np.ndindex(*[n] * m)], dtype=float)[:n]
    q = unit * (draw(st.sampled_from((0.9, 1.3))) * grid + 0.1 * rng.uniform(-1.0, 1.0, (n, m)))
    p = unit * draw(powers(-3.0, 0.3)) * rng.normal(size=(n, m))
    gains = Gains(c1_alpha=1.0, c2_alpha=draw(st.sampled_from((0.5, 2.0))), c1_gamma=0.3, c2_gamma=0.5)
    target = draw(st.sampled_from((StaticTarget((0.0,) * m), LinearTarget((0.0,) * m, (unit,) * m))))
    law = Algorithm2(alpha, gains, target) if draw(st.booleans()) else Algorithm1(alpha, gains)
    return Case(law, q, p, draw(st.sampled_from((0.05, 3.0)))), contact


@effort(0.25)
@given(flocks())
def test_what_holds_of_every_flock(drawn):
    """The theorem is true, so nothing is refuted; of Algorithm 2 most is proved whatever the run is."""
    case, contact = drawn
    said = hold("any-potential", case, dict.fromkeys(CLAIMS, TRUE))
    if case.run.status != "complete" or isinstance(case.law, Algorithm1):
        hold("os-1" if isinstance(case.law, Algorithm1) else "os-3", case, {"ii": TRUE, "iii": TRUE})
        return
    proved = {"cohesion": VERIFIED, "velocities": VERIFIED, "one-instant": VERIFIED}
    hold("any-potential", case, proved | ({"no-collision": VERIFIED} if contact == "infinite" else {}))
    assert said.claim("critical").status == ("verified" if contact != "finite" else said.claim("critical").status)
    hold("os-3", case, {"i": VERIFIED, "ii": OPEN, "ii-converges": OPEN, "iii": VERIFIED, "iv-none": TRUE})


@effort(0.2)
@given(powers(-6.0, -1.0), st.booleans(), st.sampled_from((1.0, 1e-6)))
def test_two_agents_beside_the_energy_of_a_meeting(off, above, unit):
    """Head on with E = v² + c1γ d²/4 = (1 ± off) c*, c* = k d⁴/r⁴: below it they never meet."""
    alpha, _ = pair("well", unit, k=unit**2)
    c_star, pull = unit**2 / 1.6**4, 0.01
    speed = sqrt((1.0 + off if above else 1.0 - off) * c_star - pull * unit**2 / 4.0)
    gains = Gains(c1_alpha=1.0, c2_alpha=0.5, c1_gamma=pull, c2_gamma=0.1)
    case = Case(Algorithm2(alpha, gains, StaticTarget((0.0,))), [[0.0], [unit]], [[speed], [-speed]], 2.0)
    verdict = hold("any-potential", case, dict.fromkeys(CLAIMS, TRUE) | {"velocities": VERIFIED, "critical": VERIFIED})
    assert verdict.claim("no-collision").status == ("vacuous" if above else "verified")


@effort(0.2)
@given(st.sampled_from((0.97, 1.03)), st.sampled_from(sorted(FORMULAS)))
def test_two_agents_beside_the_energy_of_parting(share, name):
    """Two at rest distance that part with E beside ψ(r) − L: below it they stay a flock, above it that is open."""
    alpha, _ = pair(name)
    room = alpha.far_potential - float(alpha.energy(np.linspace(0.5, 1.6, 20001)).min())
    rest = float(np.linspace(0.5, 1.6, 20001)[alpha.energy(np.linspace(0.5, 1.6, 20001)).argmin()])
    speed = sqrt(share * room)
    law = Algorithm1(alpha, Gains(c1_alpha=1.0, c2_alpha=1e-6))
    case = Case(law, [[0.0], [rest]], [[-speed], [speed]], 0.3)
    verdict = hold("any-potential", case, dict.fromkeys(CLAIMS, TRUE))
    if room > 0.0 and share < 1.0:
        assert verdict.claim("velocities").status == "verified"
    else:
        assert verdict.claim("velocities").status != "verified"


LACKING = {
    "a force that jumps at the range": {"potential": "k*(s - d)**2", "adjacency": "(1 - s/r)**2"},
    "no least value": {"potential": "-k*(r - s)**2/s", "adjacency": "(1 - s/r)**2"},
    "an adjacency that drives apart": {"potential": FORMULAS["well"][0], "adjacency": "-(1 - s/r)**2"},
}


@pytest.mark.parametrize("what", LACKING)
@pytest.mark.parametrize("number", [1, 2])
def test_what_lacks_a_property_is_claimed_nothing_of(what, number):
    formula = LACKING[what]
    alpha = pair_law(**formula, range=1.6, length=1.0, parameters={"k": 1.0})
    gains = Gains(c1_alpha=1.0, c2_alpha=0.5, c1_gamma=0.3, c2_gamma=0.5)
    law = Algorithm1(alpha, gains) if number == 1 else Algorithm2(alpha, gains, StaticTarget((0.0,)))
    case = Case(law, [[0.0], [1.0], [2.1]], [[0.1], [0.0], [-0.1]], 0.5)
    hold("any-potential", case, dict.fromkeys(CLAIMS, VACUOUS))
    hold("os-1" if number == 1 else "os-3", case, {"ii": VACUOUS, "iii": VACUOUS})


def test_an_adjacency_that_vanishes_inside_ties_no_velocities():
    for adjacency, said in (("Piecewise(((1/2 - s)**2, s < 1/2), (0, True))", VACUOUS), ("(1 - s/r)**2", VERIFIED)):
        law = Algorithm1(pair("morse", adjacency=adjacency)[0], Gains(c1_alpha=1.0, c2_alpha=0.5))
        case = Case(law, [[0.0], [1.0]], [[0.1], [-0.1]], 0.5)  # too little energy to part
        hold("any-potential", case, dict.fromkeys(CLAIMS, said))
        hold("os-1", case, {"ii": said, "iii": said})


def test_an_unbounded_force_at_contact_is_left_open():
    """ψ = (1 − √s)² has ψ(0) = 1 and no bound of its force: above c* nothing is said of velocities."""
    alpha = pair_law("(1 - sqrt(s))**2*(2 - s)**2", adjacency="(1 - s/r)**2", range=2.0, length=1.0)
    gains = Gains(c1_alpha=1.0, c2_alpha=0.5, c1_gamma=0.3, c2_gamma=0.5)
    for speed, said in ((0.1, VERIFIED), (5.0, OPEN)):
        case = Case(Algorithm2(alpha, gains, StaticTarget((0.0, 0.0))), [[0.0, 0.0], [1.0, 0.0]],
                    [[0.0, speed], [0.0, -speed]], 0.2)  # fmt: skip
        hold("any-potential", case, {"velocities": said, "critical": said, "cohesion": VERIFIED})
