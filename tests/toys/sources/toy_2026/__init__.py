"""A toy paper: one law, a theorem, an erratum and a scenario in a folder that no table names."""
