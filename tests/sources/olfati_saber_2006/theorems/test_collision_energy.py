"""What is left to a meeting, of agents at rest whose energy is known."""

import numpy as np
import pytest

from flockana import Algorithm1, AlphaInteraction, Composition, Gains, compose, pair_law
from flockana.theorems.rounding_bounds import energy_error
from tests.theorems.made_up import hypothesis, judged, made_up, statuses

WELL = pair_law(
    "k*((s-r)**2*(2*s+r) - r**3/2)*(s-r)**2", adjacency="(1-s/r)**2", range=3.0, length=2.0, parameters={"k": 1.0}
)


def verdict_of(law, *places, p=None):
    q = np.array(places)[:, None]
    return judged("collision-energy", made_up(law, [q, q], p))


@pytest.mark.parametrize("speed", [0.0, 3.0, 11.0, 15.0, 30.0])
@pytest.mark.parametrize("places", [(0.0, 1.0), (0.0, 2.0), (0.0, 1.5, 3.5)])
def test_of_another_pair_law_the_least_of_all_pairs_is_taken_off(places, speed):
    law = compose(pair=WELL, consensus=0.5)
    n = len(places)
    s = np.linspace(0.0, 3.0, 4001)
    least, gain = float(WELL.energy(s).min()), law.gains.c1_alpha
    p = np.zeros((2, n, 1))
    p[:, 0], p[:, -1] = speed, -speed
    pairs = [abs(a - b) for k, a in enumerate(places) for b in places[:k]]
    above = gain * float(WELL.energy(np.array(pairs)).sum()) + speed**2 - gain * least * len(pairs)
    needed = gain * (float(WELL.energy(np.array([0.0]))[0]) - least)
    verdict = verdict_of(law, *places, p=p)
    for text, times in (("c*", 1.0), ("2 c*", 2.0)):
        found = hypothesis(verdict, f"H(0) < {text}")
        assert found.margin == pytest.approx(times * needed - above, rel=1e-9)
        assert found.status == ("met" if above < times * needed else "unmet")
    assert not [one for one in verdict.hypotheses if one.status == "assumed"]  # the least is proved


def test_the_energy_is_that_of_the_start():
    q, p = np.array([[[0.0], [7.0]], [[-900.0], [6.0]]]), np.array([[[10.0], [-10.0]], [[9.0], [-9.0]]])
    law = Algorithm1()
    found = hypothesis(judged("collision-energy", made_up(law, q, p)), "H(0) < c*")
    rounding = energy_error(law, q[:1], p[:1], np.array([100.0]))[0]
    assert rounding <= found.error <= rounding + 2.0 * np.spacing(found.margin)
    assert found.margin == pytest.approx(30.0 * AlphaInteraction().c_star - 100.0, rel=1e-9)


@pytest.mark.parametrize(("thrust", "status"), [(-0.5, "verified"), (0.0, "verified"), (0.5, "vacuous")])
def test_a_composition_that_is_driven_gains_energy(thrust, status):
    law = Composition(alpha=AlphaInteraction(), gains=Gains(), target=None, thrust=thrust)
    verdict = verdict_of(law, 0.0, 7.0)
    assert set(statuses(verdict).values()) == {status}
    assert (verdict.hypotheses[-1].name == "no thrust: α <= 0") == (thrust > 0.0)
