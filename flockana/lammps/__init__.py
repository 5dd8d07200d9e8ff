"""Export of runs to LAMMPS, and import of LAMMPS dumps."""
