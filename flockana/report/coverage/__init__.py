"""Which item of which source is held by what: one table per source, every reference of which can be looked up."""

from flockana.report.coverage.references import Reference, locate
from flockana.report.coverage.rows import Row, Source, coverage, faults, read_table

__all__ = ["Reference", "Row", "Source", "coverage", "faults", "locate", "read_table"]
