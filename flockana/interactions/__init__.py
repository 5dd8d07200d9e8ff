"""Pair laws as frozen, validated parameters with their scalar functions and sums over pairs."""

from flockana.interactions.alpha import AlphaInteraction as AlphaInteraction
from flockana.interactions.beta import BetaInteraction as BetaInteraction
from flockana.interactions.formula import FormulaInteraction as FormulaInteraction
from flockana.interactions.from_formula import pair_law as pair_law
from flockana.interactions.gains import Gains as Gains
from flockana.interactions.pair_interaction import PairInteraction as PairInteraction
