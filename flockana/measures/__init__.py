"""Numbers of one instant or of a path: nets, metrics, distances, clearances, Reynolds' rules, perception."""
