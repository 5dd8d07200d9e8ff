"""Laws as sums of terms: what each has, and that sums are sums."""

import numpy as np
import pytest

from flockana import Algorithm3, Copies, Navigation, PairTerm, PeerToPeer, Sphere, Spring, Wall, ZoneFlocking
from flockana.environment.beta_agents import ObstacleField
from flockana.environment.targets import LinearTarget, StaticTarget
from flockana.interactions import AlphaInteraction, BetaInteraction, Gains
from flockana.laws.olfati_saber import Algorithm1, Algorithm2
from flockana.laws.terms.obstacles import ObstacleTerm
from flockana.solvers.semi_implicit_euler import SemiImplicitEuler
from flockana.sources.isola_2024.laws import MSNDiscretisation
from flockana.sources.jond_2025.laws.minimal import MinimalFlocking
from flockana.sources.li_dead_zone import DeadZoneInteraction
from flockana.sources.li_dead_zone.laws.dead_zone import DeadZoneFlocking
from flockana.sources.li_dead_zone.laws.with_leaders import LedDeadZoneFlocking
from flockana.sources.notebook_r2.laws import PushedAlgorithm1, PushedAlgorithm2
from flockana.sources.zavlanos_2007.laws import LinkKeeping

TARGET = LinearTarget((9.0, 1.0), (1.0, -0.5))
SOLIDS = (Sphere((20.0, 0.0), 3.0), Wall((0.0, -9.0), (0.0, 1.0)))
FENCES = ObstacleTerm(ObstacleField(SOLIDS, BetaInteraction()), 1.0, 1.0)
EACH = Gains(c1_gamma=(1.0, 2.0, 3.0, 1.0), c2_gamma=(2.0, 1.0, 1.0, 0.5))
SUMS = {
    "1": Algorithm1(),
    "2": Algorithm2(target=TARGET),
    "2 each": Algorithm2(gains=EACH, target=TARGET),
    "3": Algorithm3(target=TARGET, obstacles=SOLIDS),
    "3 each": Algorithm3(gains=EACH, target=TARGET, obstacles=SOLIDS),
    "dead zone": DeadZoneFlocking(),
    "pushed": PushedAlgorithm2(target=TARGET, min_distance=2.0),
}
Q = np.array([[0.0, -7.0], [6.5, 0.5], [8.0, 0.0], [15.5, -5.5]])
P = np.array([[1.0, 0.0], [0.2, -1.0], [0.0, 2.0], [-0.5, 0.3]])


@pytest.mark.parametrize("name", SUMS)
def test_force_power_energy_and_hessian_are_sums(name):
    law, t = SUMS[name], 0.7
    u, rate, energy = np.zeros_like(Q), 0.0, 0.0
    for term in law.terms:
        own = np.zeros_like(Q)
        rate += term.act(t, Q, P, own)
        energy += term.energy(t, Q)
        u += own
    v = P - P.mean(axis=0) if law.moving else P
    np.testing.assert_allclose(law.acceleration(t, Q, P), u, rtol=1e-12, atol=1e-12)
    assert law.energy_rate(t, Q, P) == pytest.approx(rate, rel=1e-12)
    assert law.energy(t, Q, P) == pytest.approx(energy + 0.5 * np.sum(v * v), rel=1e-14)


OWN = PeerToPeer(Copies(Q + 3.0, 0.0 * Q, Spring((3.0, 1.0), 0.2, 0.1)), gains=Gains(c1_gamma=(1.0, 2.0, 0.5, 4.0)))
LINKED = LinkKeeping(((0, 1), (1, 2)), r=20.0)
LED = LedDeadZoneFlocking(leaders=(StaticTarget((1.0, 2.0)), TARGET), group=(0, 1, 1, 0), pinned=(0, 1), c1=0.7)


@pytest.mark.parametrize("law", [*(law for name, law in SUMS.items() if name != "pushed"), LED, LINKED, OWN])
def test_stiffness_is_the_second_derivative_of_the_potential_energy(law):
    """Along ways of all coordinates at once, of the shape alone where the energy is the shape's."""
    t, h, stiffness = 0.7, 1e-3, law.stiffness(Q, 0.7)
    for way in np.random.default_rng(2).normal(size=(6, *Q.shape)):
        way -= way.mean(axis=0) if law.moving else 0.0
        energies = [law.potential_energy(t, Q + k * h * way) for k in (-2, -1, 0, 1, 2)]
        found = np.dot([-1.0, 16.0, -30.0, 16.0, -1.0], energies) / (12.0 * h * h)
        assert way.ravel() @ (stiffness @ way.ravel()) == pytest.approx(found, rel=1e-5, abs=1e-5)


class Drawn(Navigation):
    """One that acts in its own way: it has no compiled form."""

    def act(self, t, q, p, u):
        return super().act(t, q, p, u)


class Added(Algorithm1):
    """One with two terms more than Algorithm 1."""

    more = ()

    @property
    def terms(self):
        return (*super().terms, *self.more)


@pytest.mark.parametrize("name", SUMS)
def test_integrators_get_every_term_or_none(name):
    law, compiled = SUMS[name], SUMS[name].compiled(2)
    if name == "pushed":  # its own flow
        assert compiled is None
    else:
        kinds = {type(one) for one in law.obstacles}  # each is a term of its own
        terms = len(law.terms) + (len(kinds) - 1 if kinds else 0)
        assert (len(compiled.terms), compiled.moving) == (terms, law.moving)


def test_of_obstacles_each_kind_is_compiled_once_whatever_is_beside_it():
    both, alone = (Algorithm3(target=TARGET, obstacles=each) for each in ((*SOLIDS[::-1], *SOLIDS), SOLIDS[:1]))
    wall, sphere, only = (
        term for law in (both, alone) for term in law.compiled(2).terms if "obstacle_sums" in term.act.__module__
    )
    for name in ("act", "energy"):
        assert getattr(sphere, name) is getattr(only, name) is not getattr(wall, name)
    wall_kind, sphere_kind, only_kind = (kind.kernels for law in (both, alone) for kind in law.obstacle_field.kinds)
    assert sphere_kind.guard is only_kind.guard is not wall_kind.guard
    assert (sphere.numbers[0], wall.numbers[0], only.numbers[0]) == (2, 2, 1)


@pytest.mark.parametrize(
    ("more", "terms"),
    [
        ((), 1),
        ((Navigation(TARGET, Gains()),) * 11, 12),
        ((FENCES,) * 3, 7),
        ((FENCES,) * 4, 9),
        ((Drawn(TARGET, Gains()),), None),
        ((Navigation(TARGET, Gains()), Drawn(TARGET, Gains())), None),
    ],
)
def test_a_term_without_a_compiled_form_leaves_the_law_without(more, terms):
    found = type("Own", (Added,), {"more": more})().compiled(2)
    assert (None if found is None else len(found.terms)) == terms


def test_what_laws_have():
    msn = MSNDiscretisation(Algorithm2(target=StaticTarget((0.0,))), dt=0.1)
    table = {
        "Algorithm1": (SUMS["1"], True, True, (7.0, 8.4), None, 0),
        "Algorithm2": (SUMS["2"], True, True, (7.0, 8.4), TARGET, 0),
        "Algorithm2 each": (SUMS["2 each"], True, False, (7.0, 8.4), TARGET, 0),
        "Algorithm3": (SUMS["3"], True, False, (7.0, 8.4), TARGET, 2),
        "dead zone": (SUMS["dead zone"], True, True, None, None, 0),
        "pushed": (PushedAlgorithm1(), False, True, (7.0, 8.4), None, 0),
        "led": (LED, False, False, None, None, 0),
        "minimal": (MinimalFlocking(), False, False, None, None, 0),
        "zones": (ZoneFlocking(), False, False, None, None, 0),
        "msn": (msn, False, False, (7.0, 8.4), msn.law.target, 0),
        "euler": (SemiImplicitEuler(SUMS["3"]), False, False, (7.0, 8.4), TARGET, 2),
    }
    for name, (law, *expected) in table.items():
        has = [law.conservative, law.centre_decouples, law.lattice, law.target, len(law.obstacles)]
        assert has == expected, name
    assert SUMS["dead zone"].pair == DeadZoneInteraction()
    assert msn.pair == AlphaInteraction()
    assert (ZoneFlocking().pair, MinimalFlocking().pair) == (None, None)
    assert [type(term) for term in SUMS["3"].terms] == [PairTerm, ObstacleTerm, Navigation]
    assert SUMS["3"].term(Navigation).target is TARGET
    assert MinimalFlocking().term(Navigation) is None
    assert SUMS["3"].obstacle_field.obstacles == SOLIDS


def test_what_a_law_lacks_is_no_default_of_its_parameters():
    """A law of one's own may name a parameter `target` or `pair` and give it no default."""
    with pytest.raises(AttributeError, match="'Algorithm1' object has no attribute 'colour'"):
        _ = Algorithm1().colour
    assert not hasattr(Algorithm1, "target")
    assert not hasattr(Algorithm1, "pair")
