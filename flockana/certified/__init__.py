"""What no rounding can touch: enclosures in ball arithmetic (Arb) of equilibria, basins and runs."""
