"""What a class says of its methods, where subclasses change them."""

from dataclasses import dataclass

import numpy as np
import pytest

import flockana as fl
import flockana.sources.jond_2025.laws.zone_flocking
import flockana.sources.li_dead_zone.interactions
from flockana.base.errors import ArgumentError
from flockana.base.override_checks import overrides_consistently
from flockana.equilibria.rest_without_potential import resting_state
from flockana.interactions.weights import RationalWeight


def derived(*bases, **methods):
    """A frozen dataclass that changes some methods of others."""
    return dataclass(frozen=True)(type("Changed", bases, methods | {"__module__": __name__}))


class Base:
    def form(self): ...
    def act(self): ...


Acts, Other = derived(Base, act=None), derived(Base, other=None)
Both = derived(Acts, form=None)


@pytest.mark.parametrize(("kind", "true"), [(Base, 1), (Other, 1), (Acts, 0), (Both, 1), (derived(Both, act=None), 0)])
def test_a_form_holds_until_a_subclass_changes_what_it_stands_for(kind, true):
    assert overrides_consistently(kind, "form", ["act"]) == bool(true)


def other(*given):
    return 1.0


Noisy = derived(fl.Algorithm1, acceleration=other)
LED = {"target": fl.StaticTarget((0.0,))}
IGNORED = {
    "acceleration": Noisy(),
    "acceleration of a mixture": derived(Noisy, fl.Algorithm2)(**LED),
    "energy": derived(fl.Algorithm1, energy=other)(),
    "energy_rate": derived(fl.Algorithm1, energy_rate=other)(),
    "phi_alpha": fl.Algorithm1(alpha=derived(fl.AlphaInteraction, phi_alpha=other)()),
    "phi_beta": fl.Algorithm3(
        **LED, beta=derived(fl.BetaInteraction, phi_beta=other)(), obstacles=(fl.Sphere((9.0,), 1.0),)
    ),
    "clearance": fl.Algorithm3(**LED, obstacles=(derived(fl.Sphere, clearance=other)((9.0,), 1.0),)),
    "__call__": fl.CuckerSmale(derived(RationalWeight, __call__=other)(1.0, 0.5, 1.0)),
    "step": derived(fl.ZoneFlocking, step=other)(fl.ZoneRadii(r=1.0, a=3.0)),
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
    with pytest.raises(ArgumentError, match="Changed defines acceleration, but not flow"):
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
    modules = (fl, flockana.sources.li_dead_zone.interactions, flockana.interactions.weights)
    kinds = {kind for module in modules for kind in vars(module).values() if hasattr(kind, "derived_methods")}
    for kind in (*kinds, *(getattr(fl, name) for name in ("AlphaInteraction", "BetaInteraction", "Algorithm1"))):
        for source, names in kind.derived_methods.items():
            assert all(callable(getattr(kind, name)) or name == "c_star" for name in names), (kind, source)
