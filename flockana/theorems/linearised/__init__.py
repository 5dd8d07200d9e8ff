"""Theorems about predictions of the linearisation for a run."""
