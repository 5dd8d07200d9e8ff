"""What surrounds a flock: γ-agents (targets)."""
