from .interactions import LogPotential as LogPotential
from .laws import FixedNetFlocking as FixedNetFlocking
from .laws import ProximityFlocking as ProximityFlocking
