"""Rigorous enclosures in ball arithmetic (Arb) of equilibria, basins and runs."""
