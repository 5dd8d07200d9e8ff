"""Helpers and tests; pytest imports every file by its own path, and helpers as `tests.<folder>.<name>`."""
