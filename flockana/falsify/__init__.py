"""Falsification: optimisation over initial states and parameters for a run that breaks a claim."""

from flockana.falsify.campaign import falsify
from flockana.falsify.counterexample import Counterexample, replay
from flockana.falsify.falsification import Falsification

__all__ = ["Counterexample", "Falsification", "falsify", "replay"]
