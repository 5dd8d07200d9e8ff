"""What a class says of its methods, where subclasses change them."""

from dataclasses import dataclass

import numpy as np
import pytest

import flockana as fl
import flockana.interactions.dead_zone
import flockana.laws.bearing_distance
from flockana.base.errors import ArgumentError
from flockana.base.overrides import overrides_consistently
from flockana.equilibria.rest import resting_state
from flockana.interactions.weights import RationalWeight


class Base:
    def form(self): ...
    def act(self): ...


class Unchanged(Base):
    def other(self): ...


class Changed(Base):
    def act(self): ...


class Both(Changed):
    def form(self): ...


class Later(Both):
    def act(self): ...


@pytest.mark.parametrize(("kind", "true"), [(Base, 1), (Unchanged, 1), (Changed, 0), (Both, 1), (Later, 0)])
def test_a_form_holds_until_a_subclass_changes_what_it_stands_for(kind, true):
    assert overrides_consistently(kind, "form", ["act"]) == bool(true)


@dataclass(frozen=True)
class Noisy(fl.Algorithm1):
    def acceleration(self, t, q, p):
        return super().acceleration(t, q, p) + 1e6


@dataclass(frozen=True)
class Mixed(Noisy, fl.Algorithm2):
    """Both, in one order of resolution."""


@dataclass(frozen=True)
class Heavier(fl.Algorithm1):
    def energy(self, t, q, p):
        return 2.0 * super().energy(t, q, p)


@dataclass(frozen=True)
class Braked(fl.Algorithm1):
    def energy_rate(self, t, q, p):
        return -1.0


@dataclass(frozen=True)
class Stronger(fl.AlphaInteraction):
    def phi_alpha(self, z):
        return 2.0 * super().phi_alpha(z)


@dataclass(frozen=True)
class Farther(fl.BetaInteraction):
    def phi_beta(self, z):
        return 2.0 * super().phi_beta(z)


@dataclass(frozen=True)
class Larger(fl.Sphere):
    def clearance(self, q):
        return super().clearance(q) - 1.0


@dataclass(frozen=True)
class Even(RationalWeight):
    def __call__(self, distance):
        return 1.0


@dataclass(frozen=True)
class Standing(fl.ZoneFlocking):
    def step(self, t, q, p, memory):
        return q, p, 0.0 * q, memory


LED = {"target": fl.StaticTarget((0.0,))}
IGNORED = {
    "acceleration": Noisy(),
    "acceleration of a mixture": Mixed(**LED),
    "energy": Heavier(),
    "energy_rate": Braked(),
    "phi_alpha": fl.Algorithm1(alpha=Stronger()),
    "phi_beta": fl.Algorithm3(**LED, beta=Farther(), obstacles=(fl.Sphere((9.0,), 1.0),)),
    "clearance": fl.Algorithm3(**LED, obstacles=(Larger((9.0,), 1.0),)),
    "__call__": fl.CuckerSmale(Even(1.0, 0.5, 1.0)),
    "step": Standing(fl.ZoneRadii(r=1.0, a=3.0)),
}


@pytest.mark.parametrize("name", IGNORED)
def test_a_method_that_the_integrators_would_ignore_is_refused(name):
    of = r"flow|hamiltonian|kernels|par|iterate"
    message = rf"defines {name.split()[0]}, but not ({of}), from which it follows: .* would be ignored"
    law = IGNORED[name]
    with pytest.raises(ArgumentError, match=message):
        fl.simulate(law, [[0.0], [8.0]], [[0.0], [0.0]], (0.0, 1.0))
    with pytest.raises(ArgumentError, match=message):
        fl.Trajectory([0.0], *np.zeros((3, 1, 2, 1)), law)


@pytest.mark.parametrize("ask", [fl.linearise, fl.find_equilibrium, resting_state], ids=lambda ask: ask.__name__)
def test_what_follows_from_the_law_alone_refuses_it_too(ask):
    with pytest.raises(ArgumentError, match="Noisy defines acceleration, but not flow"):
        ask(Noisy(), [[0.0], [7.0]])


def test_what_an_instance_was_given_of_its_own_is_refused():
    law = fl.Algorithm1()
    object.__setattr__(law, "flow", lambda t, q, p: (1e6 + 0.0 * q, 0.0))
    with pytest.raises(ArgumentError, match="this Algorithm1 was given its own flow, which compiled code would not"):
        fl.simulate(law, [[0.0], [8.0]], [[0.0], [0.0]], (0.0, 1.0))


def test_a_law_that_defines_the_source_anew_is_integrated_with_it():
    @dataclass(frozen=True)
    class Drifting(fl.Algorithm1):
        def flow(self, t, q, p):
            return super().flow(t, q, p)[0] + 1.0, float("nan")

        def hamiltonian(self, t, q, p):
            return float("nan")

        def acceleration(self, t, q, p):
            return self.flow(t, q, p)[0]

    run = fl.simulate(Drifting(), [[0.0], [8.0]], [[0.0], [0.0]], (0.0, 1.0))
    assert run.q[-1].mean() == pytest.approx(4.5)


def test_what_is_said_to_follow_exists():
    modules = (fl, flockana.laws.bearing_distance, flockana.interactions.dead_zone, flockana.interactions.weights)
    kinds = {kind for module in modules for kind in vars(module).values() if hasattr(kind, "derived_methods")}
    for kind in (*kinds, *(getattr(fl, name) for name in ("AlphaInteraction", "BetaInteraction", "Algorithm1"))):
        for source, names in kind.derived_methods.items():
            assert all(callable(getattr(kind, name)) or name == "c_star" for name in names), (kind, source)
