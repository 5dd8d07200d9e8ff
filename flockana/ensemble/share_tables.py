"""Results of an ensemble, printed and shown in notebooks as a table of shares."""

import xarray

from flockana.base.table_export import html_table, text_table
from flockana.ensemble.shares import share_cells, shares

_HEADS = ("parameters", "claim", "runs", "verified, %", "refuted, %", "vacuous", "inconclusive")
_LINES = 12


class Runs(xarray.Dataset):  # type: ignore[no-untyped-call]  # of xarray
    """Dataset of an ensemble, printed as the shares of runs in which claims hold."""

    __slots__ = ()

    def _table(self) -> tuple[tuple[str, ...], ...]:
        """Return headings and rows of the table of claims with success rates; () if data are missing."""
        if not ({"seed", "claim"} <= {*self.dims} and {"status", "run"} <= {*self.data_vars}):
            return ()
        columns = (column for column in zip(_HEADS, *share_cells(shares(self)), strict=True) if any(column[1:]))
        return tuple(zip(*columns, strict=True))

    def __str__(self) -> str:
        column_heads, *rows = self._table() or ((),)
        return f"{self._title()}\n{text_table(rows, column_heads)}" if rows else super().__repr__()

    def __repr__(self) -> str:
        lines = str(self).splitlines()
        if len(lines) <= _LINES or not self._table():
            return "\n".join(lines)
        return "\n".join([*lines[: _LINES - 1], f"… {len(lines) - _LINES + 1} more rows; print(...) shows all"])

    def _repr_html_(self) -> str:
        column_heads, *rows = self._table() or ((),)
        variables = super()._repr_html_()
        table = html_table(rows, column_heads, self._title()) if rows else ""
        return f"{table}<details><summary>variables</summary>{variables}</details>" if rows else variables

    def _title(self) -> str:
        failed_count = int((self.run != 0).sum())
        lost_text = f", {failed_count} did not complete" if failed_count else ""
        return f"{self.attrs.get('scenario', 'ensemble')}: {self.run.size} runs{lost_text}"
