"""Bearing-distance flocking (Jond): Theorem 1 as printed and as corrected, errata J1 to J18."""
