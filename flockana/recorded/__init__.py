"""Recorded flocks: reading, velocities, measures, comparison with a law, fits."""
