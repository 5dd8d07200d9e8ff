from .solve import Equilibrium as Equilibrium
from .solve import find_equilibrium as find_equilibrium
