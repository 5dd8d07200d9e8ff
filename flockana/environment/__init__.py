"""Surroundings of a flock: γ-agents, obstacles, aliens."""
