"""Tables of data sheets: DataFrames, mappings, sequences of rows, and CSV files."""

from __future__ import annotations

import csv
import os
import re
from pathlib import Path
from typing import Any

from tribodyn._frames import columns_of

# The apostrophe that a CSV file of the service has before a text that a spreadsheet would compute.
_FORMULA_GUARD = re.compile(r"^'(?='*[=+\-@\t\r])")
_DECIMAL_COMMA = re.compile(r"[+-]?\d+,\d+([eE][+-]?\d+)?")


def rows_of(table: Any) -> list[dict[str, Any]]:
    """Returns the rows of a table in memory or of a CSV file. Empty cells are None.

    A file is UTF-8; commas, semicolons or tabs separate cells; a decimal comma is accepted if
    commas do not separate the cells; lines that begin with # are skipped.
    """
    if isinstance(table, (str, os.PathLike)):
        return _read_csv(Path(table))
    columns = columns_of(table)
    count = len(next(iter(columns.values()), []))
    return [{name: values[i] for name, values in columns.items()} for i in range(count)]


def table_rows(table: Any) -> list[dict[str, Any]]:
    """Returns the rows of a table, without empty cells."""
    return [
        {name: value for name, value in row.items() if value is not None} for row in rows_of(table)
    ]


def _read_csv(path: Path) -> list[dict[str, Any]]:
    lines = [
        line
        for line in path.read_text("utf-8-sig").splitlines(keepends=True)
        if line.strip() and not line.startswith("#")
    ]
    if not lines:
        return []
    separator = max(",;\t", key=lines[0].count)
    reader = csv.reader(lines, delimiter=separator)
    header = [_FORMULA_GUARD.sub("", name.strip()) for name in next(reader)]
    rows = []
    for cells in reader:
        if len(cells) != len(header):
            raise ValueError(
                f"{path}, line {reader.line_num}: {len(cells)} cells; the header has "
                f"{len(header)}"
            )
        texts = [cell.strip() for cell in cells]
        if separator != ",":
            texts = [
                text.replace(",", ".") if _DECIMAL_COMMA.fullmatch(text) else text for text in texts
            ]
        texts = [_FORMULA_GUARD.sub("", text) for text in texts]
        rows.append({name: text or None for name, text in zip(header, texts)})
    return rows
