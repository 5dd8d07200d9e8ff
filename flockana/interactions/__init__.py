"""Pair laws as frozen, validated parameters with their scalar functions, and what lifting gives each of them."""

from flockana.interactions.alpha import AlphaInteraction
from flockana.interactions.beta import BetaInteraction
from flockana.interactions.gains import Gains
from flockana.interactions.pair import PairInteraction

__all__ = ["AlphaInteraction", "BetaInteraction", "Gains", "PairInteraction"]
