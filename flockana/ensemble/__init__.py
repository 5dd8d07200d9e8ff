"""Ensembles: many runs of a scenario over seeds and options, verified, counted and stored."""

from flockana.base.binomial_intervals import clopper_pearson
from flockana.ensemble.campaign import ensemble
from flockana.ensemble.phases import PHASES, phases
from flockana.ensemble.shares import STATUSES, shares
from flockana.ensemble.store import Store

__all__ = ["PHASES", "STATUSES", "Store", "clopper_pearson", "ensemble", "phases", "shares"]
