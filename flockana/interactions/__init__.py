"""Pair laws as frozen, validated parameters with their scalar functions and sums over pairs."""

from flockana.interactions.alpha import AlphaInteraction
from flockana.interactions.beta import BetaInteraction
from flockana.interactions.dead_zone import DeadZoneInteraction
from flockana.interactions.formula import FormulaInteraction
from flockana.interactions.from_formula import pair_law
from flockana.interactions.gains import Gains
from flockana.interactions.pair import PairInteraction
from flockana.interactions.zone_noise import ZoneNoise
from flockana.interactions.zones import ZoneRadii, ZoneWeights

__all__ = [
    "AlphaInteraction",
    "BetaInteraction",
    "DeadZoneInteraction",
    "FormulaInteraction",
    "Gains",
    "PairInteraction",
    "ZoneNoise",
    "ZoneRadii",
    "ZoneWeights",
    "pair_law",
]
