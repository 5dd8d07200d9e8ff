"""Catalogue of the sources' simulations; files that define `SCENARIOS` are found automatically."""

from flockana.scenarios.flock import Flock
from flockana.scenarios.scenario import Report, Scenario, scenario, scenarios

__all__ = ["Flock", "Report", "Scenario", "scenario", "scenarios"]
