"""Coverage tables: for each item of each source, the theorems, scenarios and tests behind it."""

from flockana.report.coverage.rows import Reference, Row, Source, coverage, read_table

__all__ = ["Reference", "Row", "Source", "coverage", "read_table"]
