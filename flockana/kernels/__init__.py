"""Compiled numerics on plain floats and arrays: scalar pair functions, neighbour search, sums over pairs, paths.

Nothing here knows of laws, units or validation; `flockana.interactions` is the validated front.
"""
