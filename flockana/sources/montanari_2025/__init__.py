"""Montanari et al. (2025): per-agent gains that let a flock settle faster."""
