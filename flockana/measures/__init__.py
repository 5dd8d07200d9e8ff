"""Measures of one instant or of a path: nets, metrics, distances, clearances, Reynolds' rules."""

from flockana.measures import metrics as metrics
from flockana.measures import reynolds as reynolds
