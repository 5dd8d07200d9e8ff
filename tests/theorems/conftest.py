"""Verdicts that need no run, each computed once however many tests ask for it."""

from __future__ import annotations

from functools import cache

import pytest

from flockana.theorems import verify


@pytest.fixture(scope="session")
def verdict_of():
    """The verdict of a theorem that is checked by itself, by its id."""
    return cache(verify)
