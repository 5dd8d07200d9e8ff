"""flockana: does this flock provably do what the theorem says, and how does it behave near its equilibrium?

The public names are imported when they are first used, so that ``import flockana`` is fast.
"""

from __future__ import annotations

import sys
from importlib import import_module
from types import ModuleType
from typing import TYPE_CHECKING, Any

from flockana._version import __version__

if TYPE_CHECKING:
    from flockana import lattice as lattice
    from flockana import plots as plots
    from flockana import stability as stability
    from flockana import symbolic as symbolic
    from flockana.base import errors as errors
    from flockana.base.binomial import clopper_pearson as clopper_pearson
    from flockana.base.references import cite as cite
    from flockana.base.units import rescale as rescale
    from flockana.dynamics import predicates as predicates
    from flockana.dynamics.simulate import simulate as simulate
    from flockana.dynamics.trajectory import Trajectory as Trajectory
    from flockana.ensemble.campaign import ensemble as ensemble
    from flockana.ensemble.dataset import shares as shares
    from flockana.environment.capsule import Capsule as Capsule
    from flockana.environment.obstacles import Obstacle as Obstacle
    from flockana.environment.obstacles import Sphere as Sphere
    from flockana.environment.obstacles import Wall as Wall
    from flockana.environment.polygon import Polygon as Polygon
    from flockana.environment.targets import CallableTarget as CallableTarget
    from flockana.environment.targets import CircleTarget as CircleTarget
    from flockana.environment.targets import LinearTarget as LinearTarget
    from flockana.environment.targets import RescaledVelocity as RescaledVelocity
    from flockana.environment.targets import SineTarget as SineTarget
    from flockana.environment.targets import StaticTarget as StaticTarget
    from flockana.environment.targets import Target as Target
    from flockana.environment.zone_obstacles import Box as Box
    from flockana.environment.zone_obstacles import SimplePolygon as SimplePolygon
    from flockana.environment.zone_world import Alien as Alien
    from flockana.environment.zone_world import ZoneWorld as ZoneWorld
    from flockana.equilibria.solve import Equilibrium as Equilibrium
    from flockana.equilibria.solve import find_equilibrium as find_equilibrium
    from flockana.falsify import Falsification as Falsification
    from flockana.falsify import falsify as falsify
    from flockana.falsify import replay as replay
    from flockana.interactions import AlphaInteraction as AlphaInteraction
    from flockana.interactions import BetaInteraction as BetaInteraction
    from flockana.interactions import DeadZoneInteraction as DeadZoneInteraction
    from flockana.interactions import Gains as Gains
    from flockana.interactions import PairInteraction as PairInteraction
    from flockana.interactions import ZoneRadii as ZoneRadii
    from flockana.interactions import ZoneWeights as ZoneWeights
    from flockana.laws.algorithm3 import Algorithm3 as Algorithm3
    from flockana.laws.bearing_distance import ZoneFlocking as ZoneFlocking
    from flockana.laws.dead_zone import DeadZoneFlocking as DeadZoneFlocking
    from flockana.laws.discrete import DiscreteLaw as DiscreteLaw
    from flockana.laws.law import Law as Law
    from flockana.laws.minimal import DiscreteMinimalFlocking as DiscreteMinimalFlocking
    from flockana.laws.minimal import MinimalFlocking as MinimalFlocking
    from flockana.laws.olfati_saber import Algorithm1 as Algorithm1
    from flockana.laws.olfati_saber import Algorithm2 as Algorithm2
    from flockana.laws.sum_of_terms import SumOfTerms as SumOfTerms
    from flockana.laws.terms.navigation import Navigation as Navigation
    from flockana.laws.terms.obstacles import ObstacleTerm as ObstacleTerm
    from flockana.laws.terms.pairs import PairTerm as PairTerm
    from flockana.laws.terms.term import Term as Term
    from flockana.measures import metrics as metrics
    from flockana.measures import reynolds as reynolds
    from flockana.measures.metrics import cohesion_radius as cohesion_radius
    from flockana.measures.metrics import connectivity as connectivity
    from flockana.measures.metrics import coordination as coordination
    from flockana.measures.metrics import deviation_energy as deviation_energy
    from flockana.measures.metrics import giant_share as giant_share
    from flockana.measures.metrics import inertia as inertia
    from flockana.measures.metrics import min_distance as min_distance
    from flockana.measures.metrics import order as order
    from flockana.measures.metrics import velocity_mismatch as velocity_mismatch
    from flockana.measures.nets import components as components
    from flockana.measures.nets import laplacian as laplacian
    from flockana.measures.nets import links as links
    from flockana.plots.animation import animate as animate
    from flockana.scenarios.scenario import Scenario as Scenario
    from flockana.scenarios.scenario import scenario as scenario
    from flockana.scenarios.scenario import scenarios as scenarios
    from flockana.stability.linearise import Linearisation as Linearisation
    from flockana.stability.linearise import linearise as linearise
    from flockana.stability.modes import Mode as Mode
    from flockana.stability.slowest import slowest_modes as slowest_modes
    from flockana.theorems.catalogue import theorem as theorem
    from flockana.theorems.catalogue import theorems as theorems
    from flockana.theorems.catalogue import verify as verify
    from flockana.theorems.theorem import Tolerances as Tolerances
    from flockana.theorems.theorem import Verdict as Verdict

_TARGETS = (
    "Target",
    "StaticTarget",
    "LinearTarget",
    "SineTarget",
    "CircleTarget",
    "RescaledVelocity",
    "CallableTarget",
)
_INTERACTIONS = (
    "PairInteraction",
    "AlphaInteraction",
    "BetaInteraction",
    "Gains",
    "DeadZoneInteraction",
    "ZoneRadii",
    "ZoneWeights",
)
_METRICS = ("connectivity", "cohesion_radius", "deviation_energy", "velocity_mismatch", "inertia", "giant_share")
_BY_MODULE = {
    "environment.targets": _TARGETS,
    "environment.obstacles": ("Obstacle", "Sphere", "Wall"),
    "environment.capsule": ("Capsule",),
    "environment.polygon": ("Polygon",),
    "environment.zone_obstacles": ("Box", "SimplePolygon"),
    "environment.zone_world": ("Alien", "ZoneWorld"),
    "interactions": _INTERACTIONS,
    "laws.law": ("Law",),
    "laws.sum_of_terms": ("SumOfTerms",),
    "laws.terms.term": ("Term",),
    "laws.terms.pairs": ("PairTerm",),
    "laws.terms.navigation": ("Navigation",),
    "laws.terms.obstacles": ("ObstacleTerm",),
    "laws.discrete": ("DiscreteLaw",),
    "laws.olfati_saber": ("Algorithm1", "Algorithm2"),
    "laws.algorithm3": ("Algorithm3",),
    "laws.bearing_distance": ("ZoneFlocking",),
    "laws.minimal": ("MinimalFlocking", "DiscreteMinimalFlocking"),
    "laws.dead_zone": ("DeadZoneFlocking",),
    "dynamics.simulate": ("simulate",),
    "dynamics.trajectory": ("Trajectory",),
    "base.units": ("rescale",),
    "measures.metrics": (*_METRICS, "min_distance", "order", "coordination"),
    "measures.nets": ("links", "components", "laplacian"),
    "equilibria": ("find_equilibrium", "Equilibrium"),
    "stability": ("linearise", "Linearisation", "Mode", "slowest_modes"),
    "theorems": ("theorems", "theorem", "verify", "Verdict", "Tolerances"),
    "scenarios": ("scenarios", "scenario", "Scenario"),
    "ensemble": ("ensemble", "shares"),
    "base.binomial": ("clopper_pearson",),
    "falsify": ("falsify", "Falsification", "replay"),
    "plots.animation": ("animate",),
    "base.references": ("cite",),
}
_HOME = {name: module for module, names in _BY_MODULE.items() for name in names}

_SUBMODULES = {
    "errors": "base.errors",
    "lattice": "lattice",
    "metrics": "measures.metrics",
    "plots": "plots",
    "predicates": "dynamics.predicates",
    "reynolds": "measures.reynolds",
    "stability": "stability",
    "symbolic": "symbolic",
}

__all__ = ["__version__", *_SUBMODULES, *_HOME]  # all of them strings, from the table above


def __getattr__(name: str) -> Any:
    if name in _SUBMODULES:
        return import_module(f"flockana.{_SUBMODULES[name]}")
    if name not in _HOME:
        raise AttributeError(f"module 'flockana' has no attribute {name!r}")
    return globals().setdefault(name, getattr(import_module(f"flockana.{_HOME[name]}"), name))


def __dir__() -> list[str]:
    return sorted(__all__)


class _Package(ModuleType):
    """Keeps `simulate`, `theorems` and `scenarios` functions, although modules of these names exist.

    Importing a submodule binds it as an attribute of its package, and would so hide the function, or not, depending
    on what was imported first.
    """

    def __setattr__(self, name: str, value: Any) -> None:
        if not (name in _HOME and isinstance(value, ModuleType)):
            super().__setattr__(name, value)


sys.modules[__name__].__class__ = _Package
