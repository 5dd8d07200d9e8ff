"""From a law and a start to a run: steps, switches, encounters, the trajectory."""

from flockana.dynamics import predicates as predicates
