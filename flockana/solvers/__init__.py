"""Solvers: one frozen class per file, with coefficients, order, and applicable laws."""
