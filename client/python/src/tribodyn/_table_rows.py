"""Tables of callers whose rows are computed: rows in, rows out."""

from __future__ import annotations

import os
from typing import Any, Callable, Mapping, Sequence

from tribodyn._carried import check_carried
from tribodyn._csv import rows_of
from tribodyn._frames import Frame, columns_of, frame, in_columns


def rows_with(
    table: Any,
    parameters: Mapping[str, Any],
    inputs: Sequence[str],
    is_known: Callable[[str], bool],
    carry: str | Sequence[str],
) -> tuple[dict[str, list[Any]], list[dict[str, Any]]]:
    """Returns the columns of a table, and its rows with the parameters that they do not state.
    Raises as check_carried()."""
    unknown = [name for name in parameters if not is_known(name)]
    if unknown:
        raise TypeError(f"no such parameter: {', '.join(unknown)}")
    is_file = isinstance(table, (str, os.PathLike))
    given = in_columns(rows_of(table)) if is_file else columns_of(table)
    check_carried(given, [each for each in given if is_known(each)], inputs, carry)
    count = len(next(iter(given.values()), []))
    rows = [
        {
            **parameters,
            **{name: values[i] for name, values in given.items() if values[i] is not None},
        }
        for i in range(count)
    ]
    return given, rows


def beside(
    table: Any,
    given: Mapping[str, list[Any]],
    cells: Sequence[Mapping[str, Any]],
    attrs: Mapping[str, Any],
) -> Frame:
    """Returns the columns of the table with those of the results beside them."""
    results = {name: each for name, each in in_columns(cells).items() if name not in given}
    out = frame({**given, **results}, attrs)
    if hasattr(table, "columns") and hasattr(out, "index"):  # both are DataFrames
        out.index = table.index
    return out
