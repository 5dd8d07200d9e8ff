"""Catalogue of the sources' simulations; files that define `SCENARIOS` are found automatically."""

from flockana.scenarios.scenario import Report, Scenario, scenario, scenarios

__all__ = ["Report", "Scenario", "scenario", "scenarios"]
