"""Coverage tables: theorems, scenarios and tests for each item of each source."""

from flockana.report.coverage.coverage_rows import Reference, Row, Source, coverage, read_table

__all__ = ["Reference", "Row", "Source", "coverage", "read_table"]
