"""The report: one self-contained HTML page, and the same verdicts as JSON."""
