"""Flockana's own scenarios and theorems about the laws of several sources."""
