"""Solvers: one frozen class a file, with coefficients, order, and which laws it can step."""
