"""Equilibria: find them, tell minima from saddles, search for all of them, and what they certify."""

from __future__ import annotations

from flockana.equilibria.solve import Equilibrium as Equilibrium
from flockana.equilibria.solve import find_equilibrium as find_equilibrium
