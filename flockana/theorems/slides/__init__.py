"""Errata E1 to E13, one file each, and the energies that the slides print."""
