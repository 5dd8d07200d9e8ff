from .laws import AverageConsensus as AverageConsensus
