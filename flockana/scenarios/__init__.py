"""The catalogue of the sources' simulations: each file of this package that defines `SCENARIOS` is found by itself."""

from flockana.scenarios.flock import Flock
from flockana.scenarios.scenario import Report, Scenario, scenario, scenarios

__all__ = ["Flock", "Report", "Scenario", "scenario", "scenarios"]
