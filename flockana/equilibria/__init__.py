"""Equilibria of laws with a potential: solvers, classification, searches, and barriers against collisions."""

from __future__ import annotations

from flockana.equilibria.solve import Equilibrium as Equilibrium
from flockana.equilibria.solve import find_equilibrium as find_equilibrium
