from .laws import GaussianRepulsion as GaussianRepulsion
from .laws import GaziPassino as GaziPassino
