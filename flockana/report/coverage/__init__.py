"""Coverage tables: for each item of each source, the theorems, scenarios and tests behind it."""

from flockana.report.coverage.references import Reference, locate
from flockana.report.coverage.rows import Row, Source, coverage, faults, read_table

__all__ = ["Reference", "Row", "Source", "coverage", "faults", "locate", "read_table"]
