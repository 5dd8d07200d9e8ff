"""Montanari et al. (2025): gains of each agent that let a flock settle faster."""
