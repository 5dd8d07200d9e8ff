"""A law, a start and a run for LAMMPS, whose domain decomposition goes beyond one machine; its runs, read back."""
