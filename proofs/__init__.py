"""Executable proofs, one file each: `python -m proofs` runs them all."""
