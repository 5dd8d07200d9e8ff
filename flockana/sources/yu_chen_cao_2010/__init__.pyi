from .laws import NetConsensus as NetConsensus
