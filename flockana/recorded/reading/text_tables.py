"""Tables in text files: CSV and TSV, with messages that name row, column and remedy."""

import io
import re
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from flockana.base.errors import FileError
from flockana.recorded.reading import opened
from flockana.recorded.reading.column_names import renaming_note

_GAPS = ("", "nan", "NaN", "NA", "N/A", "null", "None", "-")
_SHOWN = 40  # characters of a cell or a line that a message repeats
_QUOTE, _NEWLINE = ord('"'), ord("\n")


def read_text(path: Path, names: Sequence[str] | None = None) -> Any:
    """Return a table as a pandas frame: delimiter by its first line, header by its names or `names`.

    Empty columns at the end, decimal commas and further lines of a header are taken for what they are, and noted.
    """
    import pandas as pd

    data, above = _below_comments(_bytes(path), names is not None)
    first = next((line for line in data.split(b"\n", 20) if line.strip()), b"").decode("utf-8")
    delimiter = _delimiter(first)
    if delimiter == " ":
        data, first, delimiter = (
            b"\n".join(b"\t".join(x.split()) for x in data.split(b"\n")),
            "\t".join(first.split()),
            "\t",
        )
        if first.startswith("#\t"):
            data, first = data.removeprefix(b"#\t"), first.removeprefix("#\t")
    cells = [cell.strip().strip('"') for cell in first.split(delimiter)]
    if names is None and all(_is_number(cell) for cell in cells):
        raise FileError(
            f"{path}, line 1: {first.strip()[:_SHOWN]!r} are numbers; expected a header such as time,id,x,y; add one, "
            'or name the columns by columns=["t", "id", "x", "y"]'
        )
    if twice := sorted({cell for cell in cells if cell and cells.count(cell) > 1}) if names is None else []:
        raise FileError(
            f"{path}, line 1: the column {twice[0]!r} is given twice; expected each once; of a header in several lines "
            "make a frame, such as pandas.read_csv(file, header=[0, 1, 2], index_col=0), and read that"
        )
    if first.count('"') % 2:
        raise FileError(f"{path}, line 1: {first.strip()[:_SHOWN]!r} has an open quote; expected a header in one line")
    data, notes = _cleaned(data, delimiter)
    width, has_header = len(cells), not any(x[:1].isdigit() or _is_number(x) for x in cells if x) and any(cells)
    if names is not None and has_header:
        notes += filter(None, [renaming_note(cells, names, f"{path}, line 1")])
    elif names is not None:
        if len(names) != width:
            raise FileError(f"{path}, line 1: {width} columns, and {len(names)} names are given; expected one for each")
        notes.append("there is no header: columns= names the columns")
    has_header |= names is None
    if _QUOTE not in data:
        data = _ensure_rectangular(data, ord(delimiter), width, path, above)
    lines = (
        [k for k, line in enumerate(data.split(b"\n"), 1 + above) if line.strip()] if b"\n\n" in data.strip() else None
    )
    try:
        frame = pd.read_csv(
            io.BytesIO(data),
            sep=delimiter,
            header=0 if has_header else None,
            names=[cell or f"column {k}" for k, cell in enumerate(cells, 1)] if names is None else list(names),
            na_values=list(_GAPS),
            keep_default_na=False,
            skipinitialspace=True,
            index_col=False,
        )
    except (pd.errors.ParserError, pd.errors.EmptyDataError, ValueError) as error:
        raise FileError(f"cannot read {path}: {' '.join(str(error).split())}; expected a table of numbers") from None
    if not len(frame):
        raise FileError(f"{path} has a header and no rows: expected one for each sample of an agent")
    if empty := [x for k, x in enumerate(frame) if not cells[k] and names is None and frame[x].isna().all()]:
        frame, notes = frame.drop(columns=empty), [*notes, f"{len(empty)} columns without a name are empty"]
    frame.attrs |= {"where": str(path), "first": above + 1 + has_header, "notes": tuple(notes)}
    if lines is not None:  # pandas leaves out empty ones
        frame.attrs["lines"] = lines[has_header:]
    return frame


def _below_comments(data: bytes, named: bool) -> tuple[bytes, int]:
    """Return a table without comment lines (#), of which the last may be the header, and their number."""
    lines = data.split(b"\n", 100)
    line_index = next((k for k, line in enumerate(lines) if line.strip() and not line.startswith(b"#")), 0)
    cells = re.split(r"[\t,;\s]+", lines[line_index].decode("utf-8").strip())
    if line_index and not named and all(_is_number(cell.strip('"')) for cell in cells):
        line_index = max(k for k in range(line_index) if lines[k].strip())
    return data.split(b"\n", line_index)[line_index], line_index


def _cleaned(data: bytes, delimiter: str) -> tuple[bytes, list[str]]:
    """Return a table with decimal points and one header line, and notes on the changes."""
    notes, (head, _, rest) = [], data.partition(b"\n")
    if delimiter != "," and b"," in rest and b"." not in rest and re.search(rb"\d,\d", rest):
        rest, notes = re.sub(rb"(?<=\d),(?=\d)", b".", rest), ["commas are decimal points"]
    lines, skipped = rest.split(b"\n", 4), 0
    for line in lines[:3]:
        texts = [cell.strip(' "') for cell in line.decode("utf-8").split(delimiter)]
        if not any(texts) or any(_is_number(text) and text not in _GAPS for text in texts):
            break
        skipped += 1
    later_cells = [cell for line in lines[skipped : skipped + 1] for cell in line.decode("utf-8").split(delimiter)]
    if skipped and any(_is_number(cell.strip(' "')) and cell.strip() not in _GAPS for cell in later_cells):
        rest = b"\n" * skipped + b"\n".join(lines[skipped:])
        notes.append(f"{skipped} more lines of a header are left out")
    return head + b"\n" + rest, notes


def numbers(frame: Any, column: str) -> Any:
    """Return a column as floats with NaN for gaps; raise on the first cell that is not a finite number."""
    import pandas as pd

    series = frame[column]
    if series.dtype.kind == "c":
        raise _bad_cell(frame, 0, column)
    values, is_refused = series, np.zeros(len(series), dtype=bool)
    if series.dtype.kind not in "fiu":
        values = pd.to_numeric(series, errors="coerce")
        is_refused = (series.notna() & values.isna()).to_numpy() | series.map(lambda x: isinstance(x, bool)).to_numpy()
    parsed_values = values.to_numpy(dtype=np.float64)
    is_refused = is_refused | np.isinf(parsed_values)
    if is_refused.any():
        raise _bad_cell(frame, int(np.argmax(is_refused)), column)
    return parsed_values


def row_name(frame: Any, k: int) -> str:
    """Return a row's location for messages: its line in a file, or its index in a frame."""
    place_text, first_line = frame.attrs.get("where", "the frame"), frame.attrs.get("first")
    if first_line is None:
        return f"{place_text}, row {frame.index[k]}"
    lines = frame.attrs.get("lines")
    return f"{place_text}, line {k + first_line if lines is None else lines[k]}"


def _bad_cell(frame: Any, k: int, column: str) -> FileError:
    cell = str(frame[column].iloc[k])[:_SHOWN]
    place_text = f"{row_name(frame, k)}, column {column!r}: {cell!r}"
    return FileError(f"{place_text}; expected a finite number such as 0.5, or nothing for a gap")


def _bytes(path: Path) -> bytes:
    """Return the bytes of a text file with newline line ends; raise on binary content."""
    with opened(path, "a table") as file:
        data = file.read()
    if data[:2] in (b"\xff\xfe", b"\xfe\xff"):
        raise FileError(f"cannot read {path}: it is UTF-16; expected UTF-8; save it as such")
    data = data.removeprefix(b"\xef\xbb\xbf")
    if data.startswith(b"\x89HDF"):
        raise FileError(
            f"cannot read {path}: it is HDF5; give its arrays by name, and axes=; h5py.File(...) reads them"
        )
    if b"\0" in data:
        raise FileError(f"cannot read {path}: it holds null bytes; expected a text table in UTF-8")
    try:
        if not data.isascii():
            data.decode("utf-8")
    except UnicodeDecodeError as error:
        line = data[: error.start].count(b"\n") + 1
        raise FileError(f"{path}, line {line}: byte {data[error.start]:#x} is no UTF-8; save it as UTF-8") from None
    if not data.strip():
        raise FileError(f"{path} is empty: expected a header and rows")
    return data.replace(b"\r\n", b"\n").replace(b"\r", b"\n").lstrip(b"\n")


def _delimiter(line: str) -> str:
    """Return the delimiter most frequent in the first line: tab, semicolon or comma, else a blank."""
    return max("\t,; ", key=lambda mark: min(line.count(mark), 1) if mark == " " else 2 * line.count(mark))


def _ensure_rectangular(data: bytes, delimiter: int, width: int, path: Path, above: int) -> bytes:
    """Return the table without empty cells beyond the header; raise on a row of a different length.

    pandas would fill short ones.
    """
    byte_values = np.frombuffer(data, dtype=np.uint8)
    line_ends = np.flatnonzero(byte_values == _NEWLINE)
    line_ends = line_ends if byte_values[-1] == _NEWLINE else np.append(line_ends, len(byte_values))
    starts = np.concatenate([[0], line_ends[:-1] + 1])
    cells = np.diff(np.searchsorted(np.flatnonzero(byte_values == delimiter), np.append(starts, len(byte_values)))) + 1
    bad_rows, mark, has_long = np.flatnonzero((cells != width) & (line_ends > starts)), bytes([delimiter]), False
    for k in bad_rows.tolist():
        text = data[starts[k] : line_ends[k]]
        excess = mark * int(cells[k] - width)
        if cells[k] > width and text.rstrip(b" ").endswith(excess):
            has_long = True
        elif text.strip():
            raise FileError(
                f"{path}, line {k + 1 + above}: {cells[k]} values, expected {width} as in the header: "
                f"{text.strip()[:_SHOWN].decode('utf-8', 'replace')!r}; was it cut off, or do lines above the table "
                "describe it? leave those out by pandas.read_csv(file, skiprows=...), and read the frame"
            )
    if not has_long:
        return data
    lines = data.split(b"\n")
    return b"\n".join(x.rstrip(b" ")[: -(x.count(mark) - width + 1)] if x.count(mark) >= width else x for x in lines)


def _is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return text in _GAPS
    return True
