"""Shared settings: hypothesis runs the same examples every time, and never judges by the clock."""

from __future__ import annotations

from hypothesis import settings

settings.register_profile("flockana", deadline=None, derandomize=True, max_examples=40, database=None)
settings.load_profile("flockana")
