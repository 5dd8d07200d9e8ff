from .laws import PushedAlgorithm1 as PushedAlgorithm1
from .laws import PushedAlgorithm2 as PushedAlgorithm2
